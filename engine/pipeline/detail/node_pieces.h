#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/core/grid.h"

namespace palp {

using Nodes = std::vector<std::size_t>;

/// Returns the pieces of some nodes of a grid that hang together, at corners too.
template <class Which>
std::vector<Nodes> connected(const PlateGrid& grid, const Which& isOne)
{
    std::vector<Nodes> pieces;
    std::vector<bool>  left(grid.nodes());
    for (std::size_t n = 0; n < left.size(); ++n) left[n] = isOne(n);
    const auto take = [&](std::size_t node, Nodes& piece) {
        if (left[node]) piece.push_back(node);
        left[node] = false;
    };
    for (std::size_t n = 0; n < left.size(); ++n) {
        Nodes piece;
        take(n, piece);
        for (std::size_t k = 0; k < piece.size(); ++k) {
            const int i = int(piece[k]) / grid.nodesZ(), j = int(piece[k]) % grid.nodesZ();
            for (int a = std::max(i - 1, 0); a <= std::min(i + 1, grid.cellsX); ++a)
                for (int b = std::max(j - 1, 0); b <= std::min(j + 1, grid.cellsZ); ++b)
                    take(std::size_t(a * grid.nodesZ() + b), piece);
        }
        if (!piece.empty()) pieces.push_back(std::move(piece));
    }
    return pieces;
}

} // namespace palp
