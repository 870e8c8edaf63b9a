#pragma once
#include <memory>

#include "engine/plate/shell.h"

namespace palp {

struct ShellSolution {
    NodeField deflection;     ///< w [m]
    NodeField stressFunction; ///< phi [N m]
    double    errorEstimate;  ///< [1] max |last correction| / max |w|: rounding, not the discretisation
};

/// The oracle of shells: both fields assembled in double precision and factorised together. It builds on the list of
/// energy terms in plate_energy.h and shares no stencil with any other solver.
/// \thread one at a time
class ReferenceShellSolver {
public:
    /// \throws Error if whyUnsolvable(shell) says so, beyond 513 x 513 nodes, or if double precision does not suffice
    explicit ReferenceShellSolver(const Shell& shell);
    ~ReferenceShellSolver();
    ReferenceShellSolver(ReferenceShellSolver&&) noexcept;
    ReferenceShellSolver& operator=(ReferenceShellSolver&&) noexcept;

    /// Solves for forces at the nodes [N]. Forces on held nodes have no effect.
    /// \throws Error if the answer is not finite
    [[nodiscard]] ShellSolution solve(const NodeField& nodalForce) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
