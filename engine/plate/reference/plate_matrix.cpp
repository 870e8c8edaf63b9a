#include "engine/plate/reference/plate_matrix.h"

#include <algorithm>

namespace palp {
namespace {

constexpr int kHeld = -1; ///< number of a node that is not an unknown

/// Calls visit(node a, node b, value) for every product of the energy's second derivative, both triangles.
template <class Visit>
void visitProducts(const Plate& plate, Visit&& visit)
{
    const auto product = [&](const Difference& a, const Difference& b, double k) {
        for (std::size_t m = 0; m < std::size_t(a.count); ++m)
            for (std::size_t n = 0; n < std::size_t(b.count); ++n)
                visit(a.node[m], b.node[n], k * a.factor[m] * b.factor[n]);
    };
    visitTerms(plate, [&](const EnergyTerm& term) {
        product(term.p, term.p, term.kpp);
        product(term.q, term.q, term.kqq);
        product(term.p, term.q, term.kpq);
        product(term.q, term.p, term.kpq);
    });
}

} // namespace

PlateMatrix::PlateMatrix(const Plate& plate) : nodesX_(plate.grid.nodesX()), nodesZ_(plate.grid.nodesZ())
{
    // Unknowns are in the order of the nodes: a factorisation finds its own order.
    std::vector<int> numberOf(plate.grid.nodes(), kHeld);
    for (int i = 0; i < nodesX_; ++i)
        for (int j = 0; j < nodesZ_; ++j) {
            if (isHeld(plate, i, j)) continue;
            numberOf[std::size_t(i * nodesZ_ + j)] = int(nodeOf_.size());
            nodeOf_.push_back(i * nodesZ_ + j);
        }

    // The pattern.
    std::vector<std::vector<int>> rowsOf(nodeOf_.size());
    visitProducts(plate, [&](int a, int b, double) {
        const int row = numberOf[std::size_t(a)], column = numberOf[std::size_t(b)];
        if (row == kHeld || column == kHeld || row < column) return;
        auto&      rows = rowsOf[std::size_t(column)];
        const auto at   = std::lower_bound(rows.begin(), rows.end(), row);
        if (at == rows.end() || *at != row) rows.insert(at, row);
    });
    columnStart_.push_back(0);
    for (const auto& rows : rowsOf) {
        row_.insert(row_.end(), rows.begin(), rows.end());
        columnStart_.push_back(int(row_.size()));
    }
    rowsOf = {};

    // The place of each product in the pattern, and the values.
    visitProducts(plate, [&](int a, int b, double) {
        const int row = numberOf[std::size_t(a)], column = numberOf[std::size_t(b)];
        int       place = int(row_.size());
        if (row != kHeld && column != kHeld && row >= column)
            place = int(std::lower_bound(row_.begin() + columnStart_[std::size_t(column)],
                                         row_.begin() + columnStart_[std::size_t(column) + 1], row) -
                        row_.begin());
        place_.push_back(place);
    });
    value_.resize(row_.size() + 1);
    assemble(plate);
}

void PlateMatrix::assemble(const Plate& plate)
{
    PALP_EXPECT(plate.grid.nodesX() == nodesX_ && plate.grid.nodesZ() == nodesZ_, "a plate on another grid");
    std::fill(value_.begin(), value_.end(), 0.0);
    const int* place = place_.data();
    visitProducts(plate, [&](int, int, double value) { value_[std::size_t(*place++)] += value; });
    PALP_EXPECT(place == place_.data() + place_.size(), "a plate with other edges or another foundation");
}

void PlateMatrix::gather(const NodeField& field, std::span<double> unknowns) const
{
    for (std::size_t n = 0; n < nodeOf_.size(); ++n) unknowns[n] = field.values()[std::size_t(nodeOf_[n])];
}

NodeField PlateMatrix::spread(std::span<const double> unknowns) const
{
    NodeField field(nodesX_, nodesZ_);
    for (std::size_t n = 0; n < nodeOf_.size(); ++n) field.values()[std::size_t(nodeOf_[n])] = unknowns[n];
    return field;
}

} // namespace palp
