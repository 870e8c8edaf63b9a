#include "engine/tools/render/patch_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/plate/load.h"

namespace palp {
namespace {

/// A point of the patch near the window's edge.
struct Near {
    ChartPoint at;       ///< [m]
    glm::dvec3 residual; ///< from the fitted sphere to the surface [m]
    double     height;   ///< of the residual along the normal [m]
};

constexpr double kFar = 4; ///< spacings beyond which there is no surface [1]

/// Returns whether a place is within a distance of the sides of the window, or, where the window spans the object, of
/// its border.
bool isNearEdge(const Patch& patch, const ChartPoint& p, double far)
{
    const PlateGrid& grid = patch.window.grid;
    const double     x = p.x - patch.window.corner.x, z = p.z - patch.window.corner.z;
    if (patch.covered.values().empty()) {
        const double beyondX = std::min(x, grid.sizeX() - x), beyondZ = std::min(z, grid.sizeZ() - z);
        return !(std::min(beyondX, beyondZ) < -far || std::min(std::abs(beyondX), std::abs(beyondZ)) > far);
    }
    const auto covered = [&](double u, double v) {
        return interpolate(grid, patch.covered, std::clamp(u, 0.0, grid.sizeX()), std::clamp(v, 0.0, grid.sizeZ()));
    };
    return std::min({covered(x - far, z), covered(x + far, z), covered(x, z - far), covered(x, z + far)}) < 1;
}

std::vector<Near> alongEdge(const Patch& patch, std::span<const glm::dvec3> positions)
{
    const double      far = kFar * patch.spacing;
    std::vector<Near> near;
    const glm::dvec3& normal = patch.chart.frame.normal;
    for (std::size_t n = 0; n < patch.positions.size(); ++n) {
        const ChartPoint& p = patch.positions[n];
        if (!isNearEdge(patch, p, far)) continue;
        if (const auto on = patch.chart.lift(p)) {
            const glm::dvec3 residual = positions[patch.points[n]] - *on;
            near.push_back({p, residual, glm::dot(residual, normal)});
        }
    }
    return near;
}

/// How far the surface lies from the fitted sphere at a place of the chart: the mean over the nearest points of the
/// sheet on top. Empty where there is no surface.
std::optional<glm::dvec3> residualAt(const std::vector<Near>& points, const ChartPoint& at, double spacing)
{
    constexpr std::size_t kMost  = 16; // points examined
    constexpr double      kSheet = 1;  // spacings below the highest that are still the same sheet [1]
    std::array<std::pair<double, const Near*>, kMost> near;
    near.fill({std::numeric_limits<double>::infinity(), nullptr});
    for (const Near& point : points) {
        const double x = point.at.x - at.x, z = point.at.z - at.z, square = x * x + z * z;
        if (square >= near.back().first) continue;
        std::size_t place = kMost - 1;
        for (; place > 0 && near[place - 1].first > square; --place) near[place] = near[place - 1];
        near[place] = {square, &point};
    }
    if (!(near.back().first < kFar * kFar * spacing * spacing)) return std::nullopt;
    double highest = -std::numeric_limits<double>::infinity(); // [m]
    for (const auto& [square, point] : near) highest = std::max(highest, point->height);
    glm::dvec3 sum(0);
    double     count = 0;
    for (const auto& [square, point] : near)
        if (point->height >= highest - kSheet * spacing) {
            sum += point->residual;
            ++count;
        }
    return sum / count;
}

/// The border of an object that the window spans: in each cell where the covered share passes a half, the line between
/// two of its sides.
std::vector<PatchSurface::EdgePlace> borderOf(const Patch& patch, std::span<const glm::dvec3> positions)
{
    const PlateGrid&                     grid   = patch.window.grid;
    const auto                           points = alongEdge(patch, positions);
    std::vector<PatchSurface::EdgePlace> places;
    const auto                           add = [&](const ChartPoint& inGrid, bool starts) {
        const ChartPoint at{patch.window.corner.x + inGrid.x, patch.window.corner.z + inGrid.z};
        const auto       on = patch.chart.lift(at), off = residualAt(points, at, patch.spacing);
        if (!on || !off) return false;
        places.push_back({*on + *off, interpolate(grid, patch.response, inGrid.x, inGrid.z), starts});
        return true;
    };
    for (int i = 0; i < grid.cellsX; ++i)
        for (int j = 0; j < grid.cellsZ; ++j) {
            constexpr std::array<std::array<int, 2>, 5> kCorners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
            std::vector<ChartPoint>                     crossings;
            for (std::size_t k = 0; k < 4; ++k) {
                const auto [a, b] = kCorners[k];
                const auto [c, d] = kCorners[k + 1];
                const double from = patch.covered(i + a, j + b) - 0.5, to = patch.covered(i + c, j + d) - 0.5;
                if ((from < 0) == (to < 0)) continue;
                const double t = from / (from - to);
                crossings.push_back({(i + a + t * (c - a)) * grid.spacingX, (j + b + t * (d - b)) * grid.spacingZ});
            }
            for (std::size_t k = 0; k + 1 < crossings.size(); k += 2)
                if (add(crossings[k], true) && !add(crossings[k + 1], false)) places.pop_back();
        }
    return places;
}

/// Once around the window's edge; parts where there is no surface are left out.
std::vector<PatchSurface::EdgePlace> edgeOf(const Patch& patch, std::span<const glm::dvec3> positions)
{
    if (!patch.covered.values().empty()) return borderOf(patch, positions);
    constexpr int                        kSteps = 48; // on a side
    const PlateGrid&                     grid   = patch.window.grid;
    const double                         width = grid.sizeX(), height = grid.sizeZ();
    const ChartPoint                     corner = patch.window.corner;
    const auto                           points = alongEdge(patch, positions);
    std::vector<PatchSurface::EdgePlace> places;
    bool                                 starts = true;
    for (int n = 0; n <= 4 * kSteps; ++n) {
        const int        side = n / kSteps % 4;
        const double     t    = double(n % kSteps) / kSteps;
        const double     x    = width * (side == 0 ? t : side == 1 ? 1 : side == 2 ? 1 - t : 0);
        const double     z    = height * (side == 0 ? 0 : side == 1 ? t : side == 2 ? 1 : 1 - t);
        const ChartPoint at{corner.x + x, corner.z + z};
        const auto       on = patch.chart.lift(at), off = residualAt(points, at, patch.spacing);
        if (on && off) places.push_back({*on + *off, interpolate(grid, patch.response, x, z), starts});
        starts = !(on && off);
    }
    return places;
}

/// Mean rise of the surroundings over a dent's place, as view_light.frag has it for what one sees.
class Hollows {
public:
    explicit Hollows(const Patch& patch, double radius) : grid_(patch.window.grid), response_(patch.response)
    {
        constexpr int    kTaps = 8, kMostNodes = 25; // of a spiral; along a side: the cue is smooth [1]
        constexpr double kWider = 3.5;               // a second look finds dents that are wide and shallow [1]
        const double     turn   = std::numbers::pi * (3 - std::sqrt(5.0));
        for (const double reach : {radius, kWider * radius})
            for (int n = 0; n < kTaps; ++n) {
                const double distance = reach * std::sqrt((n + 0.5) / kTaps);
                taps_.push_back({distance * std::cos(n * turn), distance * std::sin(n * turn),
                                 1 / (kTaps * (distance + 0.1 * reach))});
            }
        const int cells = std::min(grid_.cellsX, kMostNodes - 1);
        coarse_         = {cells, cells, grid_.sizeX() / cells, grid_.sizeZ() / cells};
        field_          = NodeField(coarse_);
        for (int i = 0; i < coarse_.nodesX(); ++i)
            for (int j = 0; j < coarse_.nodesZ(); ++j) field_(i, j) = at(i * coarse_.spacingX, j * coarse_.spacingZ);
    }
    /// \param x, z  from the window's corner, in the window [m]
    /// \return [1/N]
    [[nodiscard]] double of(double x, double z) const { return interpolate(coarse_, field_, x, z); }

private:
    struct Tap {
        double x, z, weight; // [m], [m], [1/m]
    };
    [[nodiscard]] double at(double x, double z) const
    {
        const double own = interpolate(grid_, response_, x, z);
        double       sum = 0;
        for (const Tap& tap : taps_)
            sum += tap.weight * (own - interpolate(grid_, response_, std::clamp(x + tap.x, 0.0, grid_.sizeX()),
                                                   std::clamp(z + tap.z, 0.0, grid_.sizeZ())));
        return sum;
    }

    const PlateGrid& grid_;
    const NodeField& response_;
    std::vector<Tap> taps_;
    PlateGrid        coarse_;
    NodeField        field_;
};

} // namespace

PatchSurface::PatchSurface(const Patch& patch, std::span<const glm::dvec3> positions, double cueRadius)
    : edge(edgeOf(patch, patch.coarse ? patch.coarse->object().positions() : positions)),
      mostResponse(palp::mostResponse(patch)), inward(patch.forceDirection())
{
    // Of the largest response: below the first nothing shows, below the second no slope.
    constexpr double kNotable = 1e-3, kSlopes = 1e-2; // [1]
    const Hollows    hollowness(patch, cueRadius);
    const auto       add = [&](double least, double most) {
        eachMoving(patch, positions, [&](std::uint32_t point, const ChartPoint& place, double response) {
            const double size = std::abs(response);
            if (!(size > least * mostResponse && size <= most * mostResponse)) return;
            moving.push_back(point);
            responses.push_back(response);
            hollows.push_back(hollowness.of(place.x - patch.window.corner.x, place.z - patch.window.corner.z));
        });
    };
    add(kSlopes, std::numeric_limits<double>::infinity());
    sloping = moving.size();
    add(kNotable, kSlopes);
}

} // namespace palp
