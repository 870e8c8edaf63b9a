#pragma once
#include <memory>

#include "engine/plate/plate.h"

namespace palp {

/// The oracle: the discrete energy assembled in double precision and factorised by sparse Cholesky. It is simple rather
/// than fast, and shares no stencil with any other solver.
/// \thread one at a time
class ReferencePlateSolver {
public:
    /// Assembles and factorises: 0.1 s at 129 x 129 nodes, 0.9 s at 257 x 257, 8 s at 513 x 513 (measured on one core).
    /// \throws Error if whyUnsolvable(plate) says so, beyond 1025 x 1025 nodes, or if double precision does not suffice
    explicit ReferencePlateSolver(const Plate& plate);
    ~ReferencePlateSolver();
    ReferencePlateSolver(ReferencePlateSolver&&) noexcept;
    ReferencePlateSolver& operator=(ReferencePlateSolver&&) noexcept;

    /// Solves for the deflection under forces at the nodes [N] (a pressure q is q times the node's area: half a cell's
    /// on an edge, a quarter in a corner). Forces on held nodes have no effect.
    /// report.errorEstimate is max |correction of one step of iterative refinement| / max |w|, an estimate of the
    /// rounding error before that step; it does not include the discretisation.
    /// \throws Error if the deflection is not finite
    [[nodiscard]] PlateSolution solve(const NodeField& nodalForce) const;

    [[nodiscard]] double factoriseMilliseconds() const noexcept; ///< wall time of the constructor

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
