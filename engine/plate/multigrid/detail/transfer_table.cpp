#include "engine/plate/multigrid/detail/transfer_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "compute_shaders/shared/transfer_layout.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

/// Weights of the coarse nodes first, first + 1, ...
struct Row {
    int                                      first = 0;
    std::array<double, shared::kFineWeights> weights{};
};

/// Returns the four Lagrange weights at a place `t` in [0, 1) between the second and the third of four equidistant
/// nodes.
std::array<double, 4> cubicWeights(double t)
{
    return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
            (t + 1) * t * (t - 1) / 6};
}

/// Adds a weight of the node beyond a side to the weights of the nodes on the side, next to it and one further.
///
/// Beyond a clamped side the plate would continue as x^2 (a + b x): 3 w1 - w2/2. (As its mirror image, which is what
/// the operator takes, b |x|^3 has a kink; the correction then comes out up to 1.7 times too large along the side, and
/// a solve takes a quarter more steps.) Beyond a supported one it is odd; beyond a free one, straight.
void addGhost(Edge edge, double weight, double& onSide, double& next, double& further)
{
    switch (edge) {
    case Edge::clamped:
        next += 3 * weight;
        further -= weight / 2;
        break;
    case Edge::supported:
        next -= weight;
        break;
    case Edge::free:
        onSide += 2 * weight;
        next -= weight;
        break;
    case Edge::guided:
        next += weight;
        break;
    }
}

Row rowOf(int fine, int fineCells, int coarseCells, Edge first, Edge last)
{
    const bool held = (fine == 0 && holdsNodes(first)) || (fine == fineCells && holdsNodes(last));
    // Whole numbers, so that a fine node on a coarse one is found exactly.
    const int  before = std::min(fine * coarseCells / fineCells, coarseCells - 1);
    const auto cubic  = cubicWeights(double(fine * coarseCells - before * fineCells) / fineCells);

    Row row;
    row.first = std::clamp(before - 1, 0, coarseCells + 1 - shared::kFineWeights);
    if (held) return row;
    const auto weight = [&](int node) -> double& { return row.weights.at(std::size_t(node - row.first)); };
    for (int m = 0; m < 4; ++m) {
        const int    node = before - 1 + m;
        const double w    = cubic[std::size_t(m)];
        if (w == 0) continue;
        if (node < 0)
            addGhost(first, w, weight(0), weight(1), weight(2));
        else if (node > coarseCells)
            addGhost(last, w, weight(coarseCells), weight(coarseCells - 1), weight(coarseCells - 2));
        else
            weight(node) += w;
    }
    if (row.first == 0 && holdsNodes(first)) weight(0) = 0;
    if (row.first + 3 == coarseCells && holdsNodes(last)) weight(coarseCells) = 0;
    return row;
}

} // namespace

std::vector<float> transferTable(int fineCells, int coarseCells, Edge first, Edge last)
{
    PALP_EXPECT(coarseCells >= 3 && coarseCells <= fineCells && 2 * coarseCells >= fineCells,
                std::to_string(fineCells) + " and " + std::to_string(coarseCells) + " cells");
    std::vector<float> table;
    std::vector<Row>   rows;
    for (int i = 0; i <= fineCells; ++i) {
        rows.push_back(rowOf(i, fineCells, coarseCells, first, last));
        table.push_back(float(rows.back().first));
        for (double w : rows.back().weights) table.push_back(float(w));
    }
    for (int I = 0; I <= coarseCells; ++I) { // the transpose
        const auto weightIn = [&](const Row& row) {
            const int m = I - row.first;
            return m >= 0 && m < shared::kFineWeights ? row.weights[std::size_t(m)] : 0.0;
        };
        const auto user  = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return weightIn(r) != 0; });
        const int  begin = user == rows.end() ? 0 : int(user - rows.begin());
        table.push_back(float(begin));
        for (int i = begin; i < begin + shared::kCoarseWeights; ++i)
            table.push_back(i <= fineCells ? float(weightIn(rows[std::size_t(i)])) : 0.0F);
    }
    return table;
}

} // namespace palp
