#!/usr/bin/env python3
"""Prints rows of scene_below_test.cpp: felt stiffness over a nodule, by CalculiX. See README.md beside this file.

Lengths in metres, moduli in pascals; the rows are in mm, kPa and MPa/m.
"""
import itertools
import os
import subprocess
import tempfile

import numpy as np

NU = 0.45
RADIUS = 40e-3  # of the model
ELEMENT = 0.4e-3


def share(r, a):
    """Share of the finger's force within r: the integral of 3 (1 - r^2/a^2)^2 / (pi a^2)."""
    return 1 - (1 - min(1.0, (r / a) ** 2)) ** 3


class Grid:
    """Nodes of eight-node elements on a grid of radius and height."""

    def __init__(self, sheet, tissue, element):
        columns = round(RADIUS / element)
        upper, lower = max(2, round(sheet / element)), round(tissue / element)
        self.r = np.linspace(0, RADIUS, 2 * columns + 1)
        self.z = np.concatenate([np.linspace(-sheet - tissue, -sheet, 2 * lower + 1),
                                 np.linspace(-sheet, 0, 2 * upper + 1)[1:]])
        self.columns, self.rows, self.lower = columns, upper + lower, lower
        self.number = {}

    def node(self, i, k):
        return self.number.setdefault((i, k), len(self.number) + 1)

    def corners(self, i, k):
        around = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)]
        return [self.node(2 * i + di, 2 * k + dk) for di, dk in around]


def deck(grid, moduli, part_of, finger):
    """Returns the text of a CalculiX problem."""
    elements = {part: [] for part in moduli}
    loads = []
    for number, (i, k) in enumerate(itertools.product(range(grid.columns), range(grid.rows)), 1):
        elements[part_of(i, k)].append((number, grid.corners(i, k)))
        inner, outer = grid.r[2 * i], grid.r[2 * i + 2]
        if k == grid.rows - 1 and outer <= finger + 1e-9:
            pressure = (share(outer, finger) - share(inner, finger)) / (np.pi * (outer ** 2 - inner ** 2))
            loads.append(f"{number},P3,{pressure}")
    lines = ["*NODE"]
    lines += [f"{n},{grid.r[i]:.9e},{grid.z[k]:.9e},0" for (i, k), n in grid.number.items()]
    for part, members in elements.items():
        if not members:
            continue
        lines.append(f"*ELEMENT,TYPE=CAX8R,ELSET={part}")
        lines += [",".join(map(str, [number, *corners])) for number, corners in members]
        lines += [f"*MATERIAL,NAME={part}", "*ELASTIC", f"{moduli[part]},{NU}",
                  f"*SOLID SECTION,ELSET={part},MATERIAL={part}"]
    lines.append("*BOUNDARY")
    for (i, k), n in grid.number.items():
        if k == 0:
            lines.append(f"{n},1,2")
        elif i in (0, 2 * grid.columns):
            lines.append(f"{n},1")
    lines += ["*NSET,NSET=TOP"]
    lines += [f"{n}," for (i, k), n in grid.number.items() if k == 2 * grid.rows and grid.r[i] <= finger + 1e-9]
    return "\n".join(lines + ["*STEP", "*STATIC", "*DLOAD", *loads, "*NODE PRINT,NSET=TOP", "U", "*END STEP", ""])


def felt(sheet, skin, tissue, fat, finger, radius=0.0, top=0.0, ratio=1.0, element=ELEMENT):
    """Returns the felt stiffness [N/m]; the nodule's top lies `top` below the sheet."""
    grid = Grid(sheet, tissue, element)
    middle = -(sheet + top + radius)

    def part_of(i, k):
        if k >= grid.lower:
            return "SKIN"
        inside = grid.r[2 * i + 1] ** 2 + (grid.z[2 * k + 1] - middle) ** 2 < radius ** 2
        return "NODULE" if inside else "FAT"

    text = deck(grid, {"SKIN": skin, "FAT": fat, "NODULE": fat * ratio}, part_of, finger)
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "solid.inp"), "w") as file:
            file.write(text)
        subprocess.run(["ccx", "-i", "solid"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(folder, "solid.dat")) as file:
            rows = [line.split() for line in file]
    down = {int(row[0]): -float(row[2]) for row in rows if len(row) == 4 and row[0].isdigit()}
    mean = 0.0
    for i in range(0, 2 * grid.columns, 2):
        inner, outer = grid.r[i], grid.r[i + 2]
        if outer > finger + 1e-9:
            break
        u = [down[grid.number[i + n, 2 * grid.rows]] * grid.r[i + n] for n in range(3)]
        density = (share(outer, finger) - share(inner, finger)) / (outer ** 2 - inner ** 2)
        mean += density * 2 * (outer - inner) / 6 * (u[0] + 4 * u[1] + u[2])  # Simpson's rule
    return 1 / mean


def plate_compliance(rigidity, foundation, finger, elements=70):
    """Returns the mean deflection per newton of an axisymmetric Kirchhoff plate on springs, by cubic elements."""
    x = np.linspace(0, RADIUS, elements + 1)
    size = 2 * (elements + 1)
    matrix, force = np.zeros((size, size)), np.zeros(size)
    for e in range(elements):
        h = x[e + 1] - x[e]
        for point, weight in zip(*np.polynomial.legendre.leggauss(4)):
            s, width = (point + 1) / 2, weight * h / 2
            r = x[e] + s * h
            w = np.array([1 - 3 * s ** 2 + 2 * s ** 3, h * (s - 2 * s ** 2 + s ** 3), 3 * s ** 2 - 2 * s ** 3,
                          h * (s ** 3 - s ** 2)])
            slope = np.array([(6 * s ** 2 - 6 * s) / h, 1 - 4 * s + 3 * s ** 2, (6 * s - 6 * s ** 2) / h,
                              3 * s ** 2 - 2 * s]) / r
            bend = np.array([(12 * s - 6) / h, 6 * s - 4, (6 - 12 * s) / h, 6 * s - 2]) / h
            stiff = rigidity * (np.outer(bend, bend) + np.outer(slope, slope) +
                                NU * (np.outer(bend, slope) + np.outer(slope, bend)))
            at = slice(2 * e, 2 * e + 4)
            matrix[at, at] += 2 * np.pi * r * width * (stiff + foundation * np.outer(w, w))
            if r < finger:
                force[at] += 2 * r * width * w * 3 * (1 - (r / finger) ** 2) ** 2 / finger ** 2
    moves = [n for n in range(size) if n not in (1, size - 1)]  # no slope in the middle and at the rim
    answer = np.linalg.solve(matrix[np.ix_(moves, moves)], force[moves])
    return force[moves] @ answer


def foundation_of(sheet, skin, finger, wanted):
    """Returns the foundation [Pa/m] with which plate and contact are as stiff as wanted [N/m]."""
    rigidity = skin * sheet ** 3 / 12 / (1 - NU ** 2)
    contact = skin * np.pi * finger ** 2 / sheet
    low, high = 1e4, 1e8
    for _ in range(28):
        middle = (low * high) ** 0.5
        stiff = 1 / (1 / contact + plate_compliance(rigidity, middle, finger))
        low, high = (middle, high) if stiff < wanted else (low, middle)
    return middle


SKINS = [(2e-3, 300e3, 20e3), (4e-3, 300e3, 20e3), (1.5e-3, 100e3, 10e3)]
NODULES = [(5e-3, 1e-3, 50), (2.5e-3, 1e-3, 50), (5e-3, 3e-3, 50), (5e-3, 5e-3, 50), (7e-3, 1e-3, 5), (5e-3, 1e-3, 0.1),
           (5e-3, 3e-3, 0.1)]
HELD_OUT = [(3e-3, 200e3, 30e3, 3.6e-3, 20e-3, 4e-3, 2e-3, 20), (1.2e-3, 500e3, 15e3, 3e-3, 12e-3, 3e-3, 0.8e-3, 100),
            (2.5e-3, 150e3, 5e3, 5e-3, 30e-3, 8e-3, 4e-3, 10), (2e-3, 300e3, 20e3, 4e-3, 15e-3, 4e-3, 1.6e-3, 0.3)]


def print_rows(sheet, skin, fat, finger, tissue, nodules):
    plain = felt(sheet, skin, tissue, fat, finger)
    foundation = foundation_of(sheet, skin, finger, plain)
    for radius, top, ratio in nodules:
        over = felt(sheet, skin, tissue, fat, finger, radius, top, ratio) / plain
        print("{%g, %g, %g, %g, %g, %.4g, %g, %g, %g, %.4f}," %
              (1e3 * sheet, skin / 1e3, fat / 1e3, 1e3 * finger, 1e3 * tissue, foundation / 1e6, 1e3 * radius,
               1e3 * top, ratio, over), flush=True)


if __name__ == "__main__":
    for finger_radius in (2.4e-3, 4e-3, 6e-3):
        for sheet_thickness, skin_modulus, fat_modulus in SKINS:
            for depth in (15e-3, 25e-3) if finger_radius == 4e-3 else (15e-3,):
                print_rows(sheet_thickness, skin_modulus, fat_modulus, finger_radius, depth, NODULES)
    for sheet_thickness, skin_modulus, fat_modulus, finger_radius, depth, *nodule in HELD_OUT:
        print_rows(sheet_thickness, skin_modulus, fat_modulus, finger_radius, depth, [nodule])
