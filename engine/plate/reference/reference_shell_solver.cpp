#include "engine/plate/reference/reference_shell_solver.h"

#include <cmath>
#include <string>

#include <Eigen/SparseCholesky>

#include "engine/core/progress.h"
#include "engine/plate/reference/detail/shell_unknowns.h"

namespace palp {
namespace {

using Matrix  = Eigen::SparseMatrix<double>;
using Factors = Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>>;

} // namespace

struct ReferenceShellSolver::Impl {
    ShellUnknowns unknowns;
    Matrix        matrix;
    Factors       factors;

    explicit Impl(const Shell& shell) : unknowns(shell), matrix(unknowns.count, unknowns.count)
    {
        matrix.setFromTriplets(unknowns.entries.begin(), unknowns.entries.end());
        unknowns.entries = {};
        // The blocks on the diagonal are positive and negative definite: every order of elimination has its factors.
        factors.compute(matrix);
        if (factors.info() != Eigen::Success)
            throw Error("the shell's matrix cannot be factorised in double precision: rigidity, compliance or "
                        "curvature span too many orders of magnitude for this grid; use fewer cells or a smaller "
                        "contrast");
    }
};

ReferenceShellSolver::ReferenceShellSolver(const Shell& shell)
{
    const std::size_t nodes = shell.bending.grid.nodes();
    Progress          progress("factorising a shell");
    const int         seconds = int(10 * std::pow(double(nodes) / (257 * 257), 2)); // measured on one core
    if (seconds >= 2) progress.lasts(std::to_string(nodes) + " nodes, about " + std::to_string(seconds) + " s");
    impl_ = std::make_unique<Impl>(shell);
}

ReferenceShellSolver::~ReferenceShellSolver()                                          = default;
ReferenceShellSolver::ReferenceShellSolver(ReferenceShellSolver&&) noexcept            = default;
ReferenceShellSolver& ReferenceShellSolver::operator=(ReferenceShellSolver&&) noexcept = default;

ShellSolution ReferenceShellSolver::solve(const NodeField& nodalForce) const
{
    const std::vector<double> forces    = impl_->unknowns.rightSide(nodalForce);
    const Eigen::VectorXd     right     = Eigen::Map<const Eigen::VectorXd>(forces.data(), Eigen::Index(forces.size()));
    Eigen::VectorXd           x         = impl_->factors.solve(right);
    const Eigen::VectorXd     remainder = right - impl_->matrix * x;
    const Eigen::VectorXd     correction = impl_->factors.solve(remainder);
    x += correction;
    if (!x.allFinite())
        throw Error("the shell's deflection is not finite: loads, rigidities or curvatures are too large or too small "
                    "for double precision; check their units");
    const double                  size = x.lpNorm<Eigen::Infinity>();
    const std::span<const double> found(x.data(), std::size_t(x.size()));
    return {impl_->unknowns.deflection(found), impl_->unknowns.stressFunction(found),
            size > 0 ? correction.lpNorm<Eigen::Infinity>() / size : 0};
}

} // namespace palp
