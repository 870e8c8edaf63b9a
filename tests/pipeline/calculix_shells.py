#!/usr/bin/env python3
"""Computes whole thin objects by CalculiX and prints tests/pipeline/calculix_shells.h.

    python3 tests/pipeline/calculix_shells.py [FOLDER] > tests/pipeline/calculix_shells.h

It needs ccx (Debian: calculix-ccx) and some minutes. The tests read the header and need neither. Each object is one layer of quadratic bricks C3D20R, symmetric about the planes through
the touch where its stiffness is, pressed by a footprint of 4 mm on both of its faces alike and held at its far border.
The compliance is the work of the load. It is computed on two meshes, whose elements differ by a factor of 1.5 in size; the
finer one's value is printed, with the change from the coarser one. (Shell elements would do, but CalculiX makes them stiff
across their thickness wherever a rotation is held, so that on planes of symmetry they converge with their size alone.)
"""

import math
import os
import subprocess
import sys

MODULUS, POISSON, FOOTPRINT = 1e6, 0.45, 4e-3  # [Pa], [1], [m]


def azimuthal(axes, reach):
    """A piece of an ellipsoid about its pole: directions in an azimuthal map, `reach` [rad] to each side."""

    def place(x, y):
        angle = math.hypot(x, y) * reach
        share = math.sin(angle) / angle * reach if angle > 0 else reach
        return axes[0] * share * x, axes[1] * share * y, axes[2] * math.cos(angle)

    return place


def turned(radius, length):
    """A surface of revolution about the y axis, all around; radius(y) [m]."""

    def place(x, y):
        r = radius(y * length / 2)
        return r * math.sin(math.pi * x), y * length / 2, r * math.cos(math.pi * x)

    return place


def flat(size):
    return lambda x, y: (x * size / 2, y * size / 2, 0.0)


def even(point):
    return 1.0


def spot(factor, off, sigma=4e-3):
    """Stiffness over the modulus: `factor` at a place on the x axis `off` [m] beside the touch."""

    def stiffness(point):
        squared = (point[0] - off) ** 2 + point[1] ** 2
        return 1 + (factor - 1) * math.exp(-squared / (2 * sigma**2)) if point[2] > 0 else 1.0

    return stiffness


ROUND = azimuthal((50e-3, 50e-3, 50e-3), 1.75)
EGG = azimuthal((60e-3, 45e-3, 35e-3), 1.75)
TUBE = turned(lambda y: 40e-3, 80e-3)
WAIST = turned(lambda y: 120e-3 - math.sqrt(80e-3**2 - y**2), 80e-3)

# name, place, stiffness, thickness [m], whether the half x < 0 is a mirror image too, whether x goes all around
OBJECTS = [
    ("sphere", ROUND, even, 1e-3, True, False),
    ("sphere", ROUND, even, 2e-3, True, False),
    ("ellipsoid", EGG, even, 1e-3, True, False),
    ("ellipsoid", EGG, even, 2e-3, True, False),
    ("wart_under", ROUND, spot(10, 0), 1e-3, True, False),
    ("wart_under", ROUND, spot(10, 0), 2e-3, True, False),
    ("wart_beside", ROUND, spot(10, 8e-3), 1e-3, False, False),
    ("soft_spot", ROUND, spot(0.2, 0), 1e-3, True, False),
    ("tube", TUBE, even, 1e-3, True, True),
    ("waist", WAIST, even, 1e-3, True, True),
    ("sheet", flat(40e-3), even, 1e-3, True, False),
]


def graded(s, finest):
    """Elements at the touch are `finest` times the mean ones."""
    return finest * s + (1 - finest) * s**3


def unit(v):
    length = math.hypot(*v)
    return [c / length for c in v]


def normal(place, x, y):
    """The surface's normal, from differences."""
    step = 1e-5
    ex = [b - a for a, b in zip(place(x - step, y), place(x + step, y))]
    ey = [b - a for a, b in zip(place(x, y - step), place(x, y + step))]
    return unit([ex[1] * ey[2] - ex[2] * ey[1], ex[2] * ey[0] - ex[0] * ey[2], ex[0] * ey[1] - ex[1] * ey[0]])


class Mesh:
    """numbers[i, j, k]: k is 0 on the lower face, 1 in the middle and 2 on the upper face."""

    def __init__(self, place, cells, mirrored, stiffness, thickness, finest):
        self.columns, self.rows = (cells if mirrored else 2 * cells), cells
        self.numbers, self.points, self.moduli, self.middle = {}, [], [], {}
        for i in range(2 * self.columns + 1):
            for j in range(2 * self.rows + 1):
                if i % 2 and j % 2:
                    continue  # no node in the middle of a face
                x, y = graded(i / (2 * cells) - (0 if mirrored else 1), finest), graded(j / (2 * cells), finest)
                point, out = place(x, y), normal(place, x, y)
                self.middle[i, j] = point
                for k in (0, 2) if i % 2 or j % 2 else (0, 1, 2):
                    self.numbers[i, j, k] = len(self.points) + 1
                    self.points.append([p + (k - 1) / 2 * thickness * n for p, n in zip(point, out)])
                    self.moduli.append(MODULUS * stiffness(point))

    def cells(self):
        """The places of the eight nodes of a face, for each element."""
        around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
        for i in range(self.columns):
            for j in range(self.rows):
                yield [(2 * i + a, 2 * j + b) for a, b in around]

    def elements(self):
        for face in self.cells():
            bottom = [self.numbers[*at, 0] for at in face]
            top = [self.numbers[*at, 2] for at in face]
            yield bottom[:4] + top[:4] + bottom[4:] + top[4:] + [self.numbers[*at, 1] for at in face[:4]]


def shapes(r, s):
    """Shape functions of an eight-node quadrilateral and their derivatives."""
    corner = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    n, dr, ds = [], [], []
    for a, b in corner:
        n.append((1 + a * r) * (1 + b * s) * (a * r + b * s - 1) / 4)
        dr.append(a * (1 + b * s) * (2 * a * r + b * s) / 4)
        ds.append(b * (1 + a * r) * (a * r + 2 * b * s) / 4)
    for a, b in [(0, -1), (1, 0), (0, 1), (-1, 0)]:
        if a == 0:
            n.append((1 - r * r) * (1 + b * s) / 2)
            dr.append(-r * (1 + b * s))
            ds.append(b * (1 - r * r) / 2)
        else:
            n.append((1 + a * r) * (1 - s * s) / 2)
            dr.append(a * (1 - s * s) / 2)
            ds.append(-s * (1 + a * r))
    return n, dr, ds


def footprint(mesh):
    """Forces at places of the middle surface: a pressure (1 - r^2/R^2)^2 about the touch, 1 N together."""
    touch = mesh.middle[0 if mesh.columns == mesh.rows else mesh.columns, 0]
    forces = {}
    gauss = [-math.sqrt(0.6), 0.0, math.sqrt(0.6)], [5 / 9, 8 / 9, 5 / 9]
    parts = 4  # sub-squares of an element along each side
    for face in mesh.cells():
        points = [mesh.middle[at] for at in face]
        if min(math.dist(p, touch) for p in points) > 2 * FOOTPRINT:
            continue
        for a in range(parts):
            for b in range(parts):
                for gr, wr in zip(*gauss):
                    for gs, ws in zip(*gauss):
                        r, s = (2 * a + 1 + gr) / parts - 1, (2 * b + 1 + gs) / parts - 1
                        n, dr, ds = shapes(r, s)
                        at = [sum(w * p[k] for w, p in zip(n, points)) for k in range(3)]
                        tr = [sum(w * p[k] for w, p in zip(dr, points)) for k in range(3)]
                        ts = [sum(w * p[k] for w, p in zip(ds, points)) for k in range(3)]
                        cross = [
                            tr[1] * ts[2] - tr[2] * ts[1],
                            tr[2] * ts[0] - tr[0] * ts[2],
                            tr[0] * ts[1] - tr[1] * ts[0],
                        ]
                        rest = 1 - math.dist(at, touch) ** 2 / FOOTPRINT**2
                        if rest <= 0:
                            continue
                        share = rest**2 * math.hypot(*cross) * wr * ws
                        for place, w in zip(face, n):
                            forces[place] = forces.get(place, 0) + share * w
    total = sum(forces.values())
    return {mesh.numbers[*place, k]: force / total / 2 for place, force in forces.items() for k in (0, 2)}


def deck(mesh, mirrored, around, forces, share):
    lines = ["*NODE, NSET=ALL"]
    lines += [f"{n + 1}, {p[0]:.12g}, {p[1]:.12g}, {p[2]:.12g}" for n, p in enumerate(mesh.points)]
    lines.append("*ELEMENT, TYPE=C3D20R, ELSET=BRICKS")
    for n, element in enumerate(mesh.elements()):
        words = list(map(str, [n + 1, *element]))
        lines += [", ".join(words[:11]) + ",", ", ".join(words[11:])]
    least, most = min(mesh.moduli) * 0.5, max(mesh.moduli) * 2
    # The modulus is the temperature: nodes then have each their own.
    lines += ["*MATERIAL, NAME=SOFT", "*ELASTIC"]
    lines += [f"{least:.9g}, {POISSON}, {least:.9g}", f"{most:.9g}, {POISSON}, {most:.9g}"]
    lines += ["*SOLID SECTION, ELSET=BRICKS, MATERIAL=SOFT"]
    lines.append("*INITIAL CONDITIONS, TYPE=TEMPERATURE")
    lines += [f"{n + 1}, {modulus:.9g}" for n, modulus in enumerate(mesh.moduli)]
    lines.append("*BOUNDARY")
    for (i, j, _), node in mesh.numbers.items():
        first, last, end = i == 0, i == 2 * mesh.columns, j == 2 * mesh.rows
        if end or (last and not around) or (first and not mirrored):
            lines.append(f"{node}, 1, 3")
            continue
        if (first and mirrored) or (last and around):
            lines.append(f"{node}, 1, 1")
        if j == 0:
            lines.append(f"{node}, 2, 2")
    lines.append("*NSET, NSET=LOADED")
    lines += [f"{node}," for node in forces]
    lines += ["*STEP", "*STATIC", "*TEMPERATURE"]
    lines += [f"{n + 1}, {modulus:.9g}" for n, modulus in enumerate(mesh.moduli)]
    lines.append("*CLOAD")
    lines += [f"{node}, 3, {-force * share:.12g}" for node, force in forces.items()]
    lines += ["*NODE PRINT, NSET=LOADED", "U", "*END STEP"]
    return "\n".join(lines) + "\n"


def compliance(folder, name, place, stiffness, thickness, mirrored, around, cells):
    mesh = Mesh(place, cells, mirrored, stiffness, thickness, 0.8 if name == "sheet" else 0.3)
    forces = footprint(mesh)
    share = 0.25 if mirrored else 0.5  # of the load, in the part that is computed
    job = os.path.join(folder, f"{name}_{round(thickness * 1e3)}_{cells}")
    with open(job + ".inp", "w") as file:
        file.write(deck(mesh, mirrored, around, forces, share))
    done = subprocess.run(["ccx", os.path.basename(job)], cwd=folder, capture_output=True, text=True)
    work = 0.0
    with open(job + ".dat") as file:
        for line in file:
            words = line.split()
            if len(words) == 4 and words[0].isdigit():
                work += forces[int(words[0])] * share * -float(words[3])
    if work <= 0:
        raise SystemExit(f"{job}: expected displacements, found none; ccx said:\n{done.stdout[-2000:]}")
    return work / share


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "."
    os.makedirs(folder, exist_ok=True)
    only = sys.argv[2:]
    print("#pragma once\n#include <array>\n#include <string_view>\n")
    print("// Made by calculix_shells.py, which says how: CalculiX 2.20, C3D20R.\n")
    print("namespace palp {\n")
    print("/// The stiffness of a whole thin object under a fingertip.")
    print("struct CalculixShell {")
    print("    std::string_view name;")
    print("    double           thickness; ///< [m]")
    print("    double           stiffness; ///< 1/c [N/m]")
    print("    double           meshError; ///< change from elements 1.5 times as large [1]")
    print("};\n")
    print(f"inline constexpr std::array<CalculixShell, {len(OBJECTS)}> kCalculixShells{{{{")
    for name, place, stiffness, thickness, mirrored, around in OBJECTS:
        if only and name not in only:
            continue
        coarse, fine = (
            compliance(folder, name, place, stiffness, thickness, mirrored, around, cells) for cells in (16, 24)
        )
        print(f'    {{"{name}", {thickness:g}, {1 / fine:.5g}, {fine / coarse - 1:.1e}}},', flush=True)
    print("}};\n\n} // namespace palp")


if __name__ == "__main__":
    main()
