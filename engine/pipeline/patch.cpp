#include "engine/pipeline/patch.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <glm/geometric.hpp>

#include "engine/body/body_shell.h"
#include "engine/core/contract.h"
#include "engine/pipeline/dent_length.h"
#include "engine/pipeline/detail/whole_object.h"
#include "engine/pipeline/patch_warnings.h"
#include "engine/plate/load.h"

namespace palp {

bool asksForBody(const PatchSettings& settings) noexcept
{
    constexpr PlateEdges kOfBody{Edge::supported, Edge::supported, Edge::supported, Edge::supported};
    return settings.theory == Theory::shell && settings.windowOf != WindowOf::object &&
           settings.neighbourhood == Neighbourhood::surface && settings.foundation == 0 && settings.edges == kOfBody;
}

bool isCutFromBody(const SoftObject& object, const PatchSettings& settings)
{
    if (settings.outside == Outside::body) return true;
    return !settings.isSettled && asksForBody(settings) && bodyShellOf(object) != nullptr;
}

PlateEdges edgesOfWindow(const PatchSettings& settings) noexcept
{
    return settings.outside == Outside::body ? PlateEdges{} : settings.edges;
}

PatchSettings settledFor(const SoftObject& object, const PatchSettings& settings)
{
    constexpr double kMargin = 1.04, kFinest = 0.25; // lengths to half a side of the window; fingertips to a cell [1]
    constexpr int    kFewest = 256, kMost = 512, kTogether = 16; // cells; a multiple that a multigrid can coarsen
    PatchSettings    settled = settings;
    if (settings.isSettled) return settled;
    settled.isSettled = true;
    if (isCutFromBody(object, settings)) settled.outside = Outside::body;
    if (settings.windowOf == WindowOf::dent) {
        const DentWindow window = dentWindow(object, settings);
        settled.windowOf        = WindowOf::contact;
        settled.window          = window.width;
        settled.cells           = window.cells;
    }
    if (settings.windowOf != WindowOf::object) return settled;
    const Extent extent = object.extent();
    const auto   around = [&](double length) { return 2 * (kMargin * length + 3 * object.spacing()); };
    const double wanted = around(extent.across); // [m]
    const int    finest = std::clamp((settings.cells + kTogether - 1) / kTogether * kTogether, kFewest, kMost);
    const double cell   = std::min(std::max(settings.window / settings.cells, kFinest * settings.footprintRadius),
                                   around(extent.length) / finest);
    const auto   blocks = std::ceil(wanted / cell / kTogether - 1e-9);
    settled.cells       = int(std::clamp(blocks * kTogether, double(kTogether), double(kMost)));
    settled.window      = std::max(wanted, settled.cells * cell);
    settled.edges       = {Edge::free, Edge::free, Edge::free, Edge::free};
    return settled;
}

double bentSize(const SoftObject& object, const PatchSettings& settings)
{
    const PatchSettings now = settledFor(object, settings);
    return now.windowOf == WindowOf::object ? now.window / 2 : now.window;
}

double bentSize(const Patch& patch)
{
    const double side = patch.window.grid.sizeX();
    return patch.covered.values().empty() || patch.isCut ? side : side / 2;
}

const SoftObject& usedOf(const Patch& patch, const SoftObject& object) noexcept
{
    return patch.coarse ? patch.coarse->object() : object;
}

ChartPoint pressedPlace(const Patch& patch) noexcept
{
    return patch.moved ? patch.moved->place : ChartPoint{};
}

const Chart& chartAtContact(const Patch& patch) noexcept
{
    return patch.moved ? patch.moved->chart : patch.chart;
}

GridNode nodeAtContact(const Patch& patch) noexcept
{
    const PlateGrid& grid = patch.window.grid;
    const ChartPoint at   = pressedPlace(patch);
    const auto       node = [](double from, double spacing, int cells) {
        return std::clamp(cells / 2 + int(std::lround(from / spacing)), 0, cells);
    };
    return {node(at.x, grid.spacingX, grid.cellsX), node(at.z, grid.spacingZ, grid.cellsZ)};
}

double bodyFelt(const Patch& patch) noexcept
{
    if (patch.body) return patch.bodyCompliance;
    const PlateEdges& edges = patch.plate.edges;
    for (const Edge edge : {edges.x0, edges.x1, edges.z0, edges.z1})
        if (edge != Edge::supported) return 0;
    return patch.bodyCompliance;
}

double mostResponse(const Patch& patch)
{
    double most = 0;
    for (std::size_t n = 0; n < patch.response.values().size(); ++n)
        if (isOnSheet(patch, n)) most = std::max(most, patch.response.values()[n]);
    return most;
}

bool isOnSheet(const NodeField& covered, std::size_t node)
{
    return covered.values().empty() || covered.values()[node] > 0.5;
}

bool isOnSheet(const Patch& patch, std::size_t node)
{
    return isOnSheet(patch.covered, node);
}

NodeField sheetRigidity(const Patch& patch)
{
    NodeField sheet = patch.plate.rigidity;
    for (std::size_t n = 0; n < patch.covered.values().size(); ++n) sheet.values()[n] = sheetRigidity(patch, n);
    return sheet;
}

double rigidityAtContact(const Patch& patch)
{
    const auto [i, j] = nodeAtContact(patch);
    return sheetRigidity(patch, std::size_t(i * patch.plate.grid.nodesZ() + j));
}

std::pair<double, double> rigiditiesOfSheet(const Patch& patch)
{
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (std::size_t n = 0; n < patch.plate.grid.nodes(); ++n) {
        if (!isOnSheet(patch, n)) continue;
        const double own = sheetRigidity(patch, n);
        least            = std::min(least, own);
        most             = std::max(most, own);
    }
    return {least, most};
}

std::size_t nodesOfSheet(const Patch& patch)
{
    std::size_t count = 0;
    for (std::size_t n = 0; n < patch.plate.grid.nodes(); ++n) count += isOnSheet(patch, n);
    return count;
}

std::string placeText(const Contact& contact)
{
    char       text[96];
    const auto tidy = [](double place) { return std::abs(place) < 1e-9 ? 0 : place; }; // rounding is no place [m]
    std::snprintf(text, sizeof text, "at (%.4g, %.4g, %.4g) m", tidy(contact.point.x), tidy(contact.point.y),
                  tidy(contact.point.z));
    return text;
}

void demandDeformed(const Patch& patch, const char* hint)
{
    if (patch.deformed()) return;
    throw Error(placeText(patch.contact) + ": the " + std::to_string(patch.gathered.size()) +
                " points nearby do not determine a surface (" + name(patch.sphere.outcome) + "); " + hint);
}

void demandConverged(const Patch& patch)
{
    if (patch.report.converged) return;
    throw Error(placeText(patch.contact) + ": " + unconvergedText(patch));
}

void demandUsable(const Patch& patch)
{
    constexpr double kUseless = 0.1; // of the answer: as much as the theory is off where `touch` warns of it [1]
    if (!(patch.report.errorEstimate.value_or(1) < kUseless)) demandConverged(patch); // NaN is refused too
}

std::string directionText(const glm::dvec3& direction)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.2f,%.2f,%.2f", direction.x, direction.y, direction.z);
    return text;
}

double responseAt(const Patch& patch, const ChartPoint& place)
{
    const ChartPoint& corner = patch.window.corner;
    return patch.window.holds(place)
               ? interpolate(patch.window.grid, patch.response, place.x - corner.x, place.z - corner.z)
               : 0;
}

std::vector<double> responsesAt(const Patch& patch, std::span<const ChartPoint> places)
{
    const PlateGrid     grid   = patch.window.grid;
    const ChartPoint    corner = patch.window.corner;
    const ChartPoint    last{corner.x + grid.sizeX(), corner.z + grid.sizeZ()}; // as PatchWindow::holds() has it
    const double        perX = 1 / grid.spacingX, perZ = 1 / grid.spacingZ;
    const std::size_t   stride = std::size_t(grid.nodesZ());
    const double* const field  = patch.response.values().data();
    std::vector<double> responses(places.size());
    for (std::size_t n = 0; n < places.size(); ++n) {
        const double x = places[n].x - corner.x, z = places[n].z - corner.z;
        if (!(x >= 0 && places[n].x <= last.x && z >= 0 && places[n].z <= last.z)) continue;
        const int     i = std::min(int(x * perX), grid.cellsX - 1), j = std::min(int(z * perZ), grid.cellsZ - 1);
        const double  u = x * perX - i, v = z * perZ - j; // [spacings]
        const double* w    = field + std::size_t(i) * stride + std::size_t(j);
        const double  near = w[0] + v * (w[1] - w[0]), far = w[stride] + v * (w[stride + 1] - w[stride]);
        responses[n] = near + u * (far - near);
    }
    return responses;
}

void eachMoving(const Patch& patch, std::span<const glm::dvec3> positions,
                const std::function<void(std::uint32_t, const ChartPoint&, double)>& visit)
{
    for (std::size_t n = 0; n < patch.points.size(); ++n) {
        if (!patch.coarse) {
            visit(patch.points[n], patch.followed[n], patch.pointResponse[n]);
            continue;
        }
        // A point lies beside its coarse one in the chart as it does on the surface, seen along the chart's normal:
        // they are at most a cell apart.
        const glm::dvec3 middle = patch.coarse->object().positions()[patch.points[n]];
        const ChartPoint at     = patch.followed[n];
        const bool       inside = patch.window.holds(at);
        for (const std::uint32_t member : patch.coarse->membersOf(patch.points[n])) {
            const glm::dvec3 d = positions[member] - middle;
            ChartPoint place{at.x + glm::dot(d, patch.chart.frame.east), at.z + glm::dot(d, patch.chart.frame.north)};
            if (inside) place = patch.window.nearest(place); // a free edge takes along what its coarse point is among
            visit(member, place, responseAt(patch, place));
        }
    }
}

std::vector<double> deflections(const PointCloud& cloud, const Patch& patch, double force)
{
    std::vector<double> result(cloud.size(), 0.0);
    eachMoving(patch, cloud.positions(),
               [&](std::uint32_t point, const ChartPoint&, double response) { result[point] = force * response; });
    return result;
}

std::vector<glm::dvec3> displaced(const PointCloud& cloud, const Patch& patch, double force)
{
    std::vector<glm::dvec3> result(cloud.positions().begin(), cloud.positions().end());
    eachMoving(patch, cloud.positions(), [&](std::uint32_t point, const ChartPoint&, double response) {
        result[point] += force * response * patch.forceDirection();
    });
    return result;
}

} // namespace palp
