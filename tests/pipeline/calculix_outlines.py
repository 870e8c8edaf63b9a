#!/usr/bin/env python3
"""Computes curved sheets of any outline by CalculiX and prints tests/pipeline/calculix_outlines.h.

    python3 tests/pipeline/calculix_outlines.py > tests/pipeline/calculix_outlines.h

It needs ccx, gmsh and numpy (Debian: calculix-ccx, python3-gmsh, python3-numpy) and two minutes. The tests read the header
and need none of them. Each sheet is one layer of quadratic bricks C3D20R and wedges C3D15, held over pieces of it, and
pressed at the origin along the normal by a pressure (1 - r^2/R^2)^2, half on either face. The compliance is the work of
the load. It is computed on two meshes and carried on to elements of no size as an error of first order goes (0.9 to 1.2
was seen, the corner of a held border has a singular stress); what that added is printed as the error of the mesh.
"""

import math
import os
import sys
from typing import Callable, NamedTuple

import gmsh
import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import calculix  # noqa: E402

MODULUS, POISSON, FOOTPRINT, THICKNESS = 1e6, 0.45, 4e-3, 1.5e-3  # [Pa], [1], [m], [m]
SIZES = 1.5e-3, 1e-3  # of the elements of the two meshes [m]
PRESSES = {"arch": 0.07, "arch at its border": 0.05, "deep arch": 0.055, "cap on a segment": 0.006}  # [N]
INCREMENTS = 10


class Box(NamedTuple):
    x0: float
    z0: float
    x1: float
    z1: float

    def made(self):
        return 2, gmsh.model.occ.addRectangle(self.x0, self.z0, 0, self.x1 - self.x0, self.z1 - self.z0)

    def holds(self, x, z):
        return self.x0 - 1e-7 <= x <= self.x1 + 1e-7 and self.z0 - 1e-7 <= z <= self.z1 + 1e-7


class Disc(NamedTuple):
    x: float
    z: float
    radius: float

    def made(self):
        return 2, gmsh.model.occ.addDisk(self.x, self.z, 0, self.radius, self.radius)

    def holds(self, x, z):
        return math.hypot(x - self.x, z - self.z) <= self.radius + 1e-7


class Beyond(Disc):
    """What lies outside of a disc."""

    def holds(self, x, z):
        return math.hypot(x - self.x, z - self.z) >= self.radius - 1e-7


class Outline(NamedTuple):
    name: str
    height: Callable  # [m]
    pieces: list
    held: list
    holes: list = []


def dome(x, z):
    return -5 * (x * x + z * z)  # R = 0.1 m


def vault(x, z):
    return -5 * x * x


def arch(radius, x0):
    return lambda x, z: math.sqrt(radius**2 - (x + x0) ** 2) - math.sqrt(radius**2 - x0**2)


def gutter(x, z):
    return math.sqrt(0.04**2 - z * z) - 0.04


def corrugated(x0):
    return lambda x, z: 0.002 * (math.cos(2 * math.pi * (x + x0) / 0.024) - math.cos(2 * math.pi * x0 / 0.024))


def j(x, z):  # flat, then R = 40 mm, pressed 25 mm behind where it begins
    return math.sqrt(0.04**2 - max(x + 0.025, 0) ** 2) - math.sqrt(0.04**2 - 0.025**2)


def s(x, z):  # two arcs of R = 30 mm that turn to and fro, pressed where they meet
    middle = math.sqrt(0.03**2 - 0.018**2)
    return math.sqrt(0.03**2 - (x + 0.018) ** 2) - middle if x < 0 else middle - math.sqrt(0.03**2 - (x - 0.018) ** 2)


def trough(x, z):  # R = 30 mm, pressed 60 degrees from its middle
    return math.sqrt(0.03**2 - (z + 0.026) ** 2) - math.sqrt(0.03**2 - 0.026**2)


def cap(x, z):  # R = 0.2 m, pressed 20 mm beside its middle
    return math.sqrt(0.04 - x * x - (z + 0.02) ** 2) - math.sqrt(0.04 - 0.02**2)


def between(half, held, width, x0, z0):
    """A strip that is held at both ends, pressed at x0, z0 of its own places."""
    ends = [Box(-0.06 - x0, -0.04, -held - x0, 0.04), Box(held - x0, -0.04, 0.06 - x0, 0.04)]
    return [Box(-half - x0, -width - z0, half - x0, width - z0)], ends


def lump(height, width, x0=0.0):
    return lambda x, z: height * math.exp(-((x - x0) ** 2 + z * z) / (2 * width * width))


U = [Box(-0.024, -0.007, 0.024, 0.007), Box(-0.024, -0.007, -0.010, 0.05), Box(0.010, -0.007, 0.024, 0.05)]
L = [Box(-0.007, -0.007, 0.04, 0.007), Box(-0.007, -0.007, 0.007, 0.04)]
ENDS = [Box(-0.05, -0.01, -0.032, 0.01), Box(0.032, -0.01, 0.05, 0.01)]
SPOTS = [Box(-0.04, 0.018, -0.02, 0.034), Box(0.02, 0.018, 0.04, 0.034)]
HOLES = [Disc(0.018 * math.cos(n * math.pi / 6), 0.018 * math.sin(n * math.pi / 6), 3e-3) for n in range(12)]
PANEL = [Box(-0.04, -0.03, 0.04, 0.03)]
SIDES = [Box(-0.05, -0.04, -0.034, 0.04), Box(0.034, -0.04, 0.05, 0.04)]
OUTLINES = [
    Outline("u dome", dome, U, [Box(-0.03, 0.042, 0.03, 0.06)]),
    Outline("u vault", vault, U, [Box(-0.03, 0.042, 0.03, 0.06)]),
    Outline("l dome", dome, L, [Box(0.032, -0.01, 0.05, 0.01), Box(-0.01, 0.032, 0.01, 0.05)]),
    Outline("strip dome", dome, [Box(-0.04, -0.007, 0.04, 0.007)], ENDS),
    Outline("ring dome", dome, [Disc(0, 0.026, 0.032)], SPOTS, [Disc(0, 0.026, 0.02)]),
    Outline("holes dome", dome, [Disc(0, 0, 0.04)], [Beyond(0, 0, 0.032)], HOLES),
    Outline("gentle lump", lump(2e-3, 10e-3), PANEL, SIDES),
    Outline("steep lump", lump(2e-3, 5e-3), PANEL, SIDES),
    Outline("small lump", lump(1e-3, 4e-3), PANEL, SIDES),
    Outline("beside a lump", lump(2e-3, 8e-3, 0.012), PANEL, SIDES),
    Outline("arch", arch(0.05, 0.01), *between(0.036, 0.032, 0.02, 0.01, 0)),
    Outline("arch at its border", arch(0.05, 0), *between(0.036, 0.032, 0.02, 0, 0.015)),
    Outline("deep arch", arch(0.04, 0.015), *between(0.036, 0.034, 0.02, 0.015, 0.005)),
    Outline("curled strip", arch(0.05, 0.02), [Box(-0.056, -0.02, 0.016, 0.02)], [Box(-0.09, -0.04, -0.052, 0.04)]),
    Outline("gutter", gutter, [Box(-0.05, -0.02, 0.05, 0.02)], [Box(-0.06, -0.03, -0.045, 0.03)]),
    Outline("gutter at its tip", gutter, [Box(-0.095, -0.02, 0.005, 0.02)], [Box(-0.11, -0.03, -0.09, 0.03)]),
    Outline("corrugated strip", corrugated(0), [Box(-0.036, -0.012, 0.036, 0.012)], [Box(-0.07, -0.04, -0.032, 0.04)]),
    Outline("corrugated flank", corrugated(0.006), *between(0.036, 0.032, 0.012, 0.006, 0)),
    Outline("j at its tip", j, [Box(-0.061, -0.012, 0.011, 0.012)], [Box(-0.1, -0.03, -0.057, 0.03)]),
    Outline("s in its middle", s, *between(0.036, 0.032, 0.012, 0, 0)),
    Outline("trough at its side", trough, [Box(-0.04, -0.055, 0.04, 0.003)], [Box(-0.06, -0.08, 0.06, -0.0535)]),
    Outline("cap on a segment", cap, [Disc(0, -0.02, 0.041)], [Box(-0.06, -0.08, -0.03, 0.04)]),
]


def mesh(outline, size):
    """Faces of the middle surface, eight or six nodes each, and where nodes lie [m]; held borders are edges."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    occ = gmsh.model.occ
    sheet = [piece.made() for piece in outline.pieces]
    if len(sheet) > 1:
        sheet, _ = occ.fuse(sheet[:1], sheet[1:])
    if outline.holes:
        sheet, _ = occ.cut(sheet, [hole.made() for hole in outline.holes])
    parts, of = occ.fragment(sheet, [held.made() for held in outline.held])
    kept = {part for n in range(len(sheet)) for part in of[n]}
    occ.remove([part for part in parts if part not in kept])
    occ.synchronize()
    for name, value in {"MeshSizeMin": size, "MeshSizeMax": size, "Algorithm": 6, "RecombineAll": 1,
                        "SecondOrderIncomplete": 1}.items():  # fmt: skip
        gmsh.option.setNumber("Mesh." + name, value)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(2)
    numbers, places, _ = gmsh.model.mesh.getNodes()
    at = {int(n): (places[3 * k], places[3 * k + 1]) for k, n in enumerate(numbers)}
    faces = []
    for kind, nodes in ((16, 8), (9, 6)):
        of = [int(n) for n in gmsh.model.mesh.getElementsByType(kind)[1]]
        faces += [turned(of[k : k + nodes], at) for k in range(0, len(of), nodes)]
    gmsh.finalize()
    return faces, at


def turned(face, at):
    """A face whose corners go round to the left."""
    corners = len(face) // 2
    around = [at[n] for n in face[:corners]]
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(around, around[1:] + around[:1]))
    return face if area > 0 else [face[-k % corners] for k in range(corners)] + face[:corners - 1 : -1]


def normal(height, x, z, step=1e-6):
    along_x, along_z = height(x + step, z) - height(x - step, z), height(x, z + step) - height(x, z - step)
    up = numpy.array([-along_x, -along_z, 2 * step])
    return up / numpy.linalg.norm(up)


def shapes(corners, r, s):
    """Shape functions of a face at a place of its own, and their derivatives."""
    if corners == 3:
        t = 1 - r - s
        n = [t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * t * r, 4 * r * s, 4 * s * t]
        dr = [1 - 4 * t, 4 * r - 1, 0, 4 * (t - r), 4 * s, -4 * s]
        ds = [1 - 4 * t, 0, 4 * s - 1, -4 * r, 4 * r, 4 * (t - s)]
        return numpy.array([n, dr, ds])
    n, dr, ds = [], [], []
    for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        n.append((1 + a * r) * (1 + b * s) * (a * r + b * s - 1) / 4)
        dr.append(a * (1 + b * s) * (2 * a * r + b * s) / 4)
        ds.append(b * (1 + a * r) * (a * r + 2 * b * s) / 4)
    for a, b in ((0, -1), (1, 0), (0, 1), (-1, 0)):
        n.append((1 - r * r) * (1 + b * s) / 2 if a == 0 else (1 + a * r) * (1 - s * s) / 2)
        dr.append(-r * (1 + b * s) if a == 0 else a * (1 - s * s) / 2)
        ds.append(b * (1 - r * r) / 2 if a == 0 else -s * (1 + a * r))
    return numpy.array([n, dr, ds])


def samples(corners):
    """Places of a face and their shares of its area, many: the footprint ends within faces."""
    parts = 12
    steps = [(k + 0.5) / parts for k in range(parts)]
    if corners == 4:
        return [(2 * a - 1, 2 * b - 1) for a in steps for b in steps]
    third = 1 / (3 * parts)  # the middles of small triangles
    low = [(a / parts + third, b / parts + third) for a in range(parts) for b in range(parts - a)]
    high = [(a / parts + 2 * third, b / parts + 2 * third) for a in range(parts - 1) for b in range(parts - 1 - a)]
    return low + high


def footprint(outline, faces, at):
    """Forces at nodes of the middle surface, 1 N together."""
    forces = {}
    for face in faces:
        points = numpy.array([[*at[n], outline.height(*at[n])] for n in face])
        if numpy.linalg.norm(points, axis=1).min() > 2 * FOOTPRINT:
            continue
        for r, s in samples(len(face) // 2):
            n, dr, ds = shapes(len(face) // 2, r, s)
            rest = 1 - numpy.sum((n @ points) ** 2) / FOOTPRINT**2
            if rest > 0:
                share = rest**2 * numpy.linalg.norm(numpy.cross(dr @ points, ds @ points))
                share *= 4 if len(face) == 8 else 0.5
                share /= len(samples(len(face) // 2))
                for node, weight in zip(face, n):
                    forces[node] = forces.get(node, 0) + share * weight
    total = sum(forces.values())
    return {node: force / total for node, force in forces.items()}


def deck(outline, size):
    """Its lines up to the step, forces at nodes, 1 N together, and where they point."""
    faces, at = mesh(outline, size)
    corners = {n for face in faces for n in face[: len(face) // 2]}
    numbers, lines = {}, ["*NODE, NSET=ALL"]
    for node in sorted({n for face in faces for n in face}):
        x, z = at[node]
        for layer in (0, 1, 2) if node in corners else (0, 2):
            place = numpy.array([x, z, outline.height(x, z)]) + (layer - 1) / 2 * THICKNESS * normal(outline.height, x, z)
            numbers[node, layer] = len(numbers) + 1
            lines.append(f"{len(numbers)}, " + ", ".join(f"{p:.12g}" for p in place))
    for kind, nodes in (("C3D20R", 8), ("C3D15", 6)):
        lines.append(f"*ELEMENT, TYPE={kind}, ELSET=SHEET")
        for n, face in enumerate(faces):
            if len(face) != nodes:
                continue
            bottom, top = ([numbers[node, layer] for node in face] for layer in (0, 2))
            half, posts = nodes // 2, [numbers[node, 1] for node in face[: nodes // 2]]
            words = [str(w) for w in [n + 1, *bottom[:half], *top[:half], *bottom[half:], *top[half:], *posts]]
            lines += [", ".join(words[:11]) + ",", ", ".join(words[11:])]
    lines += ["*MATERIAL, NAME=SOFT", "*ELASTIC", f"{MODULUS}, {POISSON}", "*SOLID SECTION, ELSET=SHEET, MATERIAL=SOFT"]
    lines.append("*BOUNDARY")
    lines += [f"{number}, 1, 3" for (n, _), number in numbers.items() if any(held.holds(*at[n]) for held in outline.held)]
    forces = {numbers[n, k]: force / 2 for n, force in footprint(outline, faces, at).items() for k in (0, 2)}
    return lines, forces, list(-normal(outline.height, 0, 0))


def main():
    print("#pragma once\n#include <array>\n#include <string_view>\n")
    print("// Made by calculix_outlines.py, which says how: CalculiX 2.20, C3D20R and C3D15.\n")
    print("namespace palp {\n")
    print("/// The stiffness of a curved sheet of some outline under a fingertip.")
    print("struct CalculixOutline {")
    print("    std::string_view name;")
    print("    double           stiffness; ///< 1/c [N/m]")
    print("    double           meshError; ///< of c on the finer mesh, which is taken off [1]")
    print("};\n")
    print(f"inline constexpr std::array<CalculixOutline, {len(OUTLINES)}> kCalculixOutlines{{{{")
    for outline in OUTLINES:
        coarse, fine = (calculix.compliance(*deck(outline, size)) for size in SIZES)
        value = fine + (fine - coarse) / (SIZES[0] / SIZES[1] - 1)
        print(f'    {{"{outline.name}", {1 / value:.5g}, {value / fine - 1:.1e}}},', flush=True)
    print("}};\n")
    print("/// How deep it gives way under even parts of a force.")
    print("struct CalculixDeepOutline {")
    print("    std::string_view name;")
    print("    double           force; ///< of the last depth [N]")
    print()
    print(f"    std::array<double, {INCREMENTS}> depths; ///< on the finer mesh, whose error is that above [m]")
    print("};\n")
    print(f"inline constexpr std::array<CalculixDeepOutline, {len(PRESSES)}> kCalculixDeepOutlines{{{{")
    for name, force in PRESSES.items():
        outline = next(o for o in OUTLINES if o.name == name)
        numbers = ", ".join(f"{d:.4g}" for d in calculix.depths(*deck(outline, SIZES[1]), force, INCREMENTS))
        print(f'    {{"{name}", {force:g}, {{{numbers}}}}},', flush=True)
    print("}};\n\n} // namespace palp")


if __name__ == "__main__":
    main()
