"""Prints what a clamped sphere gives way by under a fingertip, by CalculiX: the numbers of CalculixBodies.

usage: python3 calculix_bodies.py     (calculix-ccx and python3-numpy of the distribution)

Of radius 1 m and modulus 1 Pa, held 78 degrees from its far end, second-order axisymmetric elements of l/32 about the pole
and three through the thickness; a pressure (1 - r^2/a^2)^2 of a = l along the axis, half on either face, 1 N together. The
compliance is the mean displacement of both faces under it.
"""

import math
import os
import sys

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
import calculix  # noqa: E402

POISSON, FAR_END = 0.45, 0.2  # [1], cosine
FINEST, WIDEST, GROWTH = 32, 0.03, 1.04  # elements a length, [rad], [1]
ACROSS = 3  # elements through the thickness


def angles(length, reach):
    """Corner nodes from the pole to the border [rad]."""
    found, step = [0.0], length / FINEST
    while found[-1] < reach:
        found.append(found[-1] + min(step, WIDEST))
        if found[-1] > 5 * length:
            step *= GROWTH
    return numpy.array(found) * reach / found[-1]


def compliance(thickness):
    """Of a thickness over the radius."""
    length = math.sqrt(thickness) / (12 * (1 - POISSON**2)) ** 0.25
    theta = angles(length, math.acos(-FAR_END))
    count = len(theta) - 1
    numbers = {}

    def node(i, k):
        return numbers.setdefault((i, k), len(numbers) + 1)

    around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
    elements = [
        [node(2 * i + a, 2 * k + b) for a, b in around] for i in range(count) for k in range(ACROSS)
    ]
    lines = ["*NODE, NSET=ALL"]
    for (i, k), number in numbers.items():
        at = theta[i // 2] if i % 2 == 0 else (theta[i // 2] + theta[i // 2 + 1]) / 2
        r = 1 - thickness / 2 + thickness * k / (2 * ACROSS)
        lines.append(f"{number}, {r * math.sin(at) if i else 0.0:.12g}, {r * math.cos(at):.12g}, 0")
    lines.append("*ELEMENT, TYPE=CAX8R, ELSET=S")
    lines += [f"{n + 1}, " + ", ".join(map(str, nodes)) for n, nodes in enumerate(elements)]
    lines += ["*MATERIAL, NAME=M", "*ELASTIC", f"1, {POISSON}", "*SOLID SECTION, ELSET=S, MATERIAL=M", "*BOUNDARY"]
    for (i, k), number in numbers.items():
        if i == 0:
            lines.append(f"{number}, 1, 1")
        if i == 2 * count:
            lines.append(f"{number}, 1, 2")
    forces = {}
    points, weights = numpy.polynomial.legendre.leggauss(6)
    for i in range(count):
        for x, weight in zip(points, weights):
            at = theta[i] + (theta[i + 1] - theta[i]) * (x + 1) / 2
            r = math.sin(at)
            pressure = max(0.0, 1 - (r / length) ** 2) ** 2 * r * weight * (theta[i + 1] - theta[i])
            for j, share in enumerate((x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2)):
                for k in (0, 2 * ACROSS):
                    number = numbers[2 * i + j, k]
                    forces[number] = forces.get(number, 0.0) + pressure * share
    total = sum(forces.values())
    forces = {number: force / total for number, force in forces.items() if force}
    return length, calculix.compliance(lines, forces, (0, -1, 0))


if __name__ == "__main__":
    for h in (0.01, 0.02, 0.04):
        print("h/R %g, l/R %.6g: c E R = %.6g" % (h, *compliance(h)))
