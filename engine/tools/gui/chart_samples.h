#pragma once
#include <cstddef>
#include <vector>

#include "engine/core/grid.h"

namespace palp {

/// A field on a coarser grid of the same extent, for a small picture of it.
struct ChartSamples {
    int                 nodesX = 0, nodesZ = 0;
    std::vector<double> values; ///< [i * nodesZ + j], as a NodeField

    [[nodiscard]] double at(int i, int j) const { return values[std::size_t(i * nodesZ + j)]; }
};

/// At most 49 x 49 values of a field, times `factor`. Each is the mean over the field's nodes nearest to it, of at most
/// 4 x 4 of them, evenly spread: the cost does not grow with the grid.
[[nodiscard]] ChartSamples chartSamples(const NodeField& field, double factor);

} // namespace palp
