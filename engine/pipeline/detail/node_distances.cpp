#include "engine/pipeline/detail/node_distances.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace palp {

NodeField squaredDistances(const PlateGrid& grid, const std::function<bool(std::size_t)>& isOne)
{
    constexpr double kFar = std::numeric_limits<double>::infinity();
    const auto       at   = [&](int i, int j) { return std::size_t(i) * std::size_t(grid.nodesZ()) + std::size_t(j); };
    NodeField        along(grid, kFar), squares(grid); // along z first
    const double     hx2 = grid.spacingX * grid.spacingX;
    for (int i = 0; i <= grid.cellsX; ++i) {
        const auto sweep = [&](int first, int end, int step) {
            double away = kFar;
            for (int j = first; j != end; j += step) {
                away        = isOne(at(i, j)) ? 0 : away + grid.spacingZ;
                along(i, j) = std::min(along(i, j), away);
            }
        };
        sweep(0, grid.nodesZ(), 1);
        sweep(grid.cellsZ, -1, -1);
    }
    // Then the least over x of (i - k)^2 hx^2 + along(k)^2: the lower envelope of parabolas, which the last ones of a
    // stack make up, each from a place on.
    std::vector<int>    stack(std::size_t(grid.nodesX()));
    std::vector<double> from(stack.size());
    const auto          square = [&](int k, int j) { return along(k, j) * along(k, j); };
    for (int j = 0; j <= grid.cellsZ; ++j) {
        int        count = 0;
        const auto meet  = [&](int a, int b) { // place at which b becomes lower than a, which comes before it [cells]
            return (a + b) / 2.0 + (square(b, j) - square(a, j)) / (2 * hx2 * (b - a));
        };
        for (int k = 0; k <= grid.cellsX; ++k) {
            if (along(k, j) == kFar) continue;
            while (count > 0 && meet(stack[std::size_t(count - 1)], k) <= from[std::size_t(count - 1)]) --count;
            from[std::size_t(count)]    = count > 0 ? meet(stack[std::size_t(count - 1)], k) : -kFar;
            stack[std::size_t(count++)] = k;
        }
        for (int i = 0, low = 0; i <= grid.cellsX; ++i) {
            while (low + 1 < count && from[std::size_t(low + 1)] < i) ++low;
            const int k   = count > 0 ? stack[std::size_t(low)] : 0;
            squares(i, j) = count > 0 ? (i - k) * (i - k) * hx2 + square(k, j) : kFar;
        }
    }
    return squares;
}

} // namespace palp
