#pragma once
#include <span>
#include <vector>

#include "engine/plate/reference/plate_energy.h"

namespace palp {

/// The energy's matrix [N/m] over the nodes that no edge holds: lower triangle, compressed columns, rows rising. Its
/// pattern is that of the grid and its edges; values follow the rigidity.
///
/// It is the input of sparse direct solvers. The multigrid solver does not use it, because it assembles no matrix.
class PlateMatrix {
public:
    explicit PlateMatrix(const Plate& plate);

    /// Computes the values of another plate on the same grid, edges and foundation (zero or not): one pass over the
    /// terms of the energy adds each product at a place known since construction. Allocates nothing.
    void assemble(const Plate& plate);

    [[nodiscard]] int                     unknowns() const noexcept { return int(columnStart_.size()) - 1; }
    [[nodiscard]] std::span<const int>    columnStart() const noexcept { return columnStart_; } ///< unknowns() + 1
    [[nodiscard]] std::span<const int>    row() const noexcept { return row_; }
    [[nodiscard]] std::span<const double> value() const noexcept { return {value_.data(), row_.size()}; } ///< [N/m]
    [[nodiscard]] std::span<const int>    nodeOf() const noexcept { return nodeOf_; } ///< by unknown

    /// Converts a field over all nodes to its values at the unknowns, and back with zero at held nodes.
    void      gather(const NodeField& field, std::span<double> unknowns) const;
    NodeField spread(std::span<const double> unknowns) const;

private:
    int                 nodesX_, nodesZ_;
    std::vector<int>    nodeOf_, columnStart_, row_;
    std::vector<double> value_; ///< one more than row_, for the discarded products of held nodes and the upper triangle
    std::vector<int>    place_; ///< in value_, of each product in the order of assemble()
};

} // namespace palp
