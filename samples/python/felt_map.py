#!/usr/bin/env python3
"""How stiff does each place of a palm feel? Writes felt_map.svg into the folder that is given."""

import sys
from pathlib import Path

import numpy as np
import palpate
import picture

palm = palpate.Object.scene({"cloud": "sample:palm", "points": 12000, "cells": 32, "solver": "host"})
points = palm.points
chosen = np.random.default_rng(1).permutation(len(points))[:1200]  # a tenth of them shows it
felt = palm.felt_map(points[chosen], sides=np.tile([0, 0, 1.0], (len(chosen), 1)))
print(f"{np.isfinite(felt).sum()} places, {np.nanmin(felt):.0f} to {np.nanmax(felt):.0f} N/m")
picture.points(Path(sys.argv[1]) / "felt_map.svg", "Felt stiffness of a palm: four tendons, and the soft ball of the thumb",
               "N/m", 1e3 * points[chosen, 0], 1e3 * points[chosen, 1], felt)
