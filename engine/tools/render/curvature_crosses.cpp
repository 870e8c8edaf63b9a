#include "engine/tools/render/curvature_crosses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>

namespace palp {
namespace {

constexpr int    kAlong   = 9;    ///< crosses along an edge of the window
constexpr double kLongest = 0.9;  ///< of their distance, so that neighbours do not touch [1]
constexpr double kLeast   = 0.02; ///< of the strongest curvature: a shorter stroke is a dot [1]

/// A place of the lattice, and the point of the cloud that is nearest to it in the chart.
struct Site {
    std::uint32_t point    = 0;
    double        distance = std::numeric_limits<double>::infinity(); ///< of that point [m]
};

/// One principal curvature at a site.
struct Stroke {
    std::uint32_t point = 0;
    double        along = 0; ///< from the chart's x towards its z [rad]
    double        k     = 0; ///< [1/m] > 0 bulges to the finger
};

std::vector<Site> sitesOf(const Patch& patch, std::span<const glm::dvec3> rest)
{
    std::vector<Site> sites(std::size_t(kAlong) * kAlong);
    const PlateGrid&  grid  = patch.window.grid;
    const double      stepX = grid.sizeX() / kAlong, stepZ = grid.sizeZ() / kAlong; // [m]
    eachMoving(patch, rest, [&](std::uint32_t point, const ChartPoint& place, double) {
        if (!patch.window.holds(place)) return;
        const double x = (place.x - patch.window.corner.x) / stepX, z = (place.z - patch.window.corner.z) / stepZ;
        const int    i = std::clamp(int(x), 0, kAlong - 1), j = std::clamp(int(z), 0, kAlong - 1);
        Site&        site     = sites[std::size_t(j) * kAlong + std::size_t(i)];
        const double distance = std::hypot((x - i - 0.5) * stepX, (z - j - 0.5) * stepZ);
        if (distance < site.distance) site = {point, distance};
    });
    return sites;
}

std::array<Stroke, 2> principalAt(const CurvatureField& field, int i, int j, std::uint32_t point)
{
    const double x = field.x(i, j), z = field.z(i, j), xz = field.xz(i, j);
    const double mean = (x + z) / 2, apart = std::hypot((x - z) / 2, xz), along = std::atan2(2 * xz, x - z) / 2;
    return {{{point, along, mean + apart}, {point, along + std::acos(0.0), mean - apart}}};
}

std::vector<Stroke> strokesOf(const Patch& patch, const std::vector<Site>& sites)
{
    std::vector<Stroke> strokes;
    const PlateGrid&    grid = patch.window.grid;
    for (int n = 0; n < kAlong * kAlong; ++n) {
        if (std::isinf(sites[std::size_t(n)].distance)) continue;
        const int i = (2 * (n % kAlong) + 1) * grid.cellsX / (2 * kAlong),
                  j = (2 * (n / kAlong) + 1) * grid.cellsZ / (2 * kAlong);
        for (const Stroke& stroke : principalAt(*patch.curvature, i, j, sites[std::size_t(n)].point))
            strokes.push_back(stroke);
    }
    return strokes;
}

} // namespace

CurvatureCrosses curvatureCrosses(const Patch& patch, std::span<const glm::dvec3> rest,
                                  std::span<const glm::dvec3> positions, std::span<const glm::dvec3> normals)
{
    CurvatureCrosses crosses;
    if (!patch.curvature) return crosses;
    const std::vector<Stroke> strokes = strokesOf(patch, sitesOf(patch, rest));
    double                    most    = 0; // [1/m]
    for (const Stroke& stroke : strokes) most = std::max(most, std::abs(stroke.k));
    const double half = kLongest / 2 * std::min(patch.window.grid.sizeX(), patch.window.grid.sizeZ()) / kAlong; // [m]
    for (const Stroke& stroke : strokes) {
        if (std::abs(stroke.k) <= kLeast * most) continue;
        const glm::dvec3 here   = normals[stroke.point];
        const glm::dvec3 normal = glm::dot(here, patch.chart.frame.normal) < 0 ? -here : here;
        const Frame      axes   = patch.chart.frame.carriedTo(normal);
        const glm::dvec3 reach  = half * std::abs(stroke.k) / most *
                                 (std::cos(stroke.along) * axes.east + std::sin(stroke.along) * axes.north);
        // A hollow rises beside the stroke: its ends would lie below the surface, which hides them.
        const double     sag    = stroke.k < 0 ? -stroke.k * glm::dot(reach, reach) / 2 : 0; // [m]
        const glm::dvec3 middle = positions[stroke.point] + sag * normal;
        (stroke.k > 0 ? crosses.bulging : crosses.hollow).push_back({middle - reach, middle + reach});
    }
    return crosses;
}

} // namespace palp
