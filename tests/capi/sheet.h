#pragma once

/// A scene of the C interface's tests: skin on tissue, of some 450 N/m.
inline constexpr const char* kSheet =
    R"({"cloud": "sample:sheet", "points": 6000, "stiffness": {"law": "constant", "value": 3e5},
    "thickness": "4 mm", "poisson": 0.45, "foundation": "1.74 MPa/m", "window": "40 mm", "cells": 32,
    "footprint_radius": "3.6 mm", "place": [0, 0, 0], "solver": "host"})";
