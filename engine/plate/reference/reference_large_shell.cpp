#include "engine/plate/reference/reference_large_shell.h"

#include <cmath>

#include <Eigen/SparseCholesky>

#include "engine/core/quantity.h"
#include "engine/plate/reference/detail/shell_unknowns.h"
#include "engine/plate/shell_energy.h"

namespace palp {
namespace {

using Matrix  = Eigen::SparseMatrix<double>;
using Factors = Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>>;

Matrix matrixOf(const ShellEntries& entries, int count)
{
    Matrix matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

Eigen::VectorXd vectorOf(const std::vector<double>& values)
{
    return Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
}

/// Adds the second derivative of T at a state.
void addStretch(ShellEntries& entries, const ShellUnknowns& of, const Shell& shell, const Plate& membrane,
                const NodeField& w, const NodeField& phi)
{
    const auto couple = [&](const Difference& a, const std::vector<int>& ofA, const Difference& b,
                            const std::vector<int>& ofB, double k) {
        for (std::size_t m = 0; m < std::size_t(a.count); ++m)
            for (std::size_t n = 0; n < std::size_t(b.count); ++n) {
                const int row = ofA[std::size_t(a.node[m])], column = ofB[std::size_t(b.node[n])];
                if (row == kHeldUnknown || column == kHeldUnknown) continue;
                entries.push_back({{row, column}, k * a.factor[m] * b.factor[n]});
                entries.push_back({{column, row}, k * a.factor[m] * b.factor[n]});
            }
    };
    visitStretchTerms(shell, membrane, [&](const StretchTerm& term) {
        const double half = term.stiffness / 2;
        couple(term.slope, of.ofW, term.across, of.ofW, half * valueOf(term.force, phi));
        couple(term.slope, of.ofW, term.force, of.ofPhi, half * of.phiUnit * valueOf(term.across, w));
        couple(term.across, of.ofW, term.force, of.ofPhi, half * of.phiUnit * valueOf(term.slope, w));
    });
    for (std::size_t t = 0; t < of.thrusts.size(); ++t) {
        const NodeField forces = stretchForces(shell, membrane, of.thrusts[t], w);
        const int       column = of.firstThrust + int(t);
        for (std::size_t n = 0; n < of.ofW.size(); ++n) {
            if (of.ofW[n] == kHeldUnknown) continue;
            entries.push_back({{of.ofW[n], column}, of.phiUnit * forces.values()[n]});
            entries.push_back({{column, of.ofW[n]}, of.phiUnit * forces.values()[n]});
        }
    }
}

/// Returns the gradient of T at a state, in the unknowns.
Eigen::VectorXd gradientOfStretch(const ShellUnknowns& of, const Shell& shell, const Plate& membrane,
                                  const NodeField& w, const NodeField& phi)
{
    Eigen::VectorXd gradient = vectorOf(of.rightSide(stretchForces(shell, membrane, phi, w)));
    const NodeField load     = stretchOf(shell, membrane, w, w);
    for (std::size_t n = 0; n < of.ofPhi.size(); ++n)
        if (of.ofPhi[n] != kHeldUnknown) gradient[of.ofPhi[n]] = of.phiUnit * load.values()[n] / 2;
    for (std::size_t t = 0; t < of.thrusts.size(); ++t)
        gradient[of.firstThrust + int(t)] = of.phiUnit * dot(load, of.thrusts[t]) / 2;
    return gradient;
}

/// A shell on its way down.
class Press {
public:
    Press(const Shell& shell, const NodeField& unitLoad)
        : shell_(shell), unknowns_(shell), membrane_(membraneOf(shell)),
          linear_(matrixOf(unknowns_.entries, unknowns_.count)), load_(vectorOf(unknowns_.rightSide(unitLoad))),
          x_(Eigen::VectorXd::Zero(unknowns_.count))
    {
    }

    LargeState to(double depth)
    {
        constexpr int    kMostSteps = 40;
        constexpr double kClose     = 1e-9; // of the state, after which a step of second order has nothing left [1]
        for (int n = 1; n <= kMostSteps; ++n) {
            const double change = step(depth);
            if (!std::isfinite(change)) break;
            if (change < kClose * x_.lpNorm<Eigen::Infinity>())
                return {depth, force_, unknowns_.deflection(state()), unknowns_.stressFunction(state()), n};
        }
        throw Error("Newton's method found no equilibrium of the shell at a depth of " + formatQuantity(depth, "m") +
                    "; go there in smaller steps");
    }

private:
    /// Makes one step of Newton's method; returns its size [m].
    double step(double depth)
    {
        const NodeField w = unknowns_.deflection(state()), phi = unknowns_.stressFunction(state());
        ShellEntries    entries = unknowns_.entries;
        addStretch(entries, unknowns_, shell_, membrane_, w, phi);
        factors_.compute(matrixOf(entries, unknowns_.count));
        if (factors_.info() != Eigen::Success) return NAN;
        const Eigen::VectorXd rest    = -(linear_ * x_ + gradientOfStretch(unknowns_, shell_, membrane_, w, phi));
        const Eigen::VectorXd unit    = factors_.solve(load_);
        const Eigen::VectorXd balance = factors_.solve(rest);
        force_                        = (depth - load_.dot(x_ + balance)) / load_.dot(unit);
        const Eigen::VectorXd change  = balance + force_ * unit;
        x_ += change;
        return change.lpNorm<Eigen::Infinity>();
    }

    [[nodiscard]] std::span<const double> state() const { return {x_.data(), std::size_t(x_.size())}; }

    const Shell&    shell_;
    ShellUnknowns   unknowns_;
    Plate           membrane_;
    Matrix          linear_;
    Eigen::VectorXd load_, x_;
    double          force_ = 0; // [N]
    Factors         factors_;
};

} // namespace

std::vector<LargeState> pressDeep(const Shell& shell, const NodeField& unitLoad, std::span<const double> depths)
{
    Press                   press(shell, unitLoad);
    std::vector<LargeState> states;
    for (const double depth : depths) states.push_back(press.to(depth));
    return states;
}

} // namespace palp
