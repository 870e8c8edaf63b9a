#pragma once
#include <span>
#include <vector>

#include "engine/plate/reference/plate_energy.h"

namespace palp {

/// The energy's matrix [N/m] over the nodes that no edge holds: lower triangle, compressed columns, rows rising. Its
/// pattern is that of the grid and its edges; values follow the rigidity.
///
/// What sparse direct solvers are given. The multigrid solver has no use for it: it never assembles anything.
class PlateMatrix {
public:
    explicit PlateMatrix(const Plate& plate);

    /// The values of another plate on the same grid, edges and foundation (zero or not): one pass over the terms of the
    /// energy, each product added at a place that is known since construction. Allocates nothing.
    void assemble(const Plate& plate);

    [[nodiscard]] int                     unknowns() const noexcept { return int(columnStart_.size()) - 1; }
    [[nodiscard]] std::span<const int>    columnStart() const noexcept { return columnStart_; } ///< unknowns() + 1
    [[nodiscard]] std::span<const int>    row() const noexcept { return row_; }
    [[nodiscard]] std::span<const double> value() const noexcept { return {value_.data(), row_.size()}; } ///< [N/m]
    [[nodiscard]] std::span<const int>    nodeOf() const noexcept { return nodeOf_; } ///< by unknown

    /// The values at the unknowns of a field over all nodes, and back with zero at held nodes.
    void      gather(const NodeField& field, std::span<double> unknowns) const;
    NodeField spread(std::span<const double> unknowns) const;

private:
    int                 nodesX_, nodesZ_;
    std::vector<int>    nodeOf_, columnStart_, row_;
    std::vector<double> value_; ///< one more than row_: what held nodes and the upper triangle get is thrown there
    std::vector<int>    place_; ///< in value_, of each product in the order in which assemble() comes across them
};

} // namespace palp
