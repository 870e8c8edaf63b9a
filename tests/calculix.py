"""CalculiX (calculix-ccx of the distribution) for the programs that make the tests' numbers."""

import os
import subprocess
import tempfile


def run(folder, job, text):
    """Runs a deck and returns the lines of its table of displacements, and what ccx said."""
    path = os.path.join(folder, job)
    with open(path + ".inp", "w") as file:
        file.write(text)
    done = subprocess.run(["ccx", job], cwd=folder, capture_output=True, text=True)
    with open(path + ".dat") as file:
        return [line.split() for line in file], done.stdout


def work(words, forces, along):
    """What a line of displacements adds to the work of forces [N], by node, along a direction."""
    if len(words) != 4 or not words[0].isdigit():
        return 0.0
    return forces[int(words[0])] * sum(a * float(word) for a, word in zip(along, words[1:]))


def displacements(lines, forces, along, step):
    """Of a deck up to its step, under forces: their work over 1 N after each increment of the step [m]."""
    lines = lines + ["*NSET, NSET=LOADED"] + [f"{node}," for node in forces] + step + ["*CLOAD"]
    for node, force in forces.items():
        lines += [f"{node}, {axis + 1}, {force * a:.12g}" for axis, a in enumerate(along) if a]
    lines += ["*NODE PRINT, NSET=LOADED", "U", "*END STEP"]
    with tempfile.TemporaryDirectory() as folder:
        table, said = run(folder, "job", "\n".join(lines) + "\n")
    found = []
    for words in table:
        if words[:1] == ["displacements"]:
            found.append(0.0)
        elif found:
            found[-1] += work(words, forces, along)
    if not found or found[0] <= 0:
        raise SystemExit(f"expected displacements, found none; ccx said:\n{said[-2000:]}")
    return found


def compliance(lines, forces, along):
    """Of a deck up to its step, under forces that together are 1 N: their mean displacement [m/N]."""
    return displacements(lines, forces, along, ["*STEP", "*STATIC"])[0]


def depths(lines, forces, along, force, increments):
    """The mean displacements under even parts of a force [N], with large rotations [m]; `forces` together are 1 N."""
    step = ["*STEP, NLGEOM", "*STATIC, DIRECT", f"{1 / increments}, 1."]
    found = displacements(lines, {node: force * of for node, of in forces.items()}, along, step)
    return [depth / force for depth in found]
