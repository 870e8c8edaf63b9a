#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "engine/plate/reference/plate_matrix.h"

namespace palp::bench {

/// The paper's iteration: w += omega (f - A w) / diagonal of A, all nodes at once, from w = 0.
///
/// It computes in doubles with precomputed coefficients, 13 per node and no index lists: one pass over memory that
/// vectorises. For a constant rigidity this is the fastest form that we know on these grids; recomputing moments is
/// slower.
/// \source Kumari & Chaudhuri 2016, section 2.5, where omega is 1
/// \differs undamped it diverges on this stencil; 0.6 converges
class DampedJacobi {
public:
    DampedJacobi(const Plate& plate, const NodeField& force, double omega = 0.6);

    void sweep(int times);

    [[nodiscard]] NodeField answer() const; ///< [m]

private:
    static constexpr int kMostNeighbours = 13;

    int                                         nodesX_, nodesZ_;
    std::size_t                                 margin_; ///< zeros at either end, so that no offset leaves the array
    std::array<std::ptrdiff_t, kMostNeighbours> offset_{};
    std::array<std::vector<double>, kMostNeighbours> factor_; ///< by node [1]
    std::vector<double>                              push_;   ///< omega f / diagonal [m]
    std::vector<double>                              w_, next_;
};

} // namespace palp::bench
