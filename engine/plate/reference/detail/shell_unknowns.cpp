#include "engine/plate/reference/detail/shell_unknowns.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/plate/shell_energy.h"
#include "engine/plate/thrust.h"

namespace palp {
namespace {

/// Numbers the unknowns of one field from `first` on.
/// \param pins  nodes that are held as well as those of the sides
std::vector<int> numbered(const Plate& plate, int first, std::span<const std::size_t> pins)
{
    std::vector<int> numberOf;
    for (int i = 0; i <= plate.grid.cellsX; ++i)
        for (int j = 0; j <= plate.grid.cellsZ; ++j) {
            const bool isPin = std::ranges::find(pins, numberOf.size()) != pins.end();
            numberOf.push_back(isHeld(plate, i, j) || isPin ? kHeldUnknown : first++);
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
void addEnergy(ShellEntries& entries, const Plate& plate, const std::vector<int>& numberOf, double scale)
{
    const auto product = [&](const Difference& a, const Difference& b, double k) {
        for (std::size_t m = 0; m < std::size_t(a.count); ++m)
            for (std::size_t n = 0; n < std::size_t(b.count); ++n) {
                const int row = numberOf[std::size_t(a.node[m])], column = numberOf[std::size_t(b.node[n])];
                if (row != kHeldUnknown && column != kHeldUnknown)
                    entries.push_back({{row, column}, scale * k * a.factor[m] * b.factor[n]});
            }
    };
    visitTerms(plate, [&](const EnergyTerm& term) {
        product(term.p, term.p, term.kpp);
        product(term.q, term.q, term.kqq);
        product(term.p, term.q, term.kpq);
        product(term.q, term.p, term.kpq);
    });
}

/// Adds the second derivative of the coupling by curvature, times `scale`.
void addCoupling(ShellEntries& entries, const Shell& shell, const Plate& membrane, const std::vector<int>& ofW,
                 const std::vector<int>& ofPhi, double scale)
{
    visitCouplingTerms(shell, membrane, [&](const CouplingTerm& term) {
        const int row = ofW[std::size_t(term.node)];
        for (std::size_t m = 0; m < std::size_t(term.force.count); ++m) {
            const int column = ofPhi[std::size_t(term.force.node[m])];
            if (row == kHeldUnknown || column == kHeldUnknown) continue;
            entries.push_back({{row, column}, scale * term.stiffness * term.force.factor[m]});
            entries.push_back({{column, row}, scale * term.stiffness * term.force.factor[m]});
        }
    });
}

/// Adds the rows and columns of the thrusts.
void addThrusts(ShellEntries& entries, const Shell& shell, const ShellUnknowns& of)
{
    const Thrusts thrusts(shell);
    const auto    add = [&](int row, int column, double part) {
        if (row == kHeldUnknown) return;
        entries.push_back({{row, column}, part});
        if (row != column) entries.push_back({{column, row}, part});
    };
    for (std::size_t t = 0; t < thrusts.loads().size(); ++t) {
        const int        column = of.firstThrust + int(t);
        const ShellLoad& load   = thrusts.loads()[t];
        for (std::size_t n = 0; n < of.ofW.size(); ++n) {
            add(of.ofW[n], column, of.phiUnit * load.onW.values()[n]);
            add(of.ofPhi[n], column, of.phiUnit * of.phiUnit * load.onPhi.values()[n]);
        }
        for (std::size_t other = 0; other <= t; ++other)
            add(of.firstThrust + int(other), column, -of.phiUnit * of.phiUnit * thrusts.own(other, t));
    }
}

} // namespace

ShellUnknowns::ShellUnknowns(const Shell& shell) : grid(shell.bending.grid), thrusts(shell.thrusts)
{
    if (const auto why = whyUnsolvable(shell)) throw Error("the shell cannot be solved: " + *why);
    if (grid.nodes() > kMostFactorisedNodes)
        throw Error("the reference solver takes shells of at most " + std::to_string(kMostFactorisedNodes) +
                    " nodes, found " + std::to_string(grid.nodes()) + "; use fewer cells");
    const Plate membrane = membraneOf(shell);
    const auto  pins     = pinsOfStress(grid);
    ofW                  = numbered(shell.bending, 0, {});
    ofPhi                = numbered(membrane, 1 + *std::ranges::max_element(ofW),
                                    isStressFree(shell) ? std::span(pins) : std::span<const std::size_t>{});
    firstThrust          = 1 + *std::ranges::max_element(ofPhi);
    count                = firstThrust + int(thrusts.size());
    phiUnit              = std::sqrt(geometricMean(shell.bending.rigidity) / geometricMean(shell.membraneCompliance));

    addEnergy(entries, shell.bending, ofW, 1);
    addEnergy(entries, membrane, ofPhi, -phiUnit * phiUnit);
    addCoupling(entries, shell, membrane, ofW, ofPhi, phiUnit);
    addThrusts(entries, shell, *this);
}

NodeField ShellUnknowns::stressFunction(std::span<const double> x) const
{
    NodeField phi = spread(x, ofPhi, phiUnit);
    for (std::size_t t = 0; t < thrusts.size(); ++t)
        for (std::size_t n = 0; n < phi.values().size(); ++n)
            phi.values()[n] += phiUnit * x[std::size_t(firstThrust) + t] * thrusts[t].values()[n];
    return phi;
}

NodeField ShellUnknowns::spread(std::span<const double> x, const std::vector<int>& numberOf, double unit) const
{
    NodeField field(grid);
    for (std::size_t n = 0; n < numberOf.size(); ++n)
        if (numberOf[n] != kHeldUnknown) field.values()[n] = unit * x[std::size_t(numberOf[n])];
    return field;
}

std::vector<double> ShellUnknowns::rightSide(const NodeField& nodalForce) const
{
    PALP_EXPECT(nodalForce.on(grid), "forces on another grid");
    std::vector<double> right(std::size_t(count), 0);
    for (std::size_t n = 0; n < ofW.size(); ++n)
        if (ofW[n] != kHeldUnknown) right[std::size_t(ofW[n])] = nodalForce.values()[n];
    return right;
}

} // namespace palp
