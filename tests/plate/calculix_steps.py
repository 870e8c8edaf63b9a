"""Prints what sheets with a step or a disc of another stiffness give way by under a fingertip, by CalculiX: the numbers of
ShearWork.AtAJumpIsThatOfSolids.

usage: python3 calculix_steps.py     (calculix-ccx and python3-numpy of the distribution; a quarter of an hour)

40 mm square and 2 mm thick, clamped on all sides, second-order bricks (C3D20R) of 0.5 mm and two through the thickness; a
pressure (1 - r^2/a^2)^2 of a = 4 mm, half on either face, 1 N together. The compliance is the mean displacement of both
faces under it.
"""

import os
import sys

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import calculix  # noqa: E402

SIDE, THICKNESS, SOFT, POISSON, FOOTPRINT, DISC = 40e-3, 2e-3, 1e6, 0.45, 4e-3, 6e-3  # [m], [m], [Pa], [1], [m], [m]
CELLS, ACROSS, PARTS = 80, 2, 20  # along a side, through the thickness, samples of a cell's pressure
CORNERS = [(0, 0), (2, 0), (2, 2), (0, 2)]
MIDDLES = [(1, 0), (2, 1), (1, 2), (0, 1)]


def compliance(is_disc, contrast, where):
    """Of a fingertip at x = where [m]."""
    cell, layer = SIDE / CELLS, THICKNESS / ACROSS
    numbers, forces, bricks = {}, {}, {False: [], True: []}

    def node(i, j, k):
        return numbers.setdefault((i, j, k), len(numbers) + 1)

    samples = (numpy.arange(PARTS) + 0.5) / PARTS * cell
    for i in range(CELLS):
        for j in range(CELLS):
            x, y = i * cell - SIDE / 2, j * cell - SIDE / 2
            stiff = numpy.hypot(x + cell / 2, y + cell / 2) < DISC if is_disc else x + cell / 2 > 0
            px, py = numpy.meshgrid(x + samples, y + samples)
            pressure = numpy.mean(numpy.maximum(0, 1 - ((px - where) ** 2 + py**2) / FOOTPRINT**2) ** 2)
            for k in range(ACROSS):
                at = [(a, b, c) for c in (0, 2) for a, b in CORNERS] + [(a, b, c) for c in (0, 2) for a, b in MIDDLES]
                at += [(a, b, 1) for a, b in CORNERS]
                bricks[bool(stiff)].append([node(2 * i + a, 2 * j + b, 2 * k + c) for a, b, c in at])
            for k in (0, 2 * ACROSS):
                for places, share in ((CORNERS, -1 / 12), (MIDDLES, 1 / 3)):
                    for a, b in places:
                        number = node(2 * i + a, 2 * j + b, k)
                        forces[number] = forces.get(number, 0.0) + share * pressure
    total = sum(forces.values())
    forces = {number: force / total for number, force in forces.items() if force}
    lines = ["*NODE, NSET=ALL"]
    for (i, j, k), n in numbers.items():
        x, y, z = i * cell / 2 - SIDE / 2, j * cell / 2 - SIDE / 2, k * layer / 2 - THICKNESS / 2
        lines.append(f"{n}, {x:.9g}, {y:.9g}, {z:.9g}")
    element = 0
    for stiff, name in ((False, "SOFT"), (True, "STIFF")):
        if not bricks[stiff]:
            continue
        lines.append(f"*ELEMENT, TYPE=C3D20R, ELSET={name}")
        for nodes in bricks[stiff]:
            element += 1
            words = [str(element), *map(str, nodes)]
            lines += [", ".join(words[:11]) + ",", ", ".join(words[11:])]
        lines += [f"*MATERIAL, NAME={name}", "*ELASTIC", f"{SOFT * (contrast if stiff else 1):g}, {POISSON}"]
        lines.append(f"*SOLID SECTION, ELSET={name}, MATERIAL={name}")
    lines.append("*BOUNDARY")
    lines += [f"{n}, 1, 3" for (i, j, _), n in numbers.items() if i in (0, 2 * CELLS) or j in (0, 2 * CELLS)]
    return calculix.compliance(lines, forces, (0, 0, 1))


if __name__ == "__main__":
    print("homogeneous: %.5g" % compliance(False, 1, 0), flush=True)
    for disc, places in ((False, (0, 3e-3, -3e-3)), (True, (0, 3e-3, 6e-3))):
        for ratio in (10, 100):
            for place in places:
                found = compliance(disc, ratio, place)
                print("%s of %g, x %g m: %.5g" % ("disc" if disc else "step", ratio, place, found), flush=True)
