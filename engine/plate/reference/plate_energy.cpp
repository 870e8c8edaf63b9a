#include "engine/plate/reference/plate_energy.h"

namespace palp {
namespace {

/// Returns the second difference along one axis at node `index`, which has number `node` and whose neighbours along
/// that axis are `stride` apart; empty where the edge leaves no moment.
Difference secondDifference(int index, int cells, Edge first, Edge last, int node, int stride)
{
    Difference d;
    if (index > 0 && index < cells) {
        d.add(node - stride, 1);
        d.add(node, -2);
        d.add(node + stride, 1);
    } else if (holdsSlope(index == 0 ? first : last)) {
        d.add(node, -2);
        d.add(index == 0 ? node + stride : node - stride, 2);
    }
    return d;
}

void subtract(NodeField& forces, const Difference& d, double force)
{
    for (std::size_t m = 0; m < std::size_t(d.count); ++m)
        forces.values()[std::size_t(d.node[m])] -= d.factor[m] * force;
}

} // namespace

double valueOf(const Difference& d, const NodeField& field)
{
    double sum = 0;
    for (std::size_t m = 0; m < std::size_t(d.count); ++m) sum += d.factor[m] * field.values()[std::size_t(d.node[m])];
    return sum;
}

EnergyTerm bendingTerm(const Plate& plate, int i, int j)
{
    const PlateGrid& g     = plate.grid;
    const int        node  = i * g.nodesZ() + j;
    const double     hxhx  = g.spacingX * g.spacingX;
    const double     hzhz  = g.spacingZ * g.spacingZ;
    const double     nu    = plate.poissonRatio;
    const double     scale = plate.rigidity(i, j) * nodeArea(g, i, j);

    EnergyTerm term;
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

EnergyTerm twistingTerm(const Plate& plate, int i, int j)
{
    const NodeField& D      = plate.rigidity;
    const int        node   = i * plate.grid.nodesZ() + j;
    const int        beside = node + plate.grid.nodesZ();
    const double     mean   = 0.25 * (D(i, j) + D(i + 1, j) + D(i, j + 1) + D(i + 1, j + 1));

    EnergyTerm term;
    term.p.add(node, 1);
    term.p.add(beside, -1);
    term.p.add(node + 1, -1);
    term.p.add(beside + 1, 1);
    term.kpp = 2 * (1 - plate.poissonRatio) * mean / (plate.grid.spacingX * plate.grid.spacingZ);
    return term;
}

EnergyTerm foundationTerm(const Plate& plate, int i, int j)
{
    EnergyTerm term;
    term.p.add(i * plate.grid.nodesZ() + j, 1);
    term.kpp = foundationAt(plate, i, j) * nodeArea(plate.grid, i, j);
    return term;
}

NodeField energyResidual(const Plate& plate, const NodeField& forces, const NodeField& w)
{
    NodeField rest = forces;
    visitTerms(plate, [&](const EnergyTerm& term) {
        const double p = valueOf(term.p, w), q = valueOf(term.q, w);
        subtract(rest, term.p, term.kpp * p + term.kpq * q);
        subtract(rest, term.q, term.kpq * p + term.kqq * q);
    });
    return rest;
}

} // namespace palp
