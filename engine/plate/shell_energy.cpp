#include "engine/plate/shell_energy.h"

namespace palp {
namespace {

void add(NodeField& to, const Difference& d, double factor)
{
    for (std::size_t m = 0; m < std::size_t(d.count); ++m) to.values()[std::size_t(d.node[m])] += factor * d.factor[m];
}

} // namespace

NodeField couplingForces(const Shell& shell, const NodeField& phi)
{
    NodeField forces(shell.bending.grid);
    visitCouplingTerms(shell, membraneOf(shell), [&](const CouplingTerm& term) {
        forces.values()[std::size_t(term.node)] += term.stiffness * valueOf(term.force, phi);
    });
    return forces;
}

NodeField couplingLoad(const Shell& shell, const NodeField& w)
{
    NodeField load(shell.bending.grid);
    visitCouplingTerms(shell, membraneOf(shell), [&](const CouplingTerm& term) {
        add(load, term.force, term.stiffness * w.values()[std::size_t(term.node)]);
    });
    return load;
}

NodeField stretchForces(const Shell& shell, const Plate& membrane, const NodeField& phi, const NodeField& w)
{
    NodeField forces(membrane.grid);
    visitStretchTerms(shell, membrane, [&](const StretchTerm& term) {
        const double half = term.stiffness * valueOf(term.force, phi) / 2;
        add(forces, term.slope, half * valueOf(term.across, w));
        add(forces, term.across, half * valueOf(term.slope, w));
    });
    return forces;
}

NodeField stretchOf(const Shell& shell, const Plate& membrane, const NodeField& v, const NodeField& w)
{
    NodeField load(membrane.grid);
    visitStretchTerms(shell, membrane, [&](const StretchTerm& term) {
        const double both =
            valueOf(term.slope, v) * valueOf(term.across, w) + valueOf(term.slope, w) * valueOf(term.across, v);
        add(load, term.force, term.stiffness * both / 2);
    });
    return load;
}

} // namespace palp
