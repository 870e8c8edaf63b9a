#!/usr/bin/env python3
"""A finger slides over a hidden wart, and over the same skin without it. Writes stroke.svg into the folder that is given."""

import sys
from pathlib import Path

import numpy as np
import palpate
import picture

SKIN = dict(thickness="4 mm", poisson=0.45, foundation="1.74 MPa/m", window="50 mm", cells=32, footprint_radius="3.6 mm",
            static_friction=0, dynamic_friction=0, solver="host")

x, y = np.meshgrid(np.linspace(-0.04, 0.04, 81), np.linspace(-0.03, 0.03, 61))
points = np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()])
wart = 3e5 * (1 + 9 * np.exp(-(x ** 2 + y ** 2).ravel() / (2 * 3e-3 ** 2)))  # [Pa]

times = [0, 1, 2.5, 4.5]  # down beside the wart, wait for the force, across it
places = [[-0.02, 0, 3e-3], [-0.02, 0, -1e-3], [-0.02, 0, -1e-3], [0.02, 0, -1e-3]]
curves = {}
for name, stiffness in (("with a wart", wart), ("without", np.full(len(points), 3e5))):
    forces, _ = palpate.Object(points, stiffness, **SKIN).run(times, places)
    slide = slice(2500, 4500)
    curves[name] = (np.linspace(-20, 20, 2000), forces[slide, 2])
    print(f"{name}: {forces[slide, 2].min():.3f} to {forces[slide, 2].max():.3f} N")
picture.lines(Path(sys.argv[1]) / "stroke.svg", "A finger 1 mm deep slides over skin at 20 mm/s", "place [mm]",
              "force [N]", curves)
