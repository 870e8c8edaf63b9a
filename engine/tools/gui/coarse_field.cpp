#include "engine/tools/gui/coarse_field.h"

#include <algorithm>

namespace palp {
namespace {

constexpr int kMostCells = 48; ///< on a side of the small picture, which is 130 px wide
constexpr int kMostNodes = 4;  ///< on a side of a mean

/// The nodes along a side that one value is the mean of.
struct Nodes {
    int first = 0, last = 0, step = 1;
};

Nodes nodesOf(int n, int coarse, int cells)
{
    const auto place = [&](double at) { return std::clamp(int(at * cells / coarse + 0.5), 0, cells); };
    if (coarse == cells) return {n, n, 1};
    Nodes nodes{place(n - 0.5), place(n + 0.5), 1};
    nodes.step = std::max(1, (nodes.last - nodes.first) / (kMostNodes - 1));
    return nodes;
}

} // namespace

CoarseField coarseField(const NodeField& field, double factor)
{
    const int   cellsX = field.nodesX() - 1, cellsZ = field.nodesZ() - 1;
    const int   coarseX = std::min(kMostCells, cellsX), coarseZ = std::min(kMostCells, cellsZ);
    CoarseField coarse{coarseX + 1, coarseZ + 1, {}};
    coarse.values.reserve(std::size_t(coarse.nodesX) * std::size_t(coarse.nodesZ));
    for (int i = 0; i <= coarseX; ++i) {
        const Nodes x = nodesOf(i, coarseX, cellsX);
        for (int j = 0; j <= coarseZ; ++j) {
            const Nodes z   = nodesOf(j, coarseZ, cellsZ);
            double      sum = 0, count = 0;
            for (int a = x.first; a <= x.last; a += x.step)
                for (int b = z.first; b <= z.last; b += z.step, ++count) sum += field(a, b);
            coarse.values.push_back(factor * sum / count);
        }
    }
    return coarse;
}

} // namespace palp
