#pragma once
#include <cstddef>
#include <vector>

#include "engine/core/grid.h"

namespace palp {

/// A field on a coarser grid of the same extent, for a small picture of it.
struct CoarseField {
    int                 nodesX = 0, nodesZ = 0;
    std::vector<double> values; ///< indexed [i * nodesZ + j], as in a NodeField

    [[nodiscard]] double at(int i, int j) const { return values[std::size_t(i * nodesZ + j)]; }
};

/// Returns at most 49 x 49 values of a field, times `factor`. Each is the mean over at most 4 x 4 of the field's nodes
/// nearest to it, evenly spread, so that the cost does not grow with the grid.
[[nodiscard]] CoarseField coarseField(const NodeField& field, double factor);

} // namespace palp
