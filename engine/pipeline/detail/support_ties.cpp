#include "engine/pipeline/detail/support_ties.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <vector>

#include "engine/pipeline/detail/node_pieces.h"
#include "engine/pipeline/detail/whole_object.h"

namespace palp {
namespace {

/// Returns the node that lies nearest to a place in cells.
std::optional<std::size_t> nodeAt(const PlateGrid& grid, double i, double j)
{
    const double a = std::round(i), b = std::round(j);
    if (!(a >= 0 && b >= 0 && a <= grid.cellsX && b <= grid.cellsZ)) return {};
    return std::size_t(a) * std::size_t(grid.nodesZ()) + std::size_t(b);
}

/// The way of a support to a side of the window.
struct Way {
    Nodes  nodes;           ///< that it passes, those of the support too
    double length  = 0;     ///< from its middle to the border [m]
    double onSheet = 0;     ///< of that what is not held [m]
    bool   returns = false; ///< to the sheet, after it has left that
};

/// \param angle  in the grid, its cells being squares
Way wayOf(const Patch& patch, const Nodes& support, double angle)
{
    const PlateGrid& grid  = patch.plate.grid;
    const double     stepI = std::cos(angle) / 2, stepJ = std::sin(angle) / 2; // half a cell
    Way              way;
    double           middleI = 0, middleJ = 0;
    for (const std::size_t node : support) {
        const int i = int(node) / grid.nodesZ(), j = int(node) % grid.nodesZ();
        middleI += double(i) / double(support.size());
        middleJ += double(j) / double(support.size());
        for (int n = 0;; ++n) {
            const auto at = nodeAt(grid, i + n * stepI, j + n * stepJ);
            if (!at) break;
            way.nodes.push_back(*at);
        }
    }
    bool hasLeft = false;
    for (int n = 0;; ++n) { // along its middle
        const auto at = nodeAt(grid, middleI + n * stepI, middleJ + n * stepJ);
        if (!at) break;
        const bool sheet = isOnSheet(patch, *at);
        way.returns      = way.returns || (sheet && hasLeft);
        hasLeft          = hasLeft || !sheet;
        if (!sheet) continue;
        const double step = std::hypot(stepI * grid.spacingX, stepJ * grid.spacingZ);
        way.length += step;
        if (!isHeld(patch, *at)) way.onSheet += step;
    }
    return way;
}

/// Returns the shortest way to a border, if there is one that does not come back to the sheet.
std::optional<Way> shortestWay(const Patch& patch, const Nodes& support)
{
    constexpr int      kDirections = 32;
    std::optional<Way> shortest;
    for (int d = 0; d < kDirections; ++d) {
        Way way = wayOf(patch, support, 2 * std::numbers::pi * d / kDirections);
        if (!way.returns && (!shortest || way.length < shortest->length)) shortest = std::move(way);
    }
    return shortest;
}

} // namespace

HeldInPlane heldInPlane(const Patch& patch)
{
    constexpr double kNear = 0.125; // of the root of the sheet's area [1]
    HeldInPlane      held{patch.held};
    if (patch.held.values().empty() || patch.covered.values().empty()) return held;
    const PlateGrid& grid     = patch.plate.grid;
    const auto       supports = connected(grid, [&](std::size_t n) { return isHeld(patch, n); });
    if (supports.size() < 2) return held;
    const auto isAtSide = [&](std::size_t node) {
        const int i = int(node) / grid.nodesZ(), j = int(node) % grid.nodesZ();
        return i == 0 || j == 0 || i == grid.cellsX || j == grid.cellsZ;
    };
    double area = 0; // [m^2]
    for (std::size_t n = 0; n < grid.nodes(); ++n) area += isOnSheet(patch, n);
    area *= grid.spacingX * grid.spacingZ;
    std::size_t reaching = 0;
    for (const Nodes& support : supports) {
        const bool isOut = std::ranges::any_of(support, isAtSide);
        const auto way   = isOut ? std::nullopt : shortestWay(patch, support);
        const bool tied  = way && way->onSheet <= kNear * std::sqrt(area);
        if (tied)
            for (const std::size_t node : way->nodes) held.share.values()[node] = 1;
        held.tied += tied;
        reaching += isOut || tied;
    }
    held.without = int(supports.size() - std::max<std::size_t>(reaching, 1));
    return held;
}

} // namespace palp
