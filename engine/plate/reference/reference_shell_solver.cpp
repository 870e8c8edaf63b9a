#include "engine/plate/reference/reference_shell_solver.h"

#include "engine/plate/reference/detail/shell_unknowns.h"

namespace palp {

struct ReferenceShellSolver::Impl {
    ShellUnknowns unknowns;
    ShellMatrix   matrix;
    ShellFactors  factors;

    explicit Impl(const Shell& shell) : unknowns(shell), matrix(unknowns.matrixOf(unknowns.entries))
    {
        unknowns.entries = {};
        // The blocks on the diagonal are positive and negative definite: every order of elimination has its factors.
        factors.compute(matrix);
        if (factors.info() != Eigen::Success)
            throw Error("the shell's matrix cannot be factorised in double precision: rigidity, compliance or "
                        "curvature span too many orders of magnitude for this grid; use fewer cells or a smaller "
                        "contrast");
    }
};

ReferenceShellSolver::ReferenceShellSolver(const Shell& shell) : impl_(std::make_unique<Impl>(shell)) {}

ReferenceShellSolver::~ReferenceShellSolver()                                          = default;
ReferenceShellSolver::ReferenceShellSolver(ReferenceShellSolver&&) noexcept            = default;
ReferenceShellSolver& ReferenceShellSolver::operator=(ReferenceShellSolver&&) noexcept = default;

ShellSolution ReferenceShellSolver::solve(const NodeField& nodalForce) const
{
    const Eigen::VectorXd right      = impl_->unknowns.rightSide(nodalForce);
    Eigen::VectorXd       x          = impl_->factors.solve(right);
    const Eigen::VectorXd remainder  = right - impl_->matrix * x;
    const Eigen::VectorXd correction = impl_->factors.solve(remainder);
    x += correction;
    if (!x.allFinite())
        throw Error("the shell's deflection is not finite: loads, rigidities or curvatures are too large or too small "
                    "for double precision; check their units");
    const double size = x.lpNorm<Eigen::Infinity>();
    return {impl_->unknowns.deflection(x), impl_->unknowns.stressFunction(x),
            size > 0 ? correction.lpNorm<Eigen::Infinity>() / size : 0};
}

} // namespace palp
