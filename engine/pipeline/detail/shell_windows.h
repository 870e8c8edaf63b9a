#pragma once
#include <array>
#include <compare>
#include <map>
#include <mutex>

#include "engine/force/compliance_table.h"
#include "engine/plate/shell.h"

namespace palp {

/// What decides, but for a factor of all compliances, how a homogeneous shell bends in a given patch window: in steps,
/// so that shells that hardly differ are one.
struct ShellShape {
    int                thin       = 0;  ///< bending over stretching, as a length, over the window
    int                curved     = 0;  ///< the largest of the curvatures, by which the window is deep, over that
    std::array<int, 3> shares     = {}; ///< of that largest along x, along z and across
    int                foundation = 0;  ///< over the bending of a wave as long as the window

    auto operator<=>(const ShellShape&) const = default;
};

/// Returns the shape of the shell of the mean rigidity and curvature, to 1 % of the curvature and of the foundation.
/// \param below  k of what lies below, its mean over the window without what is held [Pa/m]
[[nodiscard]] ShellShape meanShape(const Shell& shell, double below);

/// Returns a shell of this shape throughout, with a rigidity of 1 N m, on the grid and with the edges of another.
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
