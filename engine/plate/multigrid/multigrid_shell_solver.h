#pragma once
#include <memory>
#include <span>
#include <vector>

#include "engine/core/grid.h"
#include "engine/plate/footprint.h"
#include "engine/plate/plate.h"
#include "engine/plate/shell.h"
#include "engine/plate/thrust.h"

namespace palp {

namespace compute {
class Context;
}

/// The solution of the coarsest level of shells on a processor. The answers are the same, but for rounding.
enum class CoarsestShell {
    automatic, ///< by the inverse on hardware, by factors in software
    byFactors, ///< one unknown after the other, with the host's bits
    byInverse  ///< made once per shell: all unknowns at once, with nothing to wait for
};

/// The kernels of shells for one processor of Vulkan, compiled once.
/// \thread one at a time, together with its context
class ShellKernels {
public:
    /// Returns whether the processor can have them: it is one of Vulkan, has doubles, and its workgroups are large
    /// enough.
    [[nodiscard]] static bool suit(const compute::Context& context) noexcept;

    /// \pre suit(context)
    /// \throws Error if they do not compile
    explicit ShellKernels(compute::Context& context, CoarsestShell coarsest = CoarsestShell::automatic);
    ~ShellKernels();
    ShellKernels(ShellKernels&&) noexcept;
    ShellKernels& operator=(ShellKernels&&) noexcept;

    /// Returns the kernels, for the files of the plate.
    struct All;
    [[nodiscard]] const All& all() const noexcept { return *all_; }

private:
    std::unique_ptr<All> all_;
};

/// What a load does to a shell.
struct ShellAnswer {
    NodeField   deflection{};     ///< w [m]
    NodeField   stressFunction{}; ///< phi [N m]; empty if it is not wanted
    double      work = 0;         ///< of the load along w [N m], to the second order in the error
    SolveReport report{}; ///< its estimate is that of the error's energy, the root of the work that is missing [1]
};

/// Solves thin shallow shells by multigrid: conjugate gradients on both fields together, preconditioned by one
/// symmetric V cycle whose relaxation changes both fields of a node at once.
///
/// The cycle is in floats on assembled rows, conjugate gradients and their operator are in doubles. The host takes
/// loads by eights, whose fields are floats then, and so is the operator that gives the length of their last step; a
/// processor of Vulkan takes them all at once, each as the host solves one alone (to the bit on lavapipe, with
/// CoarsestShell::byFactors). Three or more loads together may stop after one step, so that their answers hang on each
/// other within the tolerance. The host assembles rows and factors for both.
///
/// The matrix is indefinite, so that conjugate gradients minimise nothing; the products of their formulas may be
/// negative, and steps are as many as the plate takes, or two more (7 at most to 1e-4 in the compliance, for discs of
/// 100), however many cells there are and however curved it is. They start from nested iteration. The bits are the same
/// on every instruction set. Beyond sharp contrasts of some thousands, such as of nodes that stand for nothing, they
/// may not converge, and the report says so.
/// \thread one at a time
/// \source Marguerre 1938; Brandt & Dinar 1979, collective relaxation; Hestenes & Stiefel 1952
class MultigridShellSolver {
public:
    /// \throws Error if whyUnsolvable(shell) says so
    explicit MultigridShellSolver(const Shell& shell);
    /// Solves on a processor of Vulkan, which has to live longer, as its kernels.
    /// \throws compute::ProcessorLost, also from solve() and setShell(); compute::ProcessorOutOfMemory from solve()
    MultigridShellSolver(const Shell& shell, compute::Context& context, const ShellKernels& kernels);
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
                                                 int mostSteps = kMostSteps);

    /// Does the same for loads on both fields.
    [[nodiscard]] std::vector<ShellAnswer> solve(std::span<const ShellLoad> loads, double tolerance,
                                                 int mostSteps = kMostSteps);

    /// Does the same for loads on few nodes, without their stress functions.
    [[nodiscard]] std::vector<ShellAnswer> solve(std::span<const Footprint> loads, double tolerance,
                                                 int mostSteps = kMostSteps);

private:
    static constexpr int kMostSteps = 200;

    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
