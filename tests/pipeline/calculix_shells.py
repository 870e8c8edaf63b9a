#!/usr/bin/env python3
"""Computes whole thin objects by CalculiX and prints tests/pipeline/calculix_shells.h.

    python3 tests/pipeline/calculix_shells.py [FOLDER] > tests/pipeline/calculix_shells.h

It needs ccx (Debian: calculix-ccx) and two minutes. The tests read the header and need neither. Each object is one layer of
quadratic bricks C3D20R, symmetric about the planes through the touch where its stiffness is, pressed by a footprint of 4 mm on both of its faces alike and held at its far border, or
at its root or stem alone. The compliance is the work of the load. It is computed on two meshes, whose elements differ by a
factor of 1.5 in size, and carried on to elements of no size as an error of first order goes (1.3 was seen, the corner of
a held border has a singular stress); what that added is printed as the error of the mesh. (Shell elements would do, but CalculiX makes them stiff across their thickness wherever a rotation is
held, so that on planes of symmetry they converge with their size alone.)
"""

import math
import os
import sys
from typing import Callable, NamedTuple

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from calculix import run, work  # noqa: E402

MODULUS, POISSON, FOOTPRINT = 1e6, 0.45, 4e-3  # [Pa], [1], [m]


def azimuthal(axes, reach, tilt=0.0):
    """A piece of an ellipsoid: directions in an azimuthal map about the pole, `reach` [rad] to each side.

    The map's middle is tilted towards x by `tilt` [rad], on the sphere that is stretched to the ellipsoid.
    """

    def place(x, y):
        angle = math.hypot(x, y) * reach
        share = math.sin(angle) / angle * reach if angle > 0 else reach
        a, b, c = share * x, share * y, math.cos(angle)
        a, c = a * math.cos(tilt) + c * math.sin(tilt), c * math.cos(tilt) - a * math.sin(tilt)
        return axes[0] * a, axes[1] * b, axes[2] * c

    return place


def turned(radius, length):
    """A surface of revolution about the y axis, all around; radius(y) [m]."""

    def place(x, y):
        r = radius(y * length / 2)
        return r * math.sin(math.pi * x), y * length / 2, r * math.cos(math.pi * x)

    return place


def flat(size):
    return lambda x, y: (x * size / 2, y * size / 2, 0.0)


def waves(size, length, crest):
    """Parallel waves of a crest of radius `crest` [m], a crest in the middle."""
    q = 2 * math.pi / length
    return lambda x, y: (x * size / 2, y * size / 2, math.cos(q * x * size / 2) / (crest * q * q))


def leaf(along, wide):
    """A flat lobe: a half ellipse from its root at x = -1, touched at two thirds of its length `along` [m].

    Its tip is cut where it is a fifth of `wide` [m] wide, so that the elements stay good.
    """

    def place(x, y):
        share = (4 + 3 * x - x * x) / 6
        return along * share, wide / 2 * y * math.sqrt(1 - 0.96 * share**2), 0.0

    return place


def bowl(stem, rim, bend):
    """A round dish from its stem's radius to its rim's, touched midway; it bulges by `bend` [1/m], at y = 1 it closes."""

    def place(x, y):
        r, angle = (stem + rim) / 2 + x * (rim - stem) / 2, math.pi * y
        height = (math.sqrt(1 - (bend * r) ** 2) - 1) / bend if bend else 0.0
        return r * math.cos(angle), r * math.sin(angle), height

    return place


def between(length, width, along, across):
    """A sheet from support to support, curved by `along` and `across` [1/m], > 0 where it bulges up."""

    def place(x, y):
        u, v = x * length / 2, y * width / 2
        return u, v, -(along * u * u + across * v * v) / 2

    return place


def even(point):
    return 1.0


def spot(factor, off, sigma=4e-3):
    """Stiffness over the modulus: `factor` at a place on the x axis `off` [m] beside the touch."""

    def stiffness(point):
        squared = (point[0] - off) ** 2 + point[1] ** 2
        return 1 + (factor - 1) * math.exp(-squared / (2 * sigma**2)) if point[2] >= 0 else 1.0

    return stiffness


def slope(length):
    """Stiffness over the modulus that rises with x, from 1 in the middle to twice that at `length` [m]."""
    return lambda point: 1 + point[0] / length


AXES = (60e-3, 45e-3, 35e-3)
ROUND = azimuthal((50e-3, 50e-3, 50e-3), 1.75)
EGG = azimuthal(AXES, 1.75)
SIDE = azimuthal((60e-3, 35e-3, 45e-3), 1.75)
CIGAR = azimuthal((80e-3, 30e-3, 30e-3), 1.75)
SHOULDER = azimuthal(AXES, 1.75, math.pi / 4)
TUBE = turned(lambda y: 40e-3, 80e-3)
WAIST = turned(lambda y: 120e-3 - math.sqrt(80e-3**2 - y**2), 80e-3)
RIDGE = waves(60e-3, 60e-3, 25e-3)
LOBE = leaf(60e-3, 50e-3)
NEAR = 0.15  # of mean elements at a border that is felt


class Shape(NamedTuple):
    """An object, and which of its borders x = -1, x = 1, y = 1 are held; the others are free."""

    name: str
    place: Callable
    stiffness: Callable
    thickness: float  # [m]
    mirrored: bool = True  # the half x < 0 is a mirror image too, as the half y < 0 always is
    around: bool = False  # at x = 1 it meets itself
    closes: bool = False  # at y = 1 it meets its mirror image
    held: str = "first last end"
    finest: float = 0.3  # elements at the touch over the mean ones
    last: float = 2.4  # elements at the border; what is held is stressed within a thickness of there

    def share(self):
        """Of the load, in the part that is computed."""
        return 0.25 if self.mirrored else 0.5


def held_at_its_stem(name, bend, thickness):
    return Shape(name, bowl(8e-3, 40e-3, bend), even, thickness, mirrored=False, closes=True, held="first", last=NEAR)


OBJECTS = [
    Shape("sphere", ROUND, even, 1e-3),
    Shape("sphere", ROUND, even, 2e-3),
    Shape("sphere", ROUND, even, 3e-3),
    Shape("ellipsoid", EGG, even, 1e-3),
    Shape("ellipsoid", EGG, even, 2e-3),
    Shape("ellipsoid", EGG, even, 3e-3),
    Shape("shoulder", SHOULDER, even, 1e-3, mirrored=False),
    Shape("shoulder", SHOULDER, even, 2e-3, mirrored=False),
    Shape("side", SIDE, even, 1e-3),
    Shape("side", SIDE, even, 2e-3),
    Shape("cigar", CIGAR, even, 1e-3, last=1.2),
    Shape("cigar", CIGAR, even, 2e-3, last=1.2),
    Shape("slope", EGG, slope(66e-3), 1e-3, mirrored=False),
    Shape("wart_under", ROUND, spot(10, 0), 1e-3),
    Shape("wart_under", ROUND, spot(10, 0), 2e-3),
    Shape("wart_beside", ROUND, spot(10, 8e-3), 1e-3, mirrored=False),
    Shape("soft_spot", ROUND, spot(0.2, 0), 1e-3),
    Shape("tube", TUBE, even, 1e-3, around=True, last=NEAR),
    Shape("waist", WAIST, even, 1e-3, around=True, last=NEAR),
    Shape("ridge", RIDGE, even, 1e-3, last=NEAR),
    Shape("ridge", RIDGE, even, 2e-3, last=NEAR),
    Shape("sheet", flat(40e-3), even, 1e-3, finest=0.8, last=NEAR),
    Shape("drum", flat(120e-3), even, 2e-3, last=NEAR),
    Shape("drum_wart", flat(120e-3), spot(10, 8e-3), 2e-3, mirrored=False, last=NEAR),
    Shape("lobe", LOBE, even, 2e-3, mirrored=False, held="first", last=NEAR),
    Shape("lobe", LOBE, even, 3e-3, mirrored=False, held="first", last=NEAR),
    Shape("band", between(80e-3, 30e-3, 0, 0), even, 1.5e-3, held="last", last=NEAR),
    Shape("arch", between(80e-3, 30e-3, 5, 0), even, 1.5e-3, held="last", last=NEAR),
    Shape("low_arch", between(80e-3, 30e-3, 1.5, 0), even, 1.5e-3, held="last", last=NEAR),
    Shape("vault", between(60e-3, 80e-3, 8, 0), even, 1.5e-3, held="last", last=NEAR),
    Shape("saddle", between(70e-3, 50e-3, 6, -6), even, 1.5e-3, held="last", last=NEAR),
    Shape("bridge", between(70e-3, 70e-3, 8.33, 8.33), even, 1.5e-3, held="last", last=NEAR),
    held_at_its_stem("disc", 0, 2e-3),
    held_at_its_stem("shallow_dish", 5, 2e-3),
    held_at_its_stem("dish", 10, 2e-3),
]


def graded(s, finest, last):
    """A cubic from 0 to 1 whose elements are `finest` times the mean ones at the touch and `last` times at the border."""
    t = abs(s)
    return math.copysign((finest + last - 2) * t**3 + (3 - 2 * finest - last) * t**2 + finest * t, s)


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

    def __init__(self, shape, cells):
        place, mirrored = shape.place, shape.mirrored
        self.columns, self.rows = (cells if mirrored else 2 * cells), cells
        self.numbers, self.points, self.moduli, self.middle = {}, [], [], {}
        for i in range(2 * self.columns + 1):
            for j in range(2 * self.rows + 1):
                if i % 2 and j % 2:
                    continue  # no node in the middle of a face
                x = graded(i / (2 * cells) - (0 if mirrored else 1), shape.finest, shape.last)
                y = graded(j / (2 * cells), shape.finest, shape.last)
                point, out = place(x, y), normal(place, x, y)
                self.middle[i, j] = point
                for k in (0, 2) if i % 2 or j % 2 else (0, 1, 2):
                    self.numbers[i, j, k] = len(self.points) + 1
                    self.points.append([p + (k - 1) / 2 * shape.thickness * n for p, n in zip(point, out)])
                    self.moduli.append(MODULUS * shape.stiffness(point))

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


def borders(mesh, shape):
    """What is held, and what the planes of symmetry allow."""
    lines = []
    for (i, j, _), node in mesh.numbers.items():
        first, last, end = i == 0, i == 2 * mesh.columns, j == 2 * mesh.rows
        is_first = first and not shape.mirrored and "first" in shape.held
        if is_first or (last and not shape.around and "last" in shape.held) or (end and "end" in shape.held):
            lines.append(f"{node}, 1, 3")
            continue
        if (first and shape.mirrored) or (last and shape.around):
            lines.append(f"{node}, 1, 1")
        if j == 0 or (end and shape.closes):
            lines.append(f"{node}, 2, 2")
    return lines


def deck(mesh, shape, forces, load):
    """The input of a press by `load` [N] on the whole object."""
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
    lines += borders(mesh, shape)
    lines.append("*NSET, NSET=LOADED")
    lines += [f"{node}," for node in forces]
    lines += ["*STEP", "*STATIC", "*TEMPERATURE"]
    lines += [f"{n + 1}, {modulus:.9g}" for n, modulus in enumerate(mesh.moduli)]
    lines.append("*CLOAD")
    inward = [-n for n in normal(shape.place, 0, 0)]
    for node, force in forces.items():
        lines += [f"{node}, {k + 1}, {force * shape.share() * load * inward[k]:.12g}" for k in range(3) if inward[k]]
    lines += ["*NODE PRINT, NSET=LOADED", "U", "*END STEP"]
    return "\n".join(lines) + "\n"


def depth(words, shape, forces):
    """What a line of displacements adds to the depth of the dent, the mean under the footprint [m]."""
    return work(words, forces, [-n for n in normal(shape.place, 0, 0)])


def compliance(folder, shape, cells):
    mesh = Mesh(shape, cells)
    forces = footprint(mesh)
    job = f"{shape.name}_{round(shape.thickness * 1e3)}_{cells}"
    lines, said = run(folder, job, deck(mesh, shape, forces, 1))
    found = sum(depth(words, shape, forces) for words in lines)
    if found <= 0:
        raise SystemExit(f"{job}: expected displacements, found none; ccx said:\n{said[-2000:]}")
    return found


def extrapolated(coarse, fine):
    """The value for elements of no size, if the error is of first order, and what that added to the finer mesh's."""
    value = fine + (fine - coarse) / (1.5 - 1)
    return value, value / fine - 1


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
    print("    double           meshError; ///< of c on the finer mesh, which is taken off [1]")
    print("};\n")
    print("/// Pressed as calculix_shells.py says.")
    print(f"inline constexpr std::array<CalculixShell, {len(OBJECTS)}> kCalculixShells{{{{")
    for shape in OBJECTS:
        if only and shape.name not in only:
            continue
        coarse, fine = (compliance(folder, shape, cells) for cells in (24, 36))
        value, error = extrapolated(coarse, fine)
        print(f'    {{"{shape.name}", {shape.thickness:g}, {1 / value:.5g}, {error:.1e}}},', flush=True)
    print("}};\n\n} // namespace palp")


if __name__ == "__main__":
    main()
