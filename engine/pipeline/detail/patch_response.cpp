#include "engine/pipeline/detail/patch_response.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/pipeline/detail/body_give.h"
#include "engine/pipeline/detail/body_on_window.h"
#include "engine/pipeline/detail/border_twist.h"
#include "engine/pipeline/detail/coarser_grid.h"
#include "engine/pipeline/detail/grid_part.h"
#include "engine/pipeline/detail/shell_patch.h"
#include "engine/pipeline/detail/stage_clock.h"
#include "engine/pipeline/detail/whole_object.h"
#include "engine/plate/curved_bending.h"
#include "engine/plate/load.h"

namespace palp {

NodeField unitLoad(const PlateGrid& grid, const PatchSettings& settings, const NodeField& covered,
                   const ChartPoint& place)
{
    NodeField load =
        footprintLoad(grid, 1, grid.sizeX() / 2 + place.x, grid.sizeZ() / 2 + place.z, settings.footprintRadius);
    if (covered.values().empty()) return load;
    return onPiece(Footprint(load), grid, covered).load(grid);
}

NodeField unitLoad(const Patch& patch, const PatchSettings& settings)
{
    return unitLoad(patch.plate.grid, settings, patch.covered, pressedPlace(patch));
}

// --- 2.5, equations 6 to 8: the plate bends under a unit force

namespace {

Stresses stressesFor(const Patch& patch)
{
    return patch.body ? Stresses::ofWhole : Stresses::none;
}

/// Finds what the body gives way by that a window is cut from.
void addBody(Patch& patch, const PatchSettings& settings, const GridPart& part, const NodeField& w,
             const NodeField& phi)
{
    if (!patch.body) return;
    const NodeField stress = phi.values().empty() ? NodeField() : part.onWhole(phi);
    const double    give   = bodyGive(patch, unitLoad(patch, settings), part.onWhole(w), stress);
    // Clamped sides are the stiffest that there are: less than nothing is an error of the coarse shell.
    if (std::isfinite(give))
        patch.bodyCompliance = std::max(0.0, give);
    else
        patch.body.reset(); // the warnings say so
}

/// Returns how what the body gives way by changes as the fingertip moves along x and along z [1/N]: two more answers of
/// the window, to the change of the load.
/// \param loads  of the table, on the part of the window that is solved for
std::pair<double, double> slopesOfBody(const Patch& patch, const GridPart& part, const FootprintLattice& loads,
                                       PlateSolver& solver)
{
    constexpr double kAbout  = 1e-3; // of a slope: over a table it is a hundredth of c [1]
    const Plate      plate   = part.of(patch.plate);
    const Shell      shell   = patch.curvature ? part.of(shellOf(patch)) : Shell{};
    const auto       changes = [&](double Footprint::Part::*along) {
        Footprint change = loads.loads[loads.loads.size() / 2];
        for (Footprint::Part& of : change.parts) of.force = of.*along;
        const FootprintSolution solved =
            patch.curvature ? solver.solveFootprints(shell, {&change, 1}, 0, kAbout, kAbout, Stresses::ofWhole)
                                  : solver.solveFootprints(plate, {&change, 1}, 0, kAbout, kAbout);
        const NodeField stress = solved.stress.values().empty() ? NodeField() : part.onWhole(solved.stress);
        return 2 *
               bodyGive(patch, part.onWhole(change.load(plate.grid)), part.onWhole(solved.whole.deflection), stress);
    };
    return {changes(&Footprint::Part::changeX), changes(&Footprint::Part::changeZ)};
}

/// \param compliance  of the plate alone, by the shallow theory [m/N]
/// \param curved      what it gives way over that, see givesWay() [1]
void keep(Patch& patch, const PatchSettings& settings, const GridPart& part, PlateSolution solution, double compliance,
          double curved)
{
    patch.response      = part.onWhole(solution.deflection);
    patch.report        = std::move(solution.report);
    patch.curvedBending = curved;
    for (double& w : patch.response.values()) w *= curved;
    patch.twist         = settings.theory == Theory::shell ? borderTwist(patch) : 0;
    patch.compliance    = compliance * curved + bodyFelt(patch) + patch.twist;
    patch.times.prepare = patch.report.setUpMilliseconds;
    patch.times.solve -= patch.times.prepare; // which the clock of this stage counts too
}

} // namespace

void bendPlate(Patch& patch, const PatchSettings& settings, PlateSolver& solver)
{
    const StageClock  clock(patch.times.solve);
    const GridPart    part(patch);
    const Footprint   finger = part.of(Footprint(unitLoad(patch, settings)));
    FootprintSolution solved =
        patch.curvature
            ? solver.solveFootprints(part.of(shellOf(patch)), {&finger, 1}, 0, settings.tolerance, settings.tolerance,
                                     stressesFor(patch))
            : solver.solveFootprints(part.of(patch.plate), {&finger, 1}, 0, settings.tolerance, settings.tolerance);
    const FootprintResponse& felt = solved.responses.front();
    addBody(patch, settings, part, solved.whole.deflection, solved.stress);
    keep(patch, settings, part, std::move(solved.whole), felt.work, givesWay(felt));
}

void bendPlate(Patch& patch, const PatchSettings& settings, const FootprintLattice& lattice, PlateSolver& solver,
               ComplianceTable& table)
{
    const StageClock clock(patch.times.solve);
    const GridPart   part(patch);
    const auto       solved = [&](const FootprintLattice& loads) {
        return patch.curvature
                         ? solveTable(part.of(shellOf(patch)), patch.below, loads, solver, settings.tolerance, table,
                                      stressesFor(patch))
                         : solveTable(part.of(patch.plate), patch.below, loads, solver, settings.tolerance, table);
    };
    const bool             whole  = !patch.covered.values().empty();
    const FootprintLattice loads  = whole ? part.of(onSheet(lattice, patch)) : lattice;
    MiddleSolution         middle = solved(loads);
    if (whole) fillContact(sheetRigidity(patch), lattice, table);
    addBody(patch, settings, part, middle.solution.deflection, middle.stress);
    const auto [slopeX, slopeZ] = patch.body ? slopesOfBody(patch, part, loads, solver) : std::pair(0.0, 0.0);
    addToCompliances(table, bodyFelt(patch), slopeX, slopeZ);
    table.chart = chartAtContact(patch);
    fillStiffening(patch.stiffeningAtNodes, lattice, table);
    keep(patch, settings, part, std::move(middle.solution), middle.compliance, middle.curved);
    for (ComplianceTable::Entry& entry : table.compliance)
        entry.value += std::log1p(patch.twist / (middle.compliance * middle.curved));
}

// --- 2.6, equation 9: the plate moves the points, and in series with the contact it is what the hand feels

void movePoints(Patch& patch)
{
    const StageClock clock(patch.times.lift);
    patch.pointResponse = responsesAt(patch, patch.followed);
}

void findStiffness(Patch& patch, const SoftObject& object, const PatchSettings& settings, const Footprint& finger)
{
    const bool   whole     = !patch.covered.values().empty();
    const double rigidity  = rigidityUnder(finger, whole ? sheetRigidity(patch) : patch.plate.rigidity);
    const double modulus   = object.material().modulus(rigidity);
    patch.contactStiffness = contactStiffness(modulus, settings.footprintRadius, object.material().thickness);
    patch.feltStiffness    = feltStiffness(settings.forceLaw, patch.contactStiffness, patch.compliance);
    patch.stiffening       = object.material().stiffening;
    if (!patch.stiffeningAtNodes.values().empty())
        patch.stiffening = responseOf(Footprint(unitLoad(patch, settings)), patch.stiffeningAtNodes).work;
}

bool hasCoarseGrid(const Patch& patch, const PatchSettings& settings)
{
    return patch.plate.grid.cellsX % 4 == 0 && settings.footprintRadius >= 2 * patch.plate.grid.spacingX;
}

namespace {

/// Of the solutions that a law of large deflections consists of [1]: its own model is right to a hundredth.
constexpr double kShapesTolerance = 1e-3;

/// Finds the law on a grid of twice the spacing, in a quarter of the time: its forces are off by 0.4 % there.
LargeLaw coarseLaw(const Patch& patch, const PatchSettings& settings, const Shell& fine, double reach,
                   PlateSolver& solver)
{
    const GridPart  part  = GridPart(patch).everySecond();
    const Shell     whole = everySecondOf(fine), shell = part.of(whole);
    const NodeField load = part.of(
        unitLoad(whole.bending.grid, settings, everySecondOf(patch.covered, whole.bending.grid), pressedPlace(patch)));
    const Footprint finger(load);
    const NodeField linear =
        (patch.curvature ? solver.solveFootprints(shell, {&finger, 1}, 0, kShapesTolerance, kShapesTolerance)
                         : solver.solveFootprints(shell.bending, {&finger, 1}, 0, kShapesTolerance, kShapesTolerance))
            .whole.deflection;
    LargeLaw     law   = largeLaw(shell, load, linear, reach, solver, kShapesTolerance);
    const double wrong = law.tangent.front() * dot(unitLoad(patch, settings), patch.response);
    for (LargeLaw::Values* values : {&law.force, &law.tangent})
        for (double& value : *values) value /= wrong; // it begins as on the fine grid
    return law;
}

/// Finds the law on the patch's own grid. The theory of its shapes is the shallow one; it is as much too stiff far down
/// as where it begins.
LargeLaw fineLaw(const Patch& patch, const PatchSettings& settings, const Shell& shell, double reach,
                 PlateSolver& solver)
{
    const GridPart part(patch);
    NodeField      shallow = part.of(patch.response);
    for (double& w : shallow.values()) w /= patch.curvedBending;
    LargeLaw law = largeLaw(part.of(shell), part.of(unitLoad(patch, settings)), shallow, reach, solver,
                            std::max(settings.tolerance, kShapesTolerance));
    for (LargeLaw::Values* values : {&law.force, &law.tangent})
        for (double& value : *values) value /= patch.curvedBending;
    return law;
}

} // namespace

void pressDeeper(Patch& patch, const PatchSettings& settings, PlateSolver& solver, bool quick)
{
    if (settings.large == Large::off) return;
    constexpr double kTrusted = 2; // thicknesses, see LargeLaw [1]
    const StageClock clock(patch.times.solve);
    const Shell      shell = shellOf(patch);
    const double     reach = kTrusted * patch.thickness;
    if (settings.forceLaw != ForceLaw::series)
        patch.linearBecause = std::string("the force law ") + name(settings.forceLaw) + " does not feel the plate";
    else if (const auto why = whyUnsolvable(GridPart(patch).of(shell)))
        patch.linearBecause = *why;
    else
        try {
            patch.large = quick && hasCoarseGrid(patch, settings) ? coarseLaw(patch, settings, shell, reach, solver)
                                                                  : fineLaw(patch, settings, shell, reach, solver);
        } catch (const Error& error) {
            patch.linearBecause = error.what();
        }
}

} // namespace palp
