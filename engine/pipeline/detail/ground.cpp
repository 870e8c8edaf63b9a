#include "engine/pipeline/detail/ground.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/core/resampling.h"
#include "engine/pipeline/detail/node_distances.h"
#include "engine/pipeline/detail/node_pieces.h"
#include "engine/pipeline/detail/whole_object.h"

namespace palp {
namespace {

double cellOf(const PlateGrid& grid)
{
    return std::max(grid.spacingX, grid.spacingZ);
}

/// Returns whether a node and those around it are held: it lies within what is held, not along its edge.
bool isWithinHeld(const Patch& patch, std::size_t node)
{
    bool is = true;
    eachAround(patch.plate.grid, node, [&](std::size_t other) { is = is && isHeld(patch, other); });
    return is;
}

/// Returns the nodes that a straight way inwards from the border passes before it is within what is held; empty: that
/// is not right behind the border.
/// \param reach  [m]
Nodes rimBehindHeld(const Patch& patch, int i, int j, double reach)
{
    constexpr double kStep = 0.5, kEdge = 2; // cells; what of an edge lies between a free node and one within
    const PlateGrid& grid    = patch.plate.grid;
    const NodeField& inside  = patch.inside;
    const double     towardX = (inside(i + 1, j) - inside(i - 1, j)) / (2 * grid.spacingX);
    const double     towardZ = (inside(i, j + 1) - inside(i, j - 1)) / (2 * grid.spacingZ);
    const double     slope = std::hypot(towardX, towardZ), step = kStep * cellOf(grid);
    if (!(slope > 0)) return {};
    Nodes  rim;
    double end      = reach - std::max(inside(i, j), 0.0); // [m]
    bool   hasFound = false;
    for (double way = 0; way <= end; way += step) {
        const long a = std::lround(i + way * towardX / (slope * grid.spacingX));
        const long b = std::lround(j + way * towardZ / (slope * grid.spacingZ));
        if (a < 0 || b < 0 || a > grid.cellsX || b > grid.cellsZ) return {};
        const std::size_t node = std::size_t(a) * std::size_t(grid.nodesZ()) + std::size_t(b);
        if (!isOnSheet(patch, node)) return {};
        if (isWithinHeld(patch, node)) return rim;
        if (!hasFound && isHeld(patch, node)) end = way + kEdge * cellOf(grid);
        hasFound = hasFound || isHeld(patch, node);
        rim.push_back(node);
    }
    return {};
}

/// Returns the node of the sheet that is nearest to the contact.
std::size_t touchedNode(const Patch& patch)
{
    const GridNode at    = nodeAtContact(patch);
    std::size_t    best  = 0;
    double         least = std::numeric_limits<double>::infinity(); // cells
    for (std::size_t n = 0; n < patch.plate.grid.nodes(); ++n) {
        const int    nodesZ = patch.plate.grid.nodesZ();
        const double away   = std::hypot(int(n) / nodesZ - at.i, int(n) % nodesZ - at.j);
        if (!isOnSheet(patch, n) || away >= least) continue;
        least = away;
        best  = n;
    }
    return best;
}

/// Adds pieces of the sheet that what is held cuts off: remnants of rims, which are smaller than a disc across which a
/// rim may be; and overhangs, all within a few cells of what is held, unless they are what is touched. A support that
/// is narrower than some eight cells carried too little past an overhang, because the forces in the sheet end over a
/// few cells on either side of it: a saddle on strips of 2 mm, 5 mm behind its borders, was felt 4.5 times too soft.
void addCutOff(std::vector<bool>& isRim, const Patch& patch, double reach)
{
    constexpr double  kNear   = 8; // cells
    const PlateGrid&  grid    = patch.plate.grid;
    const double      few     = std::numbers::pi * reach * reach / (grid.spacingX * grid.spacingZ); // nodes
    const double      near    = std::pow(kNear * cellOf(grid), 2);                                  // [m^2]
    const std::size_t touched = touchedNode(patch);
    const auto        isHold  = [&](std::size_t n) { return isOnSheet(patch, n) && (isHeld(patch, n) || isRim[n]); };
    const NodeField   away    = squaredDistances(grid, isHold);
    const auto        isLeft  = [&](std::size_t n) { return isOnSheet(patch, n) && !isHold(n); };
    for (const Nodes& piece : connected(grid, isLeft)) {
        bool isBeside = false; // it is no stray
        for (const std::size_t node : piece)
            eachAround(grid, node, [&](std::size_t other) { isBeside = isBeside || isHold(other); });
        const bool isNear     = std::ranges::all_of(piece, [&](std::size_t n) { return away.values()[n] <= near; });
        const bool isOverhang = isNear && std::ranges::find(piece, touched) == piece.end();
        if (!isBeside || !(isOverhang || double(piece.size()) < few)) continue;
        for (const std::size_t node : piece) isRim[node] = true;
    }
}

/// Returns for each node whether it lies on a rim of the sheet behind what is held.
std::vector<bool> rimsBehindHeld(const Patch& patch)
{
    const PlateGrid&  grid  = patch.plate.grid;
    const double      reach = kResamplingNearby * std::max(patch.spacing, cellOf(grid)); // [m]
    std::vector<bool> isRim(grid.nodes());
    for (int i = 1; i < grid.cellsX; ++i)
        for (int j = 1; j < grid.cellsZ; ++j) {
            const std::size_t node = std::size_t(i) * std::size_t(grid.nodesZ()) + std::size_t(j);
            if (!isOnSheet(patch, node) || patch.held.values()[node] >= 1 || patch.inside(i, j) > reach) continue;
            for (const std::size_t of : rimBehindHeld(patch, i, j, reach)) isRim[of] = true;
        }
    addCutOff(isRim, patch, reach);
    return isRim;
}

} // namespace

NodeField heldUpToBorder(const Patch& patch)
{
    const PlateGrid&        grid   = patch.plate.grid;
    const std::vector<bool> isRim  = rimsBehindHeld(patch);
    const auto              counts = [&](std::size_t n) { return isHeld(patch, n) || isRim[n]; };
    const NodeField toHeld = squaredDistances(grid, [&](std::size_t n) { return isOnSheet(patch, n) && counts(n); });
    const NodeField toFree = squaredDistances(grid, [&](std::size_t n) { return isOnSheet(patch, n) && !counts(n); });
    const NodeField toRim  = squaredDistances(grid, [&](std::size_t n) { return isRim[n]; });
    NodeField       share  = patch.held;
    for (std::size_t n = 0; n < grid.nodes(); ++n) {
        if (isRim[n]) share.values()[n] = 1;
        if (isOnSheet(patch, n)) continue;
        const bool isGround = toHeld.values()[n] <= toFree.values()[n];
        if (patch.covered.values()[n] > 0 && toRim.values()[n] > toHeld.values()[n])
            share.values()[n] = isGround ? std::max(share.values()[n], 0.5) : share.values()[n];
        else
            share.values()[n] = isGround;
    }
    return share;
}

} // namespace palp
