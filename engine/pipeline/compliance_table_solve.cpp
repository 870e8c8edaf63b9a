#include "engine/pipeline/compliance_table_solve.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/dent_length.h"
#include "engine/pipeline/detail/bending.h"
#include "engine/pipeline/detail/shell_windows.h"
#include "engine/plate/curved_bending.h"
#include "engine/plate/load.h"

namespace palp {
namespace {

/// Number of rungs to either side of the middle one, and per decade: rigidities from a hundredth to a hundred times as
/// large, with 1e-3 of c lost between two of them at the corner of a table; 17 tables to solve, once per scene.
constexpr int kRungs = 8, kRungsPerDecade = 4;

/// Returns the central difference of the load of a footprint that moves.
NodeField slopeOf(const NodeField& ahead, const NodeField& behind, double distance)
{
    NodeField slope = ahead;
    for (std::size_t n = 0; n < slope.values().size(); ++n)
        slope.values()[n] = (slope.values()[n] - behind.values()[n]) / distance;
    return slope;
}

/// The load of a fingertip on the nodes around it, so that none of a large grid is touched beside them.
class FingertipOn {
public:
    /// \param centre  from the plate's middle [m]
    /// \param around  where it may be moved from there [m]
    FingertipOn(const PlateGrid& grid, const ChartPoint& centre, double radius, double around)
        : whole_(grid), part_(grid), radius_(radius)
    {
        const auto range = [&](double at, double spacing, int& cells) {
            const double margin = radius + around + spacing;
            const int    first  = std::clamp(int(std::floor((at - margin) / spacing)), 0, cells);
            const int    last   = std::clamp(int(std::ceil((at + margin) / spacing)), first, cells);
            cells               = last - first;
            return first;
        };
        firstX_ = range(grid.sizeX() / 2 + centre.x, grid.spacingX, part_.cellsX);
        firstZ_ = range(grid.sizeZ() / 2 + centre.z, grid.spacingZ, part_.cellsZ);
    }

    [[nodiscard]] NodeField at(const ChartPoint& centre) const
    {
        return footprintLoad(part_, 1, whole_.sizeX() / 2 + centre.x - firstX_ * whole_.spacingX,
                             whole_.sizeZ() / 2 + centre.z - firstZ_ * whole_.spacingZ, radius_);
    }

    /// Returns a footprint of its nodes as one of the whole grid's.
    [[nodiscard]] Footprint onWhole(Footprint own) const
    {
        for (Footprint::Part& part : own.parts) {
            const int i = int(part.node) / part_.nodesZ(), j = int(part.node) % part_.nodesZ();
            part.node = std::uint32_t((firstX_ + i) * whole_.nodesZ() + firstZ_ + j);
        }
        return own;
    }

private:
    PlateGrid whole_, part_;
    double    radius_; ///< [m]
    int       firstX_ = 0, firstZ_ = 0;
};

/// Returns ln c of a footprint of 1 N, with its slopes.
ComplianceTable::Entry complianceOf(const FootprintResponse& felt)
{
    return {std::log(felt.work), 2 * felt.changeX / felt.work, 2 * felt.changeZ / felt.work};
}

/// Returns ln k_c of a footprint, with its slopes.
/// \param over  ln D over that of some node
ComplianceTable::Entry contactOf(const FootprintLattice& lattice, std::size_t n, const NodeField& over, double node)
{
    const FootprintResponse mean = responseOf(lattice.loads[n], over);
    return {std::log(lattice.shape.contactPerRigidity * node) + mean.work, mean.changeX, mean.changeZ};
}

/// Returns the root mean square radius [m] of the bending energy of a homogeneous plate about its middle, on which its
/// compliance depends where the rigidity changes.
double bendingRadius(const Plate& plate, const NodeField& w)
{
    const PlateGrid& grid = plate.grid;
    double           sum = 0, energy = 0;
    for (int i = 1; i + 1 < grid.nodesX(); ++i)
        for (int j = 1; j + 1 < grid.nodesZ(); ++j) {
            const double here = Bending::at(grid, w, i, j).energy(plate.poissonRatio);
            const double x = i * grid.spacingX - grid.sizeX() / 2, z = j * grid.spacingZ - grid.sizeZ() / 2;
            sum += here * (x * x + z * z);
            energy += here;
        }
    return std::sqrt(sum / energy);
}

/// ln D over that of some node: exactly 0 if all are alike.
struct OverNode {
    double    node = 0, mean = 0; ///< rigidity of that node, geometric mean [N m]
    NodeField over;

    explicit OverNode(const NodeField& rigidity)
        : node(rigidity.values().front()), over(rigidity.nodesX(), rigidity.nodesZ())
    {
        double sum = 0;
        for (std::size_t n = 0; n < over.values().size(); ++n)
            sum += over.values()[n] = std::log(rigidity.values()[n] / node);
        mean = node * std::exp(sum / double(over.values().size()));
    }
};

/// Adds what a curved object gives way over the shallow theory to ln c of each entry, and how that changes from one to
/// the next to their slopes.
void addCurved(std::span<const FootprintResponse> responses, ComplianceTable& table)
{
    if (std::ranges::all_of(responses, [](const FootprintResponse& of) { return of.curved == 0; })) return;
    const int  side = table.side, last = side - 1;
    const auto at     = [&](int i, int j) { return std::log(givesWay(responses[std::size_t(i * side + j)])); };
    const auto change = [&](int from, int to, double of) { return to > from ? of / ((to - from) * table.spacing) : 0; };
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) {
            ComplianceTable::Entry& entry = table.compliance[std::size_t(i * side + j)];
            const int               i0 = std::max(0, i - 1), i1 = std::min(last, i + 1);
            const int               j0 = std::max(0, j - 1), j1 = std::min(last, j + 1);
            entry.value += at(i, j);
            entry.slopeX += change(i0, i1, at(i1, j) - at(i0, j));
            entry.slopeZ += change(j0, j1, at(i, j1) - at(i, j0));
        }
}

/// Writes what footprints feel, less what they feel of the window alone.
/// \param own  of the window: ln c(e)/c(0) with its slopes
MiddleSolution fillTable(FootprintSolution solved, const FootprintLattice& lattice, const OverNode& rigidity,
                         const ComplianceTable::Entries& own, ComplianceTable& table)
{
    table.side    = lattice.shape.side;
    table.spacing = lattice.shape.radius;
    for (std::size_t n = 0; n < solved.responses.size(); ++n) {
        const ComplianceTable::Entry felt = complianceOf(solved.responses[n]);
        table.compliance[n] = {felt.value - own[n].value, felt.slopeX - own[n].slopeX, felt.slopeZ - own[n].slopeZ};
        table.contactStiffness[n] = contactOf(lattice, n, rigidity.over, rigidity.node);
    }
    addCurved(solved.responses, table);
    const FootprintResponse& middle = solved.responses[lattice.loads.size() / 2];
    return {std::move(solved.whole), middle.work, givesWay(middle), std::move(solved.stress)};
}

/// Returns ln c(e)/c(0) with its slopes in the window of a homogeneous shell of the mean rigidity and curvature.
ComplianceTable::Entries windowOf(const Shell& shell, double below, const FootprintLattice& lattice,
                                  PlateSolver& solver, double tolerance)
{
    ShellWindows&     kept   = *lattice.shells;
    const ShellShape  shape  = meanShape(shell, below);
    const std::size_t middle = lattice.loads.size() / 2;
    {
        const std::lock_guard lock(kept.mutex);
        if (const auto found = kept.known.find(shape); found != kept.known.end()) return found->second;
    }
    const auto mean =
        solver.solveFootprints(shellOfShape(shape, shell), lattice.loads, middle, tolerance, PlateSolver::kAsWorks);
    const auto               at = complianceOf(mean.responses[middle]);
    ComplianceTable::Entries own{};
    for (std::size_t n = 0; n < mean.responses.size(); ++n) {
        own[n] = complianceOf(mean.responses[n]);
        own[n].value -= at.value;
    }
    const std::lock_guard lock(kept.mutex);
    if (kept.known.size() >= ShellWindows::kMost) kept.known.clear();
    kept.known.emplace(shape, own);
    return own;
}

/// Returns l^-4 of a shell as curved as the object is at a typical place, by its curvature alone [1/m^4]; 0 if that
/// ends no dents there.
double curvedAs(const SoftObject& object, PatchSettings settings)
{
    if (settings.theory != Theory::shell) return 0;
    settings.foundation = 0; // which ends them where the sheet is soft, however flat it is
    const auto dents    = dentLengths(object, settings);
    return dents ? std::pow(dents->typical, -4) : 0;
}

} // namespace

std::vector<Footprint> footprintsAt(const PlateGrid& grid, const FootprintTable& shape, const PlaceOnPlate& placeOf)
{
    // Half a spacing to either side: the sub-cells of a footprint then cross as many nodes wherever it lies.
    const double           dx = grid.spacingX / 2, dz = grid.spacingZ / 2;
    std::vector<Footprint> loads;
    for (int i = 0; i < shape.side; ++i)
        for (int j = 0; j < shape.side; ++j) {
            const double      x = (i - shape.side / 2) * shape.radius, z = (j - shape.side / 2) * shape.radius;
            const FingertipOn tip(grid, placeOf({x, z}), shape.radius, 2 * std::max(dx, dz));
            const auto        at = [&](double u, double v) { return tip.at(placeOf({u, v})); };
            loads.push_back(tip.onWhole(Footprint(at(x, z), slopeOf(at(x + dx, z), at(x - dx, z), 2 * dx),
                                                  slopeOf(at(x, z + dz), at(x, z - dz), 2 * dz))));
        }
    return loads;
}

FootprintLattice footprintLattice(const SoftObject& object, const PatchSettings& given, int side, PlateSolver& solver)
{
    const PatchSettings settings = settledFor(object, given);
    const bool          whole    = settings.windowOf == WindowOf::object;
    std::vector<double> rigidities(object.size());
    for (std::size_t point = 0; point < object.size(); ++point) rigidities[point] = object.rigidity(point);
    const PlateGrid grid = PatchWindow::square(settings.window, settings.cells).grid;
    const Plate     homogeneous{grid, whole ? PlateEdges{} : edgesOfWindow(settings), object.material().poissonRatio,
                            settings.foundation, NodeField(grid, geometricMean(rigidities))};
    const double    perRigidity =
        contactStiffness(object.material().modulus(1), settings.footprintRadius, object.material().thickness);
    const double     curved  = curvedAs(object, settings);
    FootprintLattice lattice = solveLattice(homogeneous, {settings.footprintRadius, side, perRigidity}, solver,
                                            settings.tolerance, whole, curved);
    // The window is twice as wide as the object, and what a clamped plate gives way by grows with its area.
    if (whole && settings.foundation == 0 && curved == 0) lattice.middles.front() -= std::log(4.0);
    return lattice;
}

FootprintLattice solveLattice(const Plate& homogeneous, const FootprintTable& shape, PlateSolver& solver,
                              double tolerance, bool wholeObject, double curved)
{
    PALP_EXPECT(shape.side >= 1 && shape.side <= ComplianceTable::kMostSide && shape.side % 2 == 1,
                "a table of " + std::to_string(shape.side) + " entries a side");
    PALP_EXPECT(shape.contactPerRigidity > 0, "no contact stiffness");
    const PlateGrid& grid    = homogeneous.grid;
    const double     spacing = std::max(grid.spacingX, grid.spacingZ); // a slope is measured over one; see below
    const double     wanted  = 2 * (shape.side / 2 + 1) * shape.radius + spacing,
                 found       = std::min(grid.sizeX(), grid.sizeZ());
    if (found < wanted)
        throw Error("the patch window of " + formatQuantity(found, "m") + " does not hold a table of " +
                    std::to_string(shape.side) + " x " + std::to_string(shape.side) + " footprints of radius " +
                    formatQuantity(shape.radius, "m") + "; expected at least " + formatQuantity(wanted, "m"));

    FootprintLattice lattice{.shape = shape, .wholeObject = wholeObject, .shells = std::make_shared<ShellWindows>()};
    lattice.loads = footprintsAt(grid, shape, [](const ChartPoint& place) { return place; });
    // A factorisation for each rung of a large window would take minutes.
    const bool isSlow                            = wholeObject && solver.name() == PlateSolver::kReference;
    const int  reach                             = homogeneous.foundation > 0 && !isSlow ? kRungs : 0;
    lattice.rigidity                             = homogeneous.rigidity(0, 0);
    lattice.foundation                           = homogeneous.foundation;
    const Footprint&                      finger = lattice.loads[lattice.loads.size() / 2];
    std::vector<ComplianceTable::Entries> rungs(std::size_t(2 * reach + 1));
    std::vector<double>                   middles(rungs.size());
    const auto                            alone = [&](const Plate& of) {
        return solver.solveFootprints(of, {&finger, 1}, 0, tolerance, tolerance);
    };
    for (int n = 0; n <= 2 * reach; ++n) {
        const int  rung  = (n + 1) / 2 * (n % 2 == 0 ? 1 : -1); // 0, -1, 1, -2, ...
        const auto at    = std::size_t(rung + reach);
        Plate      plate = homogeneous;
        NodeField  deflection;
        plate.rigidity = NodeField(grid, lattice.rigidity * std::pow(10, double(rung) / kRungsPerDecade));
        if (!wholeObject) {
            TableSolution own = solveTable(plate, lattice, solver, tolerance);
            middles[at]       = own.table.middle().lnCompliance;
            rungs[at]         = own.table.compliance;
            for (ComplianceTable::Entry& entry : rungs[at])
                entry = {entry.value - middles[at], entry.slopeX, entry.slopeZ};
            deflection = std::move(own.middle.deflection);
        } else if (rung == 0 || !(curved > 0)) { // no table of it is like that of a homogeneous window
            FootprintSolution own = alone(plate);
            middles[at]           = std::log(own.responses.front().work);
            deflection            = std::move(own.whole.deflection);
        }
        if (rung == 0) lattice.feltRadius = bendingRadius(plate, deflection);
        if (curved > 0) {
            plate.foundation += curved * plate.rigidity(0, 0);
            middles[at] = std::log(alone(plate).responses.front().work);
        }
    }
    lattice.rungs   = std::move(rungs);
    lattice.middles = std::move(middles);
    return lattice;
}

ComplianceTable::Entries FootprintLattice::homogeneous(double meanRigidity) const
{
    if (rungs.empty()) return {}; // while they are being made
    const double last  = double(rungs.size() - 1);
    const double along = std::clamp(last / 2 + kRungsPerDecade * std::log10(meanRigidity / rigidity), 0.0, last);
    const auto   lower = std::min(std::size_t(along), rungs.size() - 1), upper = std::min(lower + 1, rungs.size() - 1);
    const double t = along - double(lower);

    ComplianceTable::Entries entries;
    for (std::size_t n = 0; n < entries.size(); ++n) {
        const ComplianceTable::Entry &a = rungs[lower][n], &b = rungs[upper][n];
        entries[n] = {std::lerp(a.value, b.value, t), std::lerp(a.slopeX, b.slopeX, t),
                      std::lerp(a.slopeZ, b.slopeZ, t)};
    }
    return entries;
}

double FootprintLattice::lnCompliance(double ofRigidity) const
{
    const double decades = std::log10(ofRigidity / rigidity);
    if (middles.size() < 2) return middles.front() - decades * std::numbers::ln10;
    const double last = double(middles.size() - 1), along = last / 2 + kRungsPerDecade * decades;
    const auto   lower = std::size_t(std::clamp(std::floor(along), 0.0, last - 1));
    return std::lerp(middles[lower], middles[lower + 1], along - double(lower));
}

TableSolution solveTable(const Plate& plate, const FootprintLattice& lattice, PlateSolver& solver, double tolerance)
{
    TableSolution  result;
    MiddleSolution middle = solveTable(plate, meanFoundation(plate), lattice, solver, tolerance, result.table);
    result.middle         = std::move(middle.solution);
    result.compliance     = middle.compliance;
    return result;
}

MiddleSolution solveTable(const Plate& plate, double below, const FootprintLattice& lattice, PlateSolver& solver,
                          double tolerance, ComplianceTable& table)
{
    FootprintSolution solved =
        solver.solveFootprints(plate, lattice.loads, lattice.loads.size() / 2, tolerance, PlateSolver::kAsWorks);
    const OverNode over(plate.rigidity);
    // The window's correction depends on how far a dent spreads, (D/k)^(1/4): a foundation that is firmer throughout is
    // as good as a softer sheet.
    const double firmer = lattice.foundation > 0 && below > 0 ? below / lattice.foundation : 1;
    return fillTable(std::move(solved), lattice, over, lattice.homogeneous(over.mean / firmer), table);
}

MiddleSolution solveTable(const Shell& shell, double below, const FootprintLattice& lattice, PlateSolver& solver,
                          double tolerance, ComplianceTable& table, Stresses stresses)
{
    // What stresses do along other displacements is of the first order in their error.
    constexpr double  kStresses = 1e-3; // [1]
    const double      drawn     = stresses == Stresses::none ? PlateSolver::kAsWorks : kStresses;
    FootprintSolution solved =
        solver.solveFootprints(shell, lattice.loads, lattice.loads.size() / 2, tolerance, drawn, stresses);
    const auto own = lattice.loads.size() > 1 && !lattice.wholeObject
                         ? windowOf(shell, below, lattice, solver, tolerance)
                         : ComplianceTable::Entries{};
    return fillTable(std::move(solved), lattice, OverNode(shell.bending.rigidity), own, table);
}

double meanFoundation(const Plate& plate)
{
    const auto& shape = plate.foundationShape.values();
    return plate.foundation * (shape.empty() ? 1 : geometricMean(shape));
}

double rigidityUnder(const Footprint& footprint, const NodeField& rigidity)
{
    const double node  = rigidity.values()[footprint.parts.front().node];
    double       force = 0, sum = 0;
    for (const Footprint::Part& part : footprint.parts) {
        force += part.force;
        sum += part.force * std::log(rigidity.values()[part.node] / node);
    }
    return node * std::exp(sum / force);
}

void fillContact(const NodeField& rigidity, const FootprintLattice& lattice, ComplianceTable& table)
{
    const OverNode over(rigidity);
    for (std::size_t n = 0; n < lattice.loads.size(); ++n)
        table.contactStiffness[n] = contactOf(lattice, n, over.over, over.node);
}

void fillStiffening(const NodeField& stiffening, const FootprintLattice& lattice, ComplianceTable& table)
{
    table.stiffens = !stiffening.values().empty();
    if (!table.stiffens) return;
    for (std::size_t n = 0; n < lattice.loads.size(); ++n) {
        const FootprintResponse mean = responseOf(lattice.loads[n], stiffening);
        table.stiffening[n]          = {mean.work, mean.changeX, mean.changeZ};
    }
}

} // namespace palp
