#include "engine/pipeline/move_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/chart/chart_in_chart.h"
#include "engine/pipeline/detail/chart_doubt.h"
#include "engine/pipeline/detail/contact_chart.h"
#include "engine/pipeline/detail/patch_response.h"
#include "engine/pipeline/detail/shell_patch.h"
#include "engine/pipeline/detail/touched_surface.h"
#include "engine/pipeline/detail/whole_object.h"

namespace palp {
namespace {

constexpr double kMostDoubt = 0.04; ///< see chartDoubt() [1]

/// A contact, and the chart about it.
struct Pressed {
    Patch patch; ///< of which nothing is filled in but what is known of the contact
    Chart chart;
};

std::optional<Pressed> pressedAt(const SoftObject& object, const Contact& contact, const PatchSettings& settings,
                                 double radius, const std::optional<Frame>& carried)
{
    const Ball ball = ballOf(object, contact.point, radius);
    if (ball.points.empty()) return {};
    const TouchedSurface surface = touchedSurface(object, contact, ball);
    Pressed              pressed;
    pressed.patch.contact = contact;
    pressed.patch.spacing = surface.spacing;
    pressed.patch.noise   = surface.noise;
    fitSphereTo(pressed.patch, object, ball, surface, settings);
    if (!pressed.patch.deformed()) return {};
    pressed.chart = chartAt(pressed.patch, object, settings.map, carried);
    return pressed;
}

/// Finds how a chart lies in the patch's; nothing if the contact is not on the surface that the patch has, or beside it
/// by less than a fingertip: another layer, or another piece, is nearer than any point of that.
std::optional<ChartInChart> placeIn(const Patch& patch, const SoftObject& object, const glm::dvec3& contact,
                                    const Chart& chart, double radius, double fingertip)
{
    std::vector<PlaceInBoth> places;
    double                   nearest = std::numeric_limits<double>::infinity(); // [m]
    for (std::size_t k = 0; k < patch.touched; ++k) {
        const glm::dvec3& point = object.positions()[patch.points[k]];
        const glm::dvec3  d     = point - contact;
        const double      away  = glm::dot(d, d) / (radius * radius);
        if (!(away < 1)) continue;
        nearest = std::min(nearest, glm::length(d));
        if (const auto own = chart.project(point))
            places.push_back({*own, patch.positions[k], (1 - away) * (1 - away)});
    }
    const std::uint32_t any = object.index().nearest(contact, 1).front().point;
    const double        off = glm::length(object.positions()[any] - contact);
    if (nearest > off + patch.thickness || nearest > fingertip + 2 * patch.spacing) return {};
    return ChartInChart::fitted(places, radius);
}

/// Returns whether the patch's chart has the lengths of the other one where a table reaches, and holds its footprints.
bool isAsGood(const ChartInChart& lies, const FootprintTable& shape, const PlateGrid& grid)
{
    constexpr double kStretch = 0.03, kAtItsRim = 0.045, kMisfit = 0.1; // [1], [1], of the fingertip's radius
    const double     reach  = shape.side / 2 * shape.radius;
    const double     margin = shape.radius + 2 * std::max(grid.spacingX, grid.spacingZ);
    if (!(lies.stretchAt({}) < kStretch && lies.misfit() < kMisfit * shape.radius)) return false;
    for (const double x : {-reach, 0.0, reach})
        for (const double z : {-reach, 0.0, reach}) {
            const ChartPoint at = lies.at({x, z});
            if (!(lies.stretchAt({x, z}) < kAtItsRim)) return false;
            if (std::abs(at.x) + margin > grid.sizeX() / 2 || std::abs(at.z) + margin > grid.sizeZ() / 2) return false;
        }
    return true;
}

/// Returns whether what is pressed counts as held in the sheet's plane although nothing holds it. A window about it has
/// the same where a tie crosses it.
bool isOnOverhang(const Patch& patch)
{
    if (patch.heldInPlane.values().empty() || patch.tied > 0) return false;
    const auto        at   = nodeAtContact(patch);
    const std::size_t node = std::size_t(at.i) * std::size_t(patch.plate.grid.nodesZ()) + std::size_t(at.j);
    return patch.heldInPlane.values()[node] > patch.held.values()[node] + 0.5;
}

} // namespace

std::optional<Patch> movePatch(const Patch& from, const SoftObject& object, const Contact& contact,
                               const PatchSettings& given, const FootprintLattice& lattice, PlateSolver& solver,
                               const std::optional<Frame>& carried, ComplianceTable& table)
{
    const PatchSettings settings = settledFor(object, given);
    if (settings.windowOf != WindowOf::object || settings.neighbourhood == Neighbourhood::ball || !from.deformed())
        return {};
    const FootprintTable& shape   = lattice.shape;
    const SoftObject&     used    = usedOf(from, object);
    const double          radius  = (std::numbers::sqrt2 * (shape.side / 2) + 2) * shape.radius; // of points around [m]
    const auto            pressed = pressedAt(used, contact, settings, radius, carried);
    if (!pressed) return {};
    const auto lies = placeIn(from, used, contact.point, pressed->chart, radius, shape.radius);
    if (!lies || !isAsGood(*lies, shape, from.window.grid)) return {};

    Patch patch          = from;
    patch.contact        = pressed->patch.contact;
    patch.sphere         = pressed->patch.sphere;
    patch.normalFelt     = pressed->patch.normalFelt;
    patch.sideUnsure     = pressed->patch.sideUnsure;
    patch.spacing        = pressed->patch.spacing;
    patch.noise          = pressed->patch.noise;
    patch.times          = {};
    patch.moved          = {lies->at({}), pressed->chart};
    const NodeField load = unitLoad(patch, settings);
    if (!areOnOnePiece(patch, unitLoad(from, settings), load)) return {};
    patch.heldNodes = heldNodesUnder(patch, load); // the window's own fingertip may have lain across a slit
    if (isLoose(patch, settings)) return {};
    if (isOnOverhang(patch)) return {}; // which counts as held where it is not what is touched

    if (chartDoubt(patch) > 2 * kMostDoubt) return {}; // already by the dent of the contact before
    FootprintLattice own = lattice;
    own.loads = footprintsAt(patch.window.grid, shape, [&](const ChartPoint& place) { return lies->at(place); });
    fillCurvatureAtContact(patch, used.material(), settings.foundation);
    bendPlate(patch, settings, own, solver, table);
    if (chartDoubt(patch) > kMostDoubt) return {};
    movePoints(patch);
    findStiffness(patch, used, settings, own.loads[own.loads.size() / 2]);
    patch.large.reset();
    patch.linearBecause.clear();
    pressDeeper(patch, settings, solver, true);
    return patch;
}

} // namespace palp
