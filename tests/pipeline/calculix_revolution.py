#!/usr/bin/env python3
"""Computes thin bodies of revolution by CalculiX and prints tests/pipeline/calculix_revolution.h.

    python3 tests/pipeline/calculix_revolution.py [log] > tests/pipeline/calculix_revolution.h

It needs ccx and numpy (Debian: calculix-ccx, python3-numpy) and half an hour. The tests read the header and need none of
them. Each body is a surface of revolution about z of a meridian, of quadratic bricks C3D20R, of which the half with y > 0
is solved. Nodes that are held do not move, so bricks begin where they end. It is pressed against its normal by a pressure
(1 - d^2/a^2)^2, d the straight distance of the middle surface from the touch, half on either face. The compliance is the
work of the load. It is computed on two meshes, the finer of which has three elements along it for two of the coarser, and
carried on to elements of no size as an error of first order goes; what that added is printed as the error of the mesh.

It does not tell what bricks through the thickness are in error by, which are two on both meshes: with one alone a sphere
of 2 mm is 0.66 % stiffer, with six 0.04 % softer. Near the pole of the sphere the numbers
come within 0.2 % of elements about its axis, as calculix_bodies.py has them, under the same load.
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
TOUCHED, CLAMPED, LARGEST = 1e-3, 0.03e-3, 3.5e-3  # of elements of the coarser mesh [m]
GROWTH = 0.13  # of an element's size over the way to the next; a ratio of 1.14
REFINED = 2, 3  # elements of the two meshes over half of those of the sizes above
ACROSS = 2  # elements through the thickness
HOLE = 0.2e-3  # radius at a pole [m]


class Body(NamedTuple):
    """A meridian t -> r, z [m] from where it is held on, upwards: what is outside lies to its right."""

    name: str
    meridian: Callable
    ends: tuple  # of t
    held: int  # how many of its ends are held
    places: tuple  # t of the touches
    closed: bool = False  # whether it ends in a pole


def sine(degrees):
    return numpy.sin(numpy.radians(degrees))


def cosine(degrees):
    return numpy.cos(numpy.radians(degrees))


def spheroid(a, c):
    """By its polar angle."""
    return lambda t: (a * sine(t), c * cosine(t))


def below(z, c):
    """The polar angle of a height."""
    return math.degrees(math.acos(z / c))


BODIES = [
    Body("tube", lambda t: (0.02 + 0 * t, t), (0.005, 0.1), 1, (0.05, 0.085, 0.03)),
    Body("torus", lambda t: (0.05 + 0.02 * cosine(t), 0.02 * sine(t)), (-50, 230), 2, (0, 90, 180)),
    Body("bowl", lambda t: (0.03 * sine(t), -0.03 * cosine(t)), (15, 120), 1, (60, 90)),
    Body("sphere", spheroid(0.03, 0.03), (102, 0), 1, (40, 70), True),
    Body("waist", lambda t: (0.015 + 6 * t * t, t), (-0.045, 0.05), 1, (0, 0.02)),
    Body("cone", lambda t: (0.03 - t / 3, t), (0.005, 0.06), 1, (0.03, 0.045)),
    Body("oblate", spheroid(0.04, 0.025), (below(-0.012, 0.025), 0), 1, (40, 70), True),
    Body("prolate", spheroid(0.022, 0.045), (below(-0.025, 0.045), 0), 1, (45, 80), True),
]


class Meridian:
    """A body's meridian by its length s [m]."""

    def __init__(self, body):
        self.body, parts = body, numpy.linspace(*body.ends, 100001)
        r, z = body.meridian(parts)
        if body.closed:
            kept = r >= HOLE
            parts, r, z = parts[kept], r[kept], z[kept]
        self.t, self.s = parts, numpy.concatenate([[0], numpy.cumsum(numpy.hypot(numpy.diff(r), numpy.diff(z)))])
        self.length, self.widest = self.s[-1], r.max()

    def place_of(self, t):
        order = slice(None, None, 1 if self.t[-1] > self.t[0] else -1)
        return float(numpy.interp(t, self.t[order], self.s[order]))

    def at(self, s):
        """r, z and where the outside is."""
        t, low = numpy.interp(s, self.s, self.t), self.body.ends
        step = 1e-5 * (low[1] - low[0])
        (r, z), (r0, z0), (r1, z1) = (self.body.meridian(x) for x in (t, t - step, t + step))
        length = numpy.hypot(r1 - r0, z1 - z0)
        return r, z, (z1 - z0) / length, (r0 - r1) / length


def graded(length, size, parts):
    """Corner nodes along a line, at sizes that are a function of the place; `parts` are for two of their elements."""
    fine = numpy.linspace(0, length, 100001)
    middles = (fine[1:] + fine[:-1]) / 2
    count = numpy.concatenate([[0], numpy.cumsum(numpy.diff(fine) / size(middles))])
    elements = parts * math.ceil(count[-1] / 2)
    return numpy.interp(numpy.linspace(0, count[-1], elements + 1), count, fine)


def with_middles(corners):
    found = numpy.empty(2 * len(corners) - 1)
    found[::2], found[1::2] = corners, (corners[1:] + corners[:-1]) / 2
    return found


def about(distance):
    """Sizes of elements by their distance from the touch [m]."""
    return TOUCHED + GROWTH * numpy.maximum(0, distance - 2 * FOOTPRINT)


def lines_of(meridian, touch, parts):
    """s and phi of all lines of nodes: of corners, and halfway between."""
    def along(s):
        size = numpy.minimum(LARGEST, about(abs(s - touch)))
        for clamp in (0, meridian.length)[: meridian.body.held]:
            size = numpy.minimum(size, CLAMPED + GROWTH * abs(s - clamp))
        return size
    r0 = float(meridian.at(touch)[0])
    largest = LARGEST * r0 / meridian.widest
    around = graded(math.pi * r0, lambda x: numpy.minimum(max(largest, TOUCHED), about(x)), parts) / r0
    return with_middles(graded(meridian.length, along, parts)), with_middles(around)


def quadratic(x):
    """Values at -1, 0 and 1 of what a line of three nodes interpolates by."""
    return numpy.array([x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2])


AROUND = [(0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0)]  # nodes of a face: first along phi, then s


def shapes(x, y):
    """Shape functions of a face of eight nodes, in the order of AROUND; x along s, y along phi."""
    found = []
    for i, j in AROUND:
        a, b = i - 1, j - 1
        if a and b:
            found.append((1 + a * x) * (1 + b * y) * (a * x + b * y - 1) / 4)
        else:
            found.append((1 - x * x) * (1 + b * y) / 2 if b else (1 + a * x) * (1 - y * y) / 2)
    return found


def footprint(meridian, touch, s, phi):
    """Forces at nodes i, j of the middle surface, half a newton together, and the direction of the inside."""
    points, weights = numpy.polynomial.legendre.leggauss(12)
    r0, z0, n_r, n_z = meridian.at(touch)
    forces = {}
    for i in range(0, len(s) - 1, 2):
        if min(abs(s[i] - touch), abs(s[i + 2] - touch)) > 2 * FOOTPRINT:
            continue
        for j in range(0, len(phi) - 1, 2):
            if r0 * phi[j] > 2 * FOOTPRINT:
                break
            for x, u in zip(points, weights):
                r, z, *_ = meridian.at(s[i] + (s[i + 2] - s[i]) * (x + 1) / 2)
                for y, v in zip(points, weights):
                    angle = phi[j] + (phi[j + 2] - phi[j]) * (y + 1) / 2
                    square = (r * math.cos(angle) - r0) ** 2 + (r * math.sin(angle)) ** 2 + (z - z0) ** 2
                    if square >= FOOTPRINT**2:
                        continue
                    share = (1 - square / FOOTPRINT**2) ** 2 * r * u * v * (s[i + 2] - s[i]) * (phi[j + 2] - phi[j])
                    for (a, b), weight in zip(AROUND, shapes(x, y)):
                        forces[i + a, j + b] = forces.get((i + a, j + b), 0.0) + share * weight
    total = 2 * sum(forces.values())
    return {node: force / total for node, force in forces.items()}, [-float(n_r), 0.0, -float(n_z)]


def deck(body, place, thickness, parts):
    """Its lines up to the step, forces at nodes, half a newton together, where they point, and what is held."""
    meridian = Meridian(body)
    touch = meridian.place_of(place)
    s, phi = lines_of(meridian, touch, parts)
    r, z, n_r, n_z = meridian.at(s)
    numbers, lines, held, mirrored = {}, ["*NODE, NSET=ALL"], [], []
    layers = 2 * ACROSS
    for i in range(len(s)):
        for j in range(len(phi)):
            for k in range(layers + 1):
                if i % 2 + j % 2 + k % 2 > 1:
                    continue  # bricks have none in the middles of their faces
                numbers[i, j, k] = len(numbers) + 1
                up = thickness * (k / layers - 0.5)
                out = r[i] + up * n_r[i]
                x, y = out * math.cos(phi[j]), out * math.sin(phi[j])
                lines.append(f"{len(numbers)}, {x:.14g}, {y:.14g}, {z[i] + up * n_z[i]:.14g}")
                if i == 0 or (body.held == 2 and i == len(s) - 1):
                    held.append(len(numbers))
                elif j in (0, len(phi) - 1):
                    mirrored.append(len(numbers))
    lines.append("*ELEMENT, TYPE=C3D20R, ELSET=SHEET")
    count = 0
    for i in range(0, len(s) - 1, 2):
        for j in range(0, len(phi) - 1, 2):
            for k in range(0, layers, 2):
                bottom, top = ([numbers[i + a, j + b, k + c] for a, b in AROUND] for c in (0, 2))
                posts = [numbers[i + a, j + b, k + 1] for a, b in AROUND[:4]]
                count += 1
                words = [str(w) for w in [count, *bottom[:4], *top[:4], *bottom[4:], *top[4:], *posts]]
                lines += [", ".join(words[:11]) + ",", ", ".join(words[11:])]
    lines += ["*MATERIAL, NAME=SOFT", "*ELASTIC", f"{MODULUS}, {POISSON}", "*SOLID SECTION, ELSET=SHEET, MATERIAL=SOFT"]
    lines.append("*BOUNDARY")
    lines += [f"{node}, 1, 3" for node in held] + [f"{node}, 2, 2" for node in mirrored]
    on_middle, inside = footprint(meridian, touch, s, phi)
    forces = {numbers[i, j, k]: force / 2 for (i, j), force in on_middle.items() for k in (0, layers)}
    return lines, forces, inside, held


def compliance(body, place, thickness, parts):
    """Of the whole body: the half of it gives way by the same under half of the force [m/N]."""
    return 2 * calculix.compliance(*deck(body, place, thickness, parts)[:3])


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
        coarse, fine = (compliance(body, place, h, parts) for parts in REFINED)
        value = fine + (fine - coarse) / (REFINED[1] / REFINED[0] - 1)
        row = f'    {{"{body.name}", {place:g}, {h:g}, {1 / value:.5g}, {value / fine - 1:.1e}}},'
        print(row, flush=True)
        for log in sys.argv[1:2]:
            with open(log, "a") as file:
                file.write(row + "\n")
    print("}};\n\n} // namespace palp")


if __name__ == "__main__":
    main()
