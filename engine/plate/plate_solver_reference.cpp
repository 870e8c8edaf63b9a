#include "engine/plate/plate_solver_reference.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/SparseCholesky>

#include "engine/core/progress.h"
#include "engine/plate/load.h"

// The energy as a sum of small quadratic terms, each
//
//     1/2 (kpp p^2 + 2 kpq p q + kqq q^2)        p, q undivided differences of w [m], k.. stiffnesses [N/m]
//
// The terms are listed once, by visitTerms; the matrix and the residual are two uses of that list. There is no stencil.
//
//   node (i, j), area A:   p = w(i-1) - 2 w(i) + w(i+1) along x,  q the same along z,
//                          kpp = D A / hx^4,  kqq = D A / hz^4,  kpq = nu D A / (hx^2 hz^2)
//   cell, mean rigidity Dc: p = w00 - w10 - w01 + w11,  kpp = 2 (1 - nu) Dc hx hz / (hx hz)^2
//   foundation:            p = w(i, j),  kpp = k A
//
// On a node of an edge the difference across that edge reaches outside the plate:
//
//   clamped            zero slope: the ghost mirrors the first inner node, p = 2 w(1) - 2 w(0)
//   supported or free  no bending moment, p + nu q hx^2/hz^2 = 0: p is condensed out, which leaves
//                      (1 - nu^2) kqq q^2 / 2. Along a supported edge w is zero, so that is nothing at all.
//
// A corner takes the rule of either side for its own direction, and is held if either side holds it:
//
//   free/free and free/supported    both differences condensed out: no bending energy
//   clamped/free                    (1 - nu^2) kpp p^2 / 2 with the mirrored p; w is zero at the corner
//   all others                      differences along held sides: nothing

namespace palp {
namespace {

/// A sum of a few nodal values times small whole numbers.
struct Difference {
    int                   count = 0;
    std::array<int, 4>    node{};   ///< index into a NodeField's values
    std::array<double, 4> factor{}; ///< [1]

    void add(int atNode, double withFactor)
    {
        node[std::size_t(count)]     = atNode;
        factor[std::size_t(count++)] = withFactor;
    }
};

struct Term {
    Difference p, q;
    double     kpp = 0, kpq = 0, kqq = 0; ///< [N/m]
};

/// The second difference along one axis at node `index`, which has number `node` and whose neighbours along that axis
/// are `stride` apart; empty where the edge leaves no moment.
Difference secondDifference(int index, int cells, Edge first, Edge last, int node, int stride)
{
    Difference d;
    if (index > 0 && index < cells) {
        d.add(node - stride, 1);
        d.add(node, -2);
        d.add(node + stride, 1);
    } else if ((index == 0 ? first : last) == Edge::clamped) {
        d.add(node, -2);
        d.add(index == 0 ? node + stride : node - stride, 2);
    }
    return d;
}

Term bendingTerm(const Plate& plate, int i, int j)
{
    const PlateGrid& g     = plate.grid;
    const int        node  = i * g.nodesZ() + j;
    const double     hxhx  = g.spacingX * g.spacingX;
    const double     hzhz  = g.spacingZ * g.spacingZ;
    const double     nu    = plate.poissonRatio;
    const double     scale = plate.rigidity(i, j) * nodeArea(g, i, j);

    Term term;
    term.p   = secondDifference(i, g.cellsX, plate.edges.x0, plate.edges.x1, node, g.nodesZ());
    term.q   = secondDifference(j, g.cellsZ, plate.edges.z0, plate.edges.z1, node, 1);
    term.kpp = scale / (hxhx * hxhx);
    term.kqq = scale / (hzhz * hzhz);
    term.kpq = nu * scale / (hxhx * hzhz);
    if (term.p.count == 0 || term.q.count == 0) {
        term.kpp *= 1 - nu * nu;
        term.kqq *= 1 - nu * nu;
    }
    return term;
}

Term twistingTerm(const Plate& plate, int i, int j)
{
    const NodeField& D      = plate.rigidity;
    const int        node   = i * plate.grid.nodesZ() + j;
    const int        beside = node + plate.grid.nodesZ();
    const double     mean   = 0.25 * (D(i, j) + D(i + 1, j) + D(i, j + 1) + D(i + 1, j + 1));

    Term term;
    term.p.add(node, 1);
    term.p.add(beside, -1);
    term.p.add(node + 1, -1);
    term.p.add(beside + 1, 1);
    term.kpp = 2 * (1 - plate.poissonRatio) * mean / (plate.grid.spacingX * plate.grid.spacingZ);
    return term;
}

Term foundationTerm(const Plate& plate, int i, int j)
{
    Term term;
    term.p.add(i * plate.grid.nodesZ() + j, 1);
    term.kpp = plate.foundation * nodeArea(plate.grid, i, j);
    return term;
}

/// Calls visit(term) for every term of the energy.
template <class Visit>
void visitTerms(const Plate& plate, Visit&& visit)
{
    for (int i = 0; i < plate.grid.nodesX(); ++i)
        for (int j = 0; j < plate.grid.nodesZ(); ++j) {
            visit(bendingTerm(plate, i, j));
            if (i < plate.grid.cellsX && j < plate.grid.cellsZ) visit(twistingTerm(plate, i, j));
            if (plate.foundation > 0) visit(foundationTerm(plate, i, j));
        }
}

bool isHeld(const Plate& plate, int i, int j)
{
    const PlateEdges& e = plate.edges;
    return (i == 0 && e.x0 != Edge::free) || (i == plate.grid.cellsX && e.x1 != Edge::free) ||
           (j == 0 && e.z0 != Edge::free) || (j == plate.grid.cellsZ && e.z1 != Edge::free);
}

constexpr int kHeld = -1; ///< number of a node that is not an unknown

/// Beyond this a factor takes minutes and gigabytes: measured 1025 x 1025 nodes, 127 s and 2.4 GB.
constexpr std::size_t kMostNodes = 1025 * 1025; // [1]

using Matrix  = Eigen::SparseMatrix<double>;
using Factors = Eigen::SimplicialLLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>>;
using Clock   = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Adds k a b' + k b a' (or k a a' if both are the same), lower triangle only.
void addProduct(Matrix& matrix, const std::vector<int>& numberOf, const Difference& a, const Difference& b, double k)
{
    for (int m = 0; m < a.count; ++m)
        for (int n = 0; n < b.count; ++n) {
            const int row    = numberOf[std::size_t(a.node[std::size_t(m)])];
            const int column = numberOf[std::size_t(b.node[std::size_t(n)])];
            if (row == kHeld || column == kHeld) continue;
            if (row >= column) matrix.coeffRef(row, column) += k * a.factor[std::size_t(m)] * b.factor[std::size_t(n)];
        }
}

double valueOf(const Difference& d, const NodeField& w)
{
    double sum = 0;
    for (std::size_t m = 0; m < std::size_t(d.count); ++m) sum += d.factor[m] * w.values()[std::size_t(d.node[m])];
    return sum;
}

void subtract(NodeField& forces, const Difference& d, double force)
{
    for (std::size_t m = 0; m < std::size_t(d.count); ++m)
        forces.values()[std::size_t(d.node[m])] -= d.factor[m] * force;
}

double largest(const NodeField& field)
{
    double most = 0;
    for (const double value : field.values()) most = std::max(most, std::abs(value));
    return most;
}

} // namespace

struct ReferencePlateSolver::Impl {
    Plate            plate;
    std::vector<int> numberOf; ///< node -> unknown or kHeld
    int              unknowns = 0;
    Factors          factors;
    double           milliseconds = 0; ///< wall time of the constructor

    explicit Impl(const Plate& given) : plate(given)
    {
        numberUnknowns();
        factors.compute(assembled());
        if (factors.info() != Eigen::Success)
            throw Error("the plate's matrix cannot be factorised in double precision: rigidity or foundation span too "
                        "many orders of magnitude for this grid; use fewer cells or a smaller contrast");
    }

    /// In the order of the nodes; the factorisation finds its own order (minimum degree, which measured as fast as
    /// geometric nested dissection at 257 x 257 nodes and a third faster at 513 x 513).
    void numberUnknowns()
    {
        numberOf.assign(plate.grid.nodes(), kHeld);
        for (int i = 0; i < plate.grid.nodesX(); ++i)
            for (int j = 0; j < plate.grid.nodesZ(); ++j)
                if (!isHeld(plate, i, j)) numberOf[std::size_t(i * plate.grid.nodesZ() + j)] = unknowns++;
    }

    [[nodiscard]] Matrix assembled() const
    {
        constexpr int kLongestColumn = 13; // nodes that share a term with one node, itself among them
        Matrix        matrix(unknowns, unknowns);
        matrix.reserve(Eigen::VectorXi::Constant(unknowns, kLongestColumn));
        visitTerms(plate, [&](const Term& term) {
            addProduct(matrix, numberOf, term.p, term.p, term.kpp);
            addProduct(matrix, numberOf, term.q, term.q, term.kqq);
            addProduct(matrix, numberOf, term.p, term.q, term.kpq);
            addProduct(matrix, numberOf, term.q, term.p, term.kpq);
        });
        matrix.makeCompressed();
        return matrix;
    }

    [[nodiscard]] NodeField backSubstituted(const NodeField& forces) const
    {
        Eigen::VectorXd right(unknowns);
        for (std::size_t node = 0; node < numberOf.size(); ++node)
            if (numberOf[node] != kHeld) right[numberOf[node]] = forces.values()[node];
        const Eigen::VectorXd answer = factors.solve(right);
        NodeField             w(plate.grid);
        for (std::size_t node = 0; node < numberOf.size(); ++node)
            if (numberOf[node] != kHeld) w.values()[node] = answer[numberOf[node]];
        return w;
    }

    /// Forces [N] minus the energy's gradient, in moment form: differences first, products with the rigidity second.
    /// The matrix would lose the small differences of w to the rounding of its own entries.
    [[nodiscard]] NodeField residual(const NodeField& forces, const NodeField& w) const
    {
        NodeField rest = forces;
        visitTerms(plate, [&](const Term& term) {
            const double p = valueOf(term.p, w), q = valueOf(term.q, w);
            subtract(rest, term.p, term.kpp * p + term.kpq * q);
            subtract(rest, term.q, term.kpq * p + term.kqq * q);
        });
        return rest;
    }
};

ReferencePlateSolver::ReferencePlateSolver(const Plate& plate)
{
    const auto start = Clock::now();
    if (const auto why = whyUnsolvable(plate)) throw Error("the plate cannot be solved: " + *why);
    if (plate.grid.nodes() > kMostNodes)
        throw Error("the reference solver takes at most " + std::to_string(kMostNodes) + " nodes, found " +
                    std::to_string(plate.grid.nodesX()) + " x " + std::to_string(plate.grid.nodesZ()) +
                    "; use fewer cells");
    Progress  progress("factorising");
    const int seconds = int(0.9 * std::pow(double(plate.grid.nodes()) / (257 * 257), 1.75)); // measured on one core
    if (seconds >= 2)
        progress.lasts(std::to_string(plate.grid.nodes()) + " nodes, about " + std::to_string(seconds) + " s");
    impl_               = std::make_unique<Impl>(plate);
    impl_->milliseconds = millisecondsSince(start);
}

ReferencePlateSolver::~ReferencePlateSolver()                                          = default;
ReferencePlateSolver::ReferencePlateSolver(ReferencePlateSolver&&) noexcept            = default;
ReferencePlateSolver& ReferencePlateSolver::operator=(ReferencePlateSolver&&) noexcept = default;

PlateSolution ReferencePlateSolver::solve(const NodeField& nodalForce) const
{
    const auto start = Clock::now();
    PALP_EXPECT(nodalForce.on(impl_->plate.grid), "forces of " + std::to_string(nodalForce.nodesX()) + " x " +
                                                      std::to_string(nodalForce.nodesZ()) + " nodes");

    PlateSolution   solution{impl_->backSubstituted(nodalForce), {}};
    const NodeField correction = impl_->backSubstituted(impl_->residual(nodalForce, solution.deflection));
    for (std::size_t node = 0; node < correction.values().size(); ++node)
        solution.deflection.values()[node] += correction.values()[node];

    if (!std::ranges::all_of(solution.deflection.values(), [](double w) { return std::isfinite(w); }))
        throw Error(
            "the deflection is not finite: loads or rigidities are too large or too small for double precision; "
            "check their units");
    const double size             = largest(solution.deflection);
    solution.report.device        = "reference";
    solution.report.errorEstimate = size > 0 ? largest(correction) / size : 0;
    solution.report.converged     = *solution.report.errorEstimate < 1e-2; // that step leaves about the square of it
    solution.report.milliseconds  = millisecondsSince(start);
    return solution;
}

double ReferencePlateSolver::factoriseMilliseconds() const noexcept
{
    return impl_->milliseconds;
}

} // namespace palp
