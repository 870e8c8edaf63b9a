#pragma once
#include <cstdint>
#include <vector>

#include "compute_shaders/shared/rigidity_level.h"
#include "engine/plate/multigrid/detail/grid_hierarchy.h"

namespace palp {

/// The levels next to each other in arrays that hold all of them, where a kernel that knows only one finds its part,
/// too.
struct RigidityLayout {
    std::vector<shared::RigidityLevel> levels;
    std::size_t                        numbers = 0, words = 0; ///< of rigidities or divisors; of marks or lists
    std::uint32_t                      rows = 0, tileRows = 0; ///< of all levels but the coarsest
};

[[nodiscard]] RigidityLayout rigidityLayout(const GridHierarchy& grids);

} // namespace palp
