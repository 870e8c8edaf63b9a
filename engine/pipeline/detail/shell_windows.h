#pragma once
#include <array>
#include <map>
#include <mutex>

#include "engine/force/compliance_table.h"
#include "engine/plate/shell.h"

namespace palp {

/// What decides, but for a factor of all compliances, how a homogeneous shell bends in a given patch window, in steps:
/// thickness over window, size of the curvature, its shares along x, z and across, foundation.
using ShellShape = std::array<int, 6>;

/// Returns the shape of the shell of the mean rigidity and curvature, to 1 % of the curvature and of the foundation.
[[nodiscard]] ShellShape meanShape(const Shell& shell);

/// Returns a shell of this shape throughout, on the grid, with the edges and the mean rigidity of another.
[[nodiscard]] Shell shellOfShape(const ShellShape& shape, const Shell& like);

/// ln c(e)/c(0) with its slopes of homogeneous shells in one patch window, by their shape: what was solved for once is
/// kept, and is the same whatever was solved for before.
/// \thread any, under the mutex
struct ShellWindows {
    static constexpr std::size_t kMost = 4096; ///< kept at once, of 1.2 kB each

    std::mutex                                     mutex;
    std::map<ShellShape, ComplianceTable::Entries> known;
};

} // namespace palp
