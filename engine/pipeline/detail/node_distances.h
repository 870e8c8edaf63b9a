#pragma once
#include <cstddef>
#include <functional>

#include "engine/core/grid.h"

namespace palp {

/// Returns the square of the distance of each node from the nearest of some nodes [m^2]; infinite if there are none.
/// \source Felzenszwalb and Huttenlocher 2012
[[nodiscard]] NodeField squaredDistances(const PlateGrid& grid, const std::function<bool(std::size_t)>& isOne);

} // namespace palp
