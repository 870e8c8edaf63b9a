#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/core/grid.h"

namespace palp {

using Nodes = std::vector<std::size_t>;

/// Calls visit(node) for the nodes around one, itself included.
template <class Visit>
void eachAround(const PlateGrid& grid, std::size_t node, const Visit& visit)
{
    const int i = int(node) / grid.nodesZ(), j = int(node) % grid.nodesZ();
    for (int a = std::max(i - 1, 0); a <= std::min(i + 1, grid.cellsX); ++a)
        for (int b = std::max(j - 1, 0); b <= std::min(j + 1, grid.cellsZ); ++b)
            visit(std::size_t(a * grid.nodesZ() + b));
}

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
        for (std::size_t k = 0; k < piece.size(); ++k)
            eachAround(grid, piece[k], [&](std::size_t node) { take(node, piece); });
        if (!piece.empty()) pieces.push_back(std::move(piece));
    }
    return pieces;
}

} // namespace palp
