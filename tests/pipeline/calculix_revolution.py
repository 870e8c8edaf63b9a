#!/usr/bin/env python3
"""Computes thin bodies of revolution by CalculiX and prints tests/pipeline/calculix_revolution.h.

    python3 tests/pipeline/calculix_revolution.py > tests/pipeline/calculix_revolution.h

It needs ccx and numpy (Debian: calculix-ccx, python3-numpy) and ten minutes. The tests read the header and need none of
them. Each body is half of a surface of revolution about z, of one layer of quadratic bricks C3D20R, clamped over a part
of its meridian, and pressed against its normal by a pressure (1 - d^2/R^2)^2, half on either face. The compliance is the
work of the load. It is computed on two meshes and carried on to elements of no size as an error of first order goes, which
a clamp has at its corners; what that added is printed as the error of the mesh.
"""

import math
import os
import sys
from typing import Callable, NamedTuple

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import calculix  # noqa: E402

MODULUS, POISSON, FOOTPRINT = 1e5, 0.45, 4e-3  # [Pa], [1], [m]
THICKNESSES = 1e-3, 2e-3  # [m]
SIZES = 1.2e-3, 0.8e-3  # of the elements about the touch on the two meshes [m]
LARGEST, GROWTH = 2.5, 0.15  # of the elements far away, over those; how fast they grow on the way there [1]
CLAMPED = 0.1  # of those where it begins to be held, over those about the touch [1]
HOLE = 0.3e-3  # radius at the pole of a closed body [m]


class Body(NamedTuple):
    name: str
    meridian: Callable  # t -> r, z [m]
    ends: tuple  # of t
    held: Callable  # r, z -> whether it is held
    places: tuple  # t of the touches
    outside: int = 1  # whether the finger is on the side of (z', -r')
    ring: bool = False  # whether the ends meet


def circle(radius, middle=0.0):
    return lambda t: (middle + radius * math.sin(math.radians(t)), radius * math.cos(math.radians(t)))


def ellipse(a, c):
    return lambda t: (a * math.sin(math.radians(t)), c * math.cos(math.radians(t)))


BODIES = [
    Body("tube", lambda t: (0.02, t), (0, 0.1), lambda r, z: z < 0.005, (0.03, 0.05, 0.085)),
    Body("torus", lambda t: (0.05 + 0.02 * math.cos(math.radians(t)), 0.02 * math.sin(math.radians(t))), (-90, 270),
         lambda r, z: math.hypot(r - 0.05, z) > 0 and z < -0.02 * math.cos(math.radians(40)), (0, 90, 180), 1, True),
    Body("bowl", lambda t: (0.03 * math.sin(math.radians(t)), -0.03 * math.cos(math.radians(t))), (0, 120),
         lambda r, z: z < -0.03 * math.cos(math.radians(15)), (60, 90)),
    Body("sphere", circle(0.03), (0, 180), lambda r, z: z < -0.03 * math.cos(math.radians(78)), (40, 70), -1),
    Body("waist", lambda t: (0.015 + 6 * t * t, t), (-0.05, 0.05), lambda r, z: z < -0.045, (0, 0.02)),
    Body("cone", lambda t: (0.03 - t / 3, t), (0, 0.06), lambda r, z: z < 0.005, (0.03, 0.045)),
    Body("oblate", ellipse(0.04, 0.025), (0, 180), lambda r, z: z < -0.012, (40, 70), -1),
    Body("prolate", ellipse(0.022, 0.045), (0, 180), lambda r, z: z < -0.025, (45, 80), -1),
]


def graded(length, at, size, scale, clamps=()):
    """Places along a line of that length, from one element to the next, dense about `at` and at clamps."""
    def density(x):
        wanted = [LARGEST * size * scale, size + GROWTH * max(0.0, abs(x - at) - 1.5 * FOOTPRINT)]
        return 1 / min(wanted + [CLAMPED * size + 2 * GROWTH * abs(x - clamp) for clamp in clamps])
    fine = numpy.linspace(0, length, 20001)
    count = numpy.concatenate([[0], numpy.cumsum([density((a + b) / 2) * (b - a) for a, b in zip(fine, fine[1:])])])
    number = math.ceil(count[-1])
    return numpy.interp(numpy.linspace(0, count[-1], number + 1), count, fine)


def lines_along(body, place, size):
    """Parameters of the corner nodes along the meridian, with one where what is held begins."""
    low, high = body.ends
    t = numpy.linspace(low, high, 40001)
    points = numpy.array([body.meridian(x) for x in t])
    if not body.ring:  # closed bodies have a small hole at each pole
        kept = points[:, 0] > HOLE
        t, points = t[kept], points[kept]
    # What is held is a clamp: only its first elements matter.
    held = numpy.array([body.held(*p) for p in points])
    along = numpy.concatenate([[0], numpy.cumsum(numpy.hypot(*numpy.diff(points, axis=0).T))])
    cuts = [0.0] + [along[k] for k in range(1, len(t)) if held[k] != held[k - 1]] + [along[-1]]
    at, found = numpy.interp(place, t, along), []
    for a, b in zip(cuts, cuts[1:]):
        clamps = [cut - a for cut in cuts[1:-1]]
        found += list(a + graded(b - a, at - a, size, 1, clamps))[:-1]
    return numpy.interp(found + [along[-1]], along, t)


def deck(body, place, thickness, size):
    """Its lines up to the step, forces at nodes, half a newton together, and where they point."""
    corners = lines_along(body, place, size)
    r0, z0 = body.meridian(place)
    around = graded(math.pi * r0, 0.0, size, max(1.0, r0 / 0.02)) / r0
    columns = len(around) - 1
    rows = len(corners) - 1
    numbers, lines, middle = {}, ["*NODE, NSET=ALL"], {}
    last = 2 * rows

    def parameter(values, k):
        return values[k // 2] if k % 2 == 0 else (values[k // 2] + values[k // 2 + 1]) / 2

    def surface(t, phi):
        step = 1e-5 * (body.ends[1] - body.ends[0])
        (r, z), (ra, za), (rb, zb) = body.meridian(t), body.meridian(t - step), body.meridian(t + step)
        nr, nz = body.outside * (zb - za), -body.outside * (rb - ra)
        length = math.hypot(nr, nz)
        direction = numpy.array([nr * math.cos(phi), nr * math.sin(phi), nz]) / length
        return numpy.array([r * math.cos(phi), r * math.sin(phi), z]), direction

    def node(i, j, layer):
        if body.ring and i == last:
            i = 0
        if (i, j, layer) not in numbers:
            numbers[i, j, layer] = len(numbers) + 1
            t, phi = parameter(corners, i), parameter(around, j)
            p, n = surface(t, phi)
            p = p + (layer - 1) / 2 * thickness * n
            lines.append(f"{len(numbers)}, " + ", ".join(f"{x:.12g}" for x in p))
            middle[i, j] = t, phi
        return numbers[i, j, layer]

    elements, faces = [], []
    for a in range(rows):
        for b in range(columns):
            i, j = 2 * a, 2 * b
            face = [(i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2), (i + 1, j), (i + 2, j + 1), (i + 1, j + 2), (i, j + 1)]
            faces.append(face)
            bottom, top = ([node(*n, layer) for n in face] for layer in (0, 2))
            posts = [node(*n, 1) for n in face[:4]]
            if wrong_way(body):
                bottom, top = top, bottom
            elements.append([*bottom[:4], *top[:4], *bottom[4:], *top[4:], *posts])
    lines.append("*ELEMENT, TYPE=C3D20R, ELSET=SHEET")
    for n, nodes in enumerate(elements):
        words = [str(w) for w in [n + 1, *nodes]]
        lines += [", ".join(words[:11]) + ",", ", ".join(words[11:])]
    lines += ["*MATERIAL, NAME=SOFT", "*ELASTIC", f"{MODULUS}, {POISSON}", "*SOLID SECTION, ELSET=SHEET, MATERIAL=SOFT"]
    lines.append("*BOUNDARY")
    for (i, j, layer), number in numbers.items():
        r, z = body.meridian(parameter(corners, i))
        if body.held(r, z):
            lines.append(f"{number}, 1, 3")
        elif j in (0, 2 * columns):
            lines.append(f"{number}, 2, 2")
    touch, outward = surface(place, 0.0)
    forces = {}
    parts = 8
    steps = [(2 * k + 1) / parts - 1 for k in range(parts)]
    for face in faces:
        t = [parameter(corners, n[0]) for n in face[:4]]
        phi = [parameter(around, n[1]) for n in face[:4]]
        if numpy.linalg.norm(surface(sum(t) / 4, sum(phi) / 4)[0] - touch) > 4 * FOOTPRINT:
            continue
        points = numpy.array([surface(parameter(corners, n[0]), parameter(around, n[1]))[0] for n in face])
        for x in steps:
            for y in steps:
                n, dx, dy = shapes(x, y)
                rest = 1 - numpy.sum((n @ points - touch) ** 2) / FOOTPRINT**2
                if rest <= 0:
                    continue
                share = rest**2 * numpy.linalg.norm(numpy.cross(dx @ points, dy @ points))
                for at, weight in zip(face, n):
                    for layer in (0, 2):
                        forces[node(*at, layer)] = forces.get(node(*at, layer), 0.0) + share * weight
    total = sum(forces.values())
    return lines, {n: force / (2 * total) for n, force in forces.items()}, list(-outward)


def wrong_way(body):
    """Whether bricks whose first side runs along t and whose second along phi would be inside out."""
    return body.outside > 0


def shapes(r, s):
    """Shape functions of a face of eight nodes at a place of its own, and their derivatives."""
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


def main():
    cases = [(body, place, h) for body in BODIES for place in body.places for h in THICKNESSES]
    print("#pragma once\n#include <array>\n#include <string_view>\n")
    print("// Made by calculix_revolution.py, which says how: CalculiX 2.20, C3D20R.\n")
    print("namespace palp {\n")
    print("/// The stiffness of a thin body of revolution under a fingertip.")
    print("struct CalculixRevolution {")
    print("    std::string_view body;")
    print("    double           place;     ///< along its meridian, an angle [degrees] or z [m]")
    print("    double           thickness; ///< [m]")
    print("    double           stiffness; ///< 1/c [N/m]")
    print("    double           meshError; ///< of c on the finer mesh, which is taken off [1]")
    print("};\n")
    print(f"inline constexpr std::array<CalculixRevolution, {len(cases)}> kCalculixRevolutions{{{{", flush=True)
    for body, place, h in cases:
        coarse, fine = (2 * calculix.compliance(*deck(body, place, h, size)) for size in SIZES)
        value = fine + (fine - coarse) / (SIZES[0] / SIZES[1] - 1)
        print(f'    {{"{body.name}", {place:g}, {h:g}, {1 / value:.5g}, {value / fine - 1:.1e}}},', flush=True)
    print("}};\n\n} // namespace palp")


if __name__ == "__main__":
    main()
