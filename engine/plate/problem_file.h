#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/plate/plate.h"

namespace palp {

/// A place whose deflection is requested, measured from the corner node (0, 0).
struct Probe {
    double x = 0; ///< [m]
    double z = 0; ///< [m]
};

/// A plate, its load and the questions about it.
struct PlateProblem {
    Plate                    plate;
    NodeField                nodalForce; ///< [N], see load.h
    std::vector<Probe>       probes;
    std::vector<std::string> warnings{}; ///< one sentence for each input that is legal but probably unintended

    std::vector<std::filesystem::path> files{}; ///< that were read: the problem file and its grids
};

/// Reads a problem file: JSON, in SI units, with comments allowed.
///
///     {"size": [1, 1.5],                          // [m] along x and z
///      "cells": [128, 192],                       // 4 to 4096 per side, 8 388 480 nodes in all
///      "poisson": 0.3,
///      "edges": {"x0": "clamped", "x1": "free", "z0": "supported", "z1": "guided"},    // absent: clamped
///      "foundation": 0,                           // [Pa/m], or a law as of "rigidity"; absent: 0
///      "rigidity": {"law": "linear", "from": 1, "to": 10, "axis": "z"},                // [N m]
///      "load": {"law": "point", "force": 1, "at": [0.5, 0.75]},                        // [N], [m]
///      "probes": [[0.25, 0.25]]}                  // [m], absent: none
///
/// | key | laws |
/// |-----|------|
/// | rigidity | those of parseSpatialLaw across the plate, or {"law": "grid", "file": "D.npy"}: node values [N m] |
/// | foundation | the same [Pa/m]; values of a grid may be 0 |
/// | load | point (force, at), uniform (pressure [Pa]), gaussian (force, centre, sigma), grid (file: pressures [Pa]) |
///
/// A grid is a .npy array of shape (cells_x + 1, cells_z + 1) for the file's own "cells"; its path starts at the
/// problem file's folder.
/// \param cells  solves on another grid: cells along x, with those along z in proportion (rounded); grids are
///               resampled bilinearly
/// \throws Error naming the file and the key, and for JSON that does not parse the line and column
[[nodiscard]] PlateProblem readProblem(const std::filesystem::path& path, std::optional<int> cells = {});

} // namespace palp
