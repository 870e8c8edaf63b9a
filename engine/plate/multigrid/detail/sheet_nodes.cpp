#include "engine/plate/multigrid/detail/sheet_nodes.h"

#include <algorithm>
#include <cmath>

namespace palp {
namespace {

/// Returns nodes with those up to so many away along x and z.
Which widened(const PlateGrid& grid, const Which& from, int by)
{
    Which along(from.size()), wide(from.size());
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j) {
            if (!from[std::size_t(i * grid.nodesZ() + j)]) continue;
            for (int b = std::max(j - by, 0); b <= std::min(j + by, grid.cellsZ); ++b)
                along[std::size_t(i * grid.nodesZ() + b)] = 1;
        }
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j) {
            if (!along[std::size_t(i * grid.nodesZ() + j)]) continue;
            for (int a = std::max(i - by, 0); a <= std::min(i + by, grid.cellsX); ++a)
                wide[std::size_t(a * grid.nodesZ() + j)] = 1;
        }
    return wide;
}

} // namespace

Which withStress(const Shell& shell)
{
    constexpr double kFirm = 20; // bed over the membrane's own stiffness, of the 30 that the firmest has [1]
    const PlateGrid& grid  = shell.bending.grid;
    const double     area  = grid.spacingX * grid.spacingZ;
    Which            loose(grid.nodes());
    for (std::size_t n = 0; n < loose.size(); ++n)
        loose[n] = shell.stressBed.values()[n] * area * area < kFirm * shell.membraneCompliance.values()[n];
    return widened(grid, loose, 1);
}

Which onSheet(const NodeField& shares, double more)
{
    Which sheet(shares.values().size());
    for (std::size_t n = 0; n < sheet.size(); ++n) sheet[n] = shares.values()[n] > more;
    return sheet;
}

Which withDeflection(const PlateGrid& grid, const Which& sheet, const Which& stressed)
{
    Which some = stressed;
    for (std::size_t n = 0; n < some.size(); ++n) some[n] = some[n] || sheet[n];
    return widened(grid, some, 1);
}

void takeOffHeld(Which& which, const Plate& plate)
{
    for (int i = 0; i <= plate.grid.cellsX; ++i)
        for (int j = 0; j <= plate.grid.cellsZ; ++j)
            if (isHeld(plate, i, j)) which[std::size_t(i * plate.grid.nodesZ() + j)] = 0;
}

int mostPressed(const Footprint& footprint)
{
    const auto most =
        std::ranges::max_element(footprint.parts, {}, [](const Footprint::Part& part) { return std::abs(part.force); });
    return most == footprint.parts.end() ? kNone : int(most->node);
}

Which hangingTogether(const PlateGrid& grid, const Which& among, std::span<const Footprint> footprints)
{
    Which            is(among.size());
    std::vector<int> next;
    const auto       reach = [&](int node) {
        if (!among[std::size_t(node)] || is[std::size_t(node)]) return;
        is[std::size_t(node)] = 1;
        next.push_back(node);
    };
    for (const Footprint& footprint : footprints)
        if (const int node = mostPressed(footprint); node != kNone && std::size_t(node) < is.size()) reach(node);
    while (!next.empty()) {
        const int node = next.back(), i = node / grid.nodesZ(), j = node % grid.nodesZ();
        next.pop_back();
        if (i > 0) reach(node - grid.nodesZ());
        if (i < grid.cellsX) reach(node + grid.nodesZ());
        if (j > 0) reach(node - 1);
        if (j < grid.cellsZ) reach(node + 1);
    }
    return is;
}

void goOn(NodeField& field, const PlateGrid& grid, Which known)
{
    constexpr int    kRings     = 4; // beyond them a bed leaves nothing of the stress that they would load
    constexpr int    kSweeps    = 16;
    constexpr int    kAway[][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    const auto       node       = [&](int i, int j) { return i * grid.nodesZ() + j; };
    std::vector<int> ring;
    const auto       isKnown = [&](int i, int j) {
        return i >= 0 && j >= 0 && i <= grid.cellsX && j <= grid.cellsZ && known[std::size_t(node(i, j))];
    };
    const auto next = [&] { // nodes beside those that are known
        ring.clear();
        for (int i = 0; i <= grid.cellsX; ++i)
            for (int j = 0; j <= grid.cellsZ; ++j) {
                if (isKnown(i, j)) continue;
                for (const auto& [a, b] : kAway)
                    if (isKnown(i + a, j + b)) {
                        ring.push_back(node(i, j));
                        break;
                    }
            }
        return !ring.empty();
    };
    std::vector<int> far; // nodes beyond the rings
    for (int n = 0; next(); ++n) {
        if (n >= kRings) far.insert(far.end(), ring.begin(), ring.end());
        for (const int at : ring) {
            const int i = at / grid.nodesZ(), j = at % grid.nodesZ();
            double    mean = 0, along = 0, means = 0, alongs = 0;
            for (const auto& [a, b] : kAway) {
                if (!isKnown(i + a, j + b)) continue;
                const double beside = field(i + a, j + b);
                mean += beside;
                ++means;
                if (n >= kRings || !isKnown(i + 2 * a, j + 2 * b)) continue;
                along += 2 * beside - field(i + 2 * a, j + 2 * b);
                ++alongs;
            }
            field(i, j) = alongs > 0 ? along / alongs : mean / means;
        }
        for (const int at : ring) known[std::size_t(at)] = 1;
    }
    // Means are the same along lines, with steps from one to the next, which would stretch a sheet.
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (const int at : far) {
            const int i = at / grid.nodesZ(), j = at % grid.nodesZ();
            double    mean = 0, means = 0;
            for (const auto& [a, b] : kAway) {
                if (!isKnown(i + a, j + b)) continue;
                mean += field(i + a, j + b);
                ++means;
            }
            field(i, j) = mean / means;
        }
}

} // namespace palp
