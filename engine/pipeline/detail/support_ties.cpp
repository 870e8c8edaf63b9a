#include "engine/pipeline/detail/support_ties.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "engine/pipeline/detail/ground.h"
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

/// A straight way from a node to a side of the window.
struct Way {
    Nodes  nodes;           ///< that it passes
    double length  = 0;     ///< to the border [m]
    double onSheet = 0;     ///< of that what is not held [m]
    bool   returns = false; ///< to the sheet, after it has left that
};

/// \param i, j  place that it begins at [cells]
Way wayFrom(const Patch& patch, double i, double j, double angle)
{
    const PlateGrid& grid  = patch.plate.grid;
    const double     stepI = std::cos(angle) / 2, stepJ = std::sin(angle) / 2; // half a cell
    const double     step    = std::hypot(stepI * grid.spacingX, stepJ * grid.spacingZ);
    bool             hasLeft = false;
    Way              way;
    for (int n = 0;; ++n) {
        const auto at = nodeAt(grid, i + n * stepI, j + n * stepJ);
        if (!at) return way;
        const bool sheet = isOnSheet(patch, *at);
        way.nodes.push_back(*at);
        way.returns = way.returns || (sheet && hasLeft);
        hasLeft     = hasLeft || !sheet;
        if (!sheet) continue;
        way.length += step;
        if (!isHeld(patch, *at)) way.onSheet += step;
    }
}

/// Returns the nodes that a support passes as it moves to a side of the window; empty: some come back to the sheet.
Nodes swept(const Patch& patch, const Nodes& support, double angle)
{
    const PlateGrid& grid = patch.plate.grid;
    Nodes            nodes;
    for (const std::size_t node : support) {
        const Way way = wayFrom(patch, int(node) / grid.nodesZ(), int(node) % grid.nodesZ(), angle);
        if (way.returns) return {};
        nodes.insert(nodes.end(), way.nodes.begin(), way.nodes.end());
    }
    return nodes;
}

/// Returns the nodes that tie a support to the nearest border that is near; empty: there is none.
/// \param near  [m]
Nodes tieOf(const Patch& patch, const Nodes& support, double near)
{
    constexpr int                          kDirections = 32;
    const PlateGrid&                       grid        = patch.plate.grid;
    double                                 i = 0, j = 0; // the middle
    std::vector<std::pair<double, double>> ways;         // lengths [m] and angles
    for (const std::size_t node : support) {
        i += double(int(node) / grid.nodesZ()) / double(support.size());
        j += double(int(node) % grid.nodesZ()) / double(support.size());
    }
    for (int d = 0; d < kDirections; ++d) {
        const double angle = 2 * std::numbers::pi * d / kDirections;
        const Way    way   = wayFrom(patch, i, j, angle);
        if (way.onSheet <= near) ways.emplace_back(way.length, angle);
    }
    std::ranges::sort(ways);
    for (const auto& [length, angle] : ways)
        if (Nodes nodes = swept(patch, support, angle); !nodes.empty()) return nodes;
    return {};
}

/// Returns for each node whether it lies outside of the sheet, not in a hole.
std::vector<bool> outside(const Patch& patch)
{
    const PlateGrid& grid     = patch.plate.grid;
    const auto       isAtSide = [&](std::size_t node) {
        const int i = int(node) / grid.nodesZ(), j = int(node) % grid.nodesZ();
        return i == 0 || j == 0 || i == grid.cellsX || j == grid.cellsZ;
    };
    std::vector<bool> is(grid.nodes());
    for (const Nodes& piece : connected(grid, [&](std::size_t n) { return !isOnSheet(patch, n); }))
        if (std::ranges::any_of(piece, isAtSide))
            for (const std::size_t n : piece) is[n] = true;
    return is;
}

} // namespace

HeldInPlane heldInPlane(const Patch& patch)
{
    constexpr double kNear = 0.125; // of the root of the sheet's area [1]
    HeldInPlane      held{patch.held};
    if (patch.held.values().empty() || patch.covered.values().empty()) return held;
    held.share                  = heldUpToBorder(patch);
    const PlateGrid&   grid     = patch.plate.grid;
    const auto         counts   = [&](std::size_t n) { return held.share.values()[n] >= 0.5; };
    std::vector<Nodes> supports = connected(grid, counts);
    std::erase_if(supports, [&](const Nodes& support) { // ground that hangs together with no support
        return std::ranges::none_of(support, [&](std::size_t n) { return isOnSheet(patch, n); });
    });
    if (supports.size() < 2) return held;
    const std::vector<bool> isOutside = outside(patch);
    double                  area      = 0; // [m^2]
    for (std::size_t n = 0; n < grid.nodes(); ++n) area += isOnSheet(patch, n);
    area *= grid.spacingX * grid.spacingZ;
    std::size_t reaching = 0;
    for (const Nodes& support : supports) {
        const bool  isOut = std::ranges::any_of(support, [&](std::size_t n) { return isOutside[n]; });
        const Nodes tie   = isOut ? Nodes{} : tieOf(patch, support, kNear * std::sqrt(area));
        for (const std::size_t node : tie) held.share.values()[node] = 1;
        const bool tied = !tie.empty();
        held.tied += tied;
        reaching += isOut || tied;
    }
    held.without = int(supports.size() - std::max<std::size_t>(reaching, 1));
    return held;
}

} // namespace palp
