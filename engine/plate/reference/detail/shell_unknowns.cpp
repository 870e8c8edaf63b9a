#include "engine/plate/reference/detail/shell_unknowns.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/plate/reference/plate_energy.h"

namespace palp {
namespace {

/// Numbers the unknowns of one field from `first` on. With `pinned` three corners are held as well: a phi that no side
/// holds is known but for a linear function, which carries no force.
std::vector<int> numbered(const Plate& plate, int first, bool pinned)
{
    const int        cellsX = plate.grid.cellsX, cellsZ = plate.grid.cellsZ;
    std::vector<int> numberOf;
    for (int i = 0; i <= cellsX; ++i)
        for (int j = 0; j <= cellsZ; ++j) {
            const bool isPin = pinned && (i == 0 || i == cellsX) && (j == 0 || j == cellsZ) && !(i > 0 && j > 0);
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
void addCoupling(ShellEntries& entries, const Shell& shell, const Plate& membrane, const std::vector<int>& ofW,
                 const std::vector<int>& ofPhi, double scale)
{
    const PlateGrid& g  = membrane.grid;
    const double     hx = g.spacingX, hz = g.spacingZ;
    const auto       couple = [&](int node, const Difference& d, double k) {
        const int row = ofW[std::size_t(node)];
        for (std::size_t m = 0; m < std::size_t(d.count); ++m) {
            const int column = ofPhi[std::size_t(d.node[m])];
            if (row == kHeldUnknown || column == kHeldUnknown) continue;
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

ShellUnknowns::ShellUnknowns(const Shell& shell) : grid(shell.bending.grid)
{
    if (const auto why = whyUnsolvable(shell)) throw Error("the shell cannot be solved: " + *why);
    if (grid.nodes() > kMostFactorisedNodes)
        throw Error("the reference solver takes shells of at most " + std::to_string(kMostFactorisedNodes) +
                    " nodes, found " + std::to_string(grid.nodes()) + "; use fewer cells");
    const Plate membrane = membraneOf(shell);
    ofW                  = numbered(shell.bending, 0, false);
    ofPhi                = numbered(membrane, 1 + *std::ranges::max_element(ofW), isStressFree(shell));
    count                = 1 + *std::ranges::max_element(ofPhi);
    phiUnit              = std::sqrt(geometricMean(shell.bending.rigidity) / geometricMean(shell.membraneCompliance));

    addEnergy(entries, shell.bending, ofW, 1);
    addEnergy(entries, membrane, ofPhi, -phiUnit * phiUnit);
    addCoupling(entries, shell, membrane, ofW, ofPhi, phiUnit);
}

NodeField ShellUnknowns::spread(const Eigen::VectorXd& x, const std::vector<int>& numberOf, double unit) const
{
    NodeField field(grid);
    for (std::size_t n = 0; n < numberOf.size(); ++n)
        if (numberOf[n] != kHeldUnknown) field.values()[n] = unit * x[numberOf[n]];
    return field;
}

Eigen::VectorXd ShellUnknowns::rightSide(const NodeField& nodalForce) const
{
    PALP_EXPECT(nodalForce.on(grid), "forces on another grid");
    Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
    for (std::size_t n = 0; n < ofW.size(); ++n)
        if (ofW[n] != kHeldUnknown) right[ofW[n]] = nodalForce.values()[n];
    return right;
}

ShellMatrix ShellUnknowns::matrixOf(const ShellEntries& from) const
{
    ShellMatrix matrix(count, count);
    matrix.setFromTriplets(from.begin(), from.end());
    return matrix;
}

} // namespace palp
