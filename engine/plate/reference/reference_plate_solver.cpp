#include "engine/plate/reference/reference_plate_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/SparseCholesky>

#include "engine/core/progress.h"
#include "engine/plate/reference/plate_matrix.h"

// plate_energy.h defines the energy term by term.

namespace palp {
namespace {

/// Most nodes. Beyond this a factor takes minutes and gigabytes: measured 1025 x 1025 nodes, 127 s and 2.4 GB.
constexpr std::size_t kMostNodes = 1025 * 1025;

using Matrix  = Eigen::SparseMatrix<double>;
using Factors = Eigen::SimplicialLLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>>;
using Clock   = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
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
    std::vector<int> nodeOf; ///< by unknown
    Factors          factors;
    double           milliseconds = 0; ///< wall time of the constructor

    /// The factorisation finds its own order (minimum degree, which measured as fast as geometric nested dissection at
    /// 257 x 257 nodes and a third faster at 513 x 513).
    explicit Impl(const Plate& given) : plate(given)
    {
        const PlateMatrix assembled(plate);
        nodeOf.assign(assembled.nodeOf().begin(), assembled.nodeOf().end());
        factors.compute(Eigen::Map<const Matrix>(assembled.unknowns(), assembled.unknowns(),
                                                 Eigen::Index(assembled.row().size()), assembled.columnStart().data(),
                                                 assembled.row().data(), assembled.value().data()));
        if (factors.info() != Eigen::Success)
            throw Error("the plate's matrix cannot be factorised in double precision: rigidity or foundation span too "
                        "many orders of magnitude for this grid; use fewer cells or a smaller contrast");
    }

    [[nodiscard]] NodeField backSubstituted(const NodeField& forces) const
    {
        Eigen::VectorXd right(Eigen::Index(nodeOf.size()));
        for (std::size_t n = 0; n < nodeOf.size(); ++n)
            right[Eigen::Index(n)] = forces.values()[std::size_t(nodeOf[n])];
        const Eigen::VectorXd answer = factors.solve(right);
        NodeField             w(plate.grid);
        for (std::size_t n = 0; n < nodeOf.size(); ++n) w.values()[std::size_t(nodeOf[n])] = answer[Eigen::Index(n)];
        return w;
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
    const NodeField correction = impl_->backSubstituted(energyResidual(impl_->plate, nodalForce, solution.deflection));
    for (std::size_t node = 0; node < correction.values().size(); ++node)
        solution.deflection.values()[node] += correction.values()[node];

    if (!std::ranges::all_of(solution.deflection.values(), [](double w) { return std::isfinite(w); }))
        throw Error(
            "the deflection is not finite: loads or rigidities are too large or too small for double precision; "
            "check their units");
    const double size             = largest(solution.deflection);
    solution.report.solver        = "reference";
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
