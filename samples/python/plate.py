#!/usr/bin/env python3
"""The plate solver against Navier's series: error over grid spacing. Writes plate.svg into the folder that is given."""

import sys
from pathlib import Path

import numpy as np
import palpate
import picture


def navier():
    """Deflection in the middle of a supported unit square under 1 Pa, D = 1 N m (Navier 1820)."""
    m, n = np.meshgrid(np.arange(1, 200, 2), np.arange(1, 200, 2))
    sign = np.where((m + n) // 2 % 2, 1, -1)
    return np.sum(sign * 16 / (np.pi ** 6 * m * n * (m ** 2 + n ** 2) ** 2))


cells = np.array([8, 16, 32, 64, 128])
errors = []
for count in cells:
    share = np.ones(count + 1)
    share[[0, -1]] = 0.5  # of a cell that a node at a side stands for
    forces = np.outer(share, share) / count ** 2
    w, _ = palpate.plate(np.ones((count + 1, count + 1)), forces, edges="supported", tolerance=1e-6)
    errors.append(abs(w[count // 2, count // 2] / navier() - 1))
order = np.log2(np.array(errors[:-1]) / errors[1:])
print("errors", " ".join(f"{e:.2e}" for e in errors), "order", " ".join(f"{o:.2f}" for o in order))
picture.lines(Path(sys.argv[1]) / "plate.svg", "Error of the plate in its middle, against Navier's series",
              "log2 of the cells a side", "log10 of the relative error",
              {"Palpate": (np.log2(cells), np.log10(errors)),
               "second order": (np.log2(cells), np.log10(errors[0]) - 2 * np.log10(cells / 8))})
