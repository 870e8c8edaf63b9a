#include "engine/plate/reference/reference_shell_solver.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/SparseCholesky>

#include "engine/plate/reference/plate_energy.h"

namespace palp {
namespace {

/// Most nodes: the factor of two fields has about four times the entries of a plate's.
constexpr std::size_t kMostNodes = 513 * 513;

constexpr int kHeld = -1; ///< number of a node that is not an unknown

using Matrix   = Eigen::SparseMatrix<double>;
using Factors  = Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Numbers the unknowns of one field from `first` on. With `pinned` three corners are held as well: a phi that no side
/// holds is known but for a linear function, which carries no force.
std::vector<int> numbered(const Plate& plate, int first, bool pinned)
{
    const int        cellsX = plate.grid.cellsX, cellsZ = plate.grid.cellsZ;
    std::vector<int> numberOf;
    for (int i = 0; i <= cellsX; ++i)
        for (int j = 0; j <= cellsZ; ++j) {
            const bool isPin = pinned && (i == 0 || i == cellsX) && (j == 0 || j == cellsZ) && !(i > 0 && j > 0);
            numberOf.push_back(isHeld(plate, i, j) || isPin ? kHeld : first++);
        }
    return numberOf;
}

double geometricMean(const NodeField& field)
{
    double sum = 0;
    for (const double value : field.values()) sum += std::log(value);
    return std::exp(sum / double(field.values().size()));
}

/// Adds the second derivative of a field's own energy, times `scale`.
void addEnergy(Triplets& entries, const Plate& plate, const std::vector<int>& numberOf, double scale)
{
    const auto product = [&](const Difference& a, const Difference& b, double k) {
        for (std::size_t m = 0; m < std::size_t(a.count); ++m)
            for (std::size_t n = 0; n < std::size_t(b.count); ++n) {
                const int row = numberOf[std::size_t(a.node[m])], column = numberOf[std::size_t(b.node[n])];
                if (row != kHeld && column != kHeld)
                    entries.emplace_back(row, column, scale * k * a.factor[m] * b.factor[n]);
            }
    };
    visitTerms(plate, [&](const EnergyTerm& term) {
        product(term.p, term.p, term.kpp);
        product(term.q, term.q, term.kqq);
        product(term.p, term.q, term.kpq);
        product(term.q, term.p, term.kpq);
    });
}

/// Adds the second derivative of - int w (kx phi_zz + kz phi_xx - 2 kxz phi_xz), times `scale`.
void addCoupling(Triplets& entries, const Shell& shell, const Plate& membrane, const std::vector<int>& ofW,
                 const std::vector<int>& ofPhi, double scale)
{
    const PlateGrid& g  = membrane.grid;
    const double     hx = g.spacingX, hz = g.spacingZ;
    const auto       couple = [&](int node, const Difference& d, double k) {
        const int row = ofW[std::size_t(node)];
        for (std::size_t m = 0; m < std::size_t(d.count); ++m) {
            const int column = ofPhi[std::size_t(d.node[m])];
            if (row == kHeld || column == kHeld) continue;
            entries.emplace_back(row, column, scale * k * d.factor[m]);
            entries.emplace_back(column, row, scale * k * d.factor[m]);
        }
    };
    const NodeField& kxz = shell.curvatureXZ;
    for (int i = 0; i < g.nodesX(); ++i)
        for (int j = 0; j < g.nodesZ(); ++j) {
            const int        node = i * g.nodesZ() + j, beside = node + g.nodesZ();
            const EnergyTerm bending = bendingTerm(membrane, i, j); // p: undivided phi_xx, q: phi_zz
            couple(node, bending.p, -shell.curvatureZ(i, j) * nodeArea(g, i, j) / (hx * hx));
            couple(node, bending.q, -shell.curvatureX(i, j) * nodeArea(g, i, j) / (hz * hz));
            if (i == g.cellsX || j == g.cellsZ) continue;
            const double     mean  = 0.25 * (kxz(i, j) + kxz(i + 1, j) + kxz(i, j + 1) + kxz(i + 1, j + 1));
            const EnergyTerm twist = twistingTerm(membrane, i, j); // p: undivided phi_xz; the cell's area cancels
            for (const int corner : {node, beside, node + 1, beside + 1}) couple(corner, twist.p, 2 * mean * 0.25);
        }
}

} // namespace

struct ReferenceShellSolver::Impl {
    PlateGrid        grid;
    std::vector<int> ofW, ofPhi;
    double           phiUnit = 1; ///< phi over the unknown [N]: makes both fields metres and both operators alike
    Matrix           matrix;
    Factors          factors;

    explicit Impl(const Shell& shell) : grid(shell.bending.grid)
    {
        const Plate membrane = membraneOf(shell);
        ofW                  = numbered(shell.bending, 0, false);
        const int unknownsW  = 1 + *std::ranges::max_element(ofW);
        ofPhi                = numbered(membrane, unknownsW, isStressFree(shell));
        const int unknowns   = 1 + *std::ranges::max_element(ofPhi);
        phiUnit = std::sqrt(geometricMean(shell.bending.rigidity) / geometricMean(shell.membraneCompliance));

        Triplets entries;
        addEnergy(entries, shell.bending, ofW, 1);
        addEnergy(entries, membrane, ofPhi, -phiUnit * phiUnit);
        addCoupling(entries, shell, membrane, ofW, ofPhi, phiUnit);
        matrix.resize(unknowns, unknowns);
        matrix.setFromTriplets(entries.begin(), entries.end());
        // The blocks on the diagonal are positive and negative definite: every order of elimination has its factors.
        factors.compute(matrix);
        if (factors.info() != Eigen::Success)
            throw Error("the shell's matrix cannot be factorised in double precision: rigidity, compliance or "
                        "curvature span too many orders of magnitude for this grid; use fewer cells or a smaller "
                        "contrast");
    }

    [[nodiscard]] NodeField spread(const Eigen::VectorXd& x, const std::vector<int>& numberOf, double unit) const
    {
        NodeField field(grid);
        for (std::size_t n = 0; n < numberOf.size(); ++n)
            if (numberOf[n] != kHeld) field.values()[n] = unit * x[numberOf[n]];
        return field;
    }
};

ReferenceShellSolver::ReferenceShellSolver(const Shell& shell)
{
    if (const auto why = whyUnsolvable(shell)) throw Error("the shell cannot be solved: " + *why);
    if (shell.bending.grid.nodes() > kMostNodes)
        throw Error("the reference solver takes shells of at most " + std::to_string(kMostNodes) + " nodes, found " +
                    std::to_string(shell.bending.grid.nodes()) + "; use fewer cells");
    impl_ = std::make_unique<Impl>(shell);
}

ReferenceShellSolver::~ReferenceShellSolver()                                          = default;
ReferenceShellSolver::ReferenceShellSolver(ReferenceShellSolver&&) noexcept            = default;
ReferenceShellSolver& ReferenceShellSolver::operator=(ReferenceShellSolver&&) noexcept = default;

ShellSolution ReferenceShellSolver::solve(const NodeField& nodalForce) const
{
    PALP_EXPECT(nodalForce.on(impl_->grid), "forces on another grid");
    Eigen::VectorXd right = Eigen::VectorXd::Zero(impl_->matrix.rows());
    for (std::size_t n = 0; n < impl_->ofW.size(); ++n)
        if (impl_->ofW[n] != kHeld) right[impl_->ofW[n]] = nodalForce.values()[n];

    Eigen::VectorXd       x          = impl_->factors.solve(right);
    const Eigen::VectorXd remainder  = right - impl_->matrix * x;
    const Eigen::VectorXd correction = impl_->factors.solve(remainder);
    x += correction;
    if (!x.allFinite())
        throw Error("the shell's deflection is not finite: loads, rigidities or curvatures are too large or too small "
                    "for double precision; check their units");
    const double size = x.lpNorm<Eigen::Infinity>();
    return {impl_->spread(x, impl_->ofW, 1), impl_->spread(x, impl_->ofPhi, impl_->phiUnit),
            size > 0 ? correction.lpNorm<Eigen::Infinity>() / size : 0};
}

} // namespace palp
