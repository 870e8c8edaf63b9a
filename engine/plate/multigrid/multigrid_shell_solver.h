#pragma once
#include <memory>
#include <span>
#include <vector>

#include "engine/core/grid.h"
#include "engine/plate/plate.h"
#include "engine/plate/shell.h"

namespace palp {

/// What a load does to a shell.
struct ShellAnswer {
    NodeField   deflection{};     ///< w [m]
    NodeField   stressFunction{}; ///< phi [N m]
    double      work = 0;         ///< of the load along w [N m], to the second order in the error
    SolveReport report{}; ///< its estimate is that of the error's energy, the root of the work that is missing [1]
};

/// Solves thin shallow shells by multigrid on the host: conjugate gradients on both fields together, preconditioned by one
/// symmetric V cycle whose relaxation changes both fields of a node at once.
///
/// The cycle is in floats on assembled rows, conjugate gradients and their operator are in doubles; loads are taken by
/// eights, whose fields are floats then. The matrix is indefinite, so that conjugate gradients minimise nothing; the
/// products of their formulas may be negative, and steps are as many as the plate takes, or two more (7 at most to 1e-4
/// in the compliance, for discs of 100), however many cells there are and however curved it is. They start from nested
/// iteration. The bits are the same on every instruction set. Beyond sharp contrasts of some thousands, such as of nodes
/// that stand for nothing, they may not converge, and the report says so.
/// Vulkan has no kernels for it yet.
/// \thread one at a time
/// \source Marguerre 1938; Brandt & Dinar 1979, collective relaxation; Hestenes & Stiefel 1952
class MultigridShellSolver {
public:
    /// \throws Error if whyUnsolvable(shell) says so
    explicit MultigridShellSolver(const Shell& shell);
    ~MultigridShellSolver();
    MultigridShellSolver(MultigridShellSolver&&) noexcept;
    MultigridShellSolver& operator=(MultigridShellSolver&&) noexcept;

    /// Goes on with another shell; on the same grid no memory is made anew.
    /// \throws Error if whyUnsolvable(shell) says so: the shell before stays
    void setShell(const Shell& shell);

    /// Solves for forces at the nodes [N]. Forces on held nodes have no effect.
    /// \param tolerance  of the report's estimate, relative [1]; works are right to its square
    /// \param mostSteps  after which an answer is returned that has not converged
    [[nodiscard]] std::vector<ShellAnswer> solve(std::span<const NodeField> nodalForces, double tolerance,
                                                 int mostSteps = 60);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
