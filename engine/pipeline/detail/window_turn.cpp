#include "engine/pipeline/detail/window_turn.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/pipeline/detail/curvature_sites.h"

namespace palp {
namespace {

/// A curvature tensor in a chart's axes.
struct BendInChart {
    double x = 0, z = 0, xz = 0; ///< [1/m]
};

/// Returns the radius of the fits, and of the surface about the contact that counts [m]: a dent's, or more where the
/// points are few or noisy.
double radiusFor(const TouchedSurface& surface, const PatchSettings& settings)
{
    constexpr double kDent = 0.125, kMost = 0.25, kSpacings = 5; // of the window [1]; [spacings]
    const double     quiet = quietFitRadius(surface.noise, surface.spacing);
    return std::max(kSpacings * surface.spacing, std::clamp(quiet, kDent * settings.window, kMost * settings.window));
}

/// Returns how the surface bends about the contact; empty where its points determine that nowhere.
std::optional<BendInChart> bendAbout(const Chart& chart, const SoftObject& object, const TouchedSurface& surface,
                                     double radius)
{
    std::vector<std::uint32_t> ranks;
    std::vector<ChartPoint>    places;
    std::vector<glm::dvec3>    normals;
    for (std::size_t k = 0; k < surface.size(); ++k) {
        const glm::dvec3 d = surface.place(k) - chart.origin;
        if (glm::dot(d, d) >= radius * radius) continue;
        ranks.push_back(surface.rank(k));
        places.push_back({glm::dot(d, chart.frame.east), glm::dot(d, chart.frame.north)});
        normals.push_back(surface.normalAt(k));
    }
    const int   rung = int(std::lround(rungOf(radius)));
    BendInChart sum;
    double      all = 0;
    for (const CurvatureSite& site : curvatureSites(object, {ranks, places, normals}, rung, FitsFor::field)) {
        const double     near   = 1 - (site.place.x * site.place.x + site.place.z * site.place.z) / (radius * radius);
        const double     weight = site.share * near * near;
        const glm::dvec3 east = site.here.tensor * chart.frame.east, north = site.here.tensor * chart.frame.north;
        sum.x += weight * glm::dot(chart.frame.east, east);
        sum.z += weight * glm::dot(chart.frame.north, north);
        sum.xz += weight * glm::dot(chart.frame.east, north);
        all += weight;
    }
    if (!(all > 0)) return {};
    return BendInChart{sum.x / all, sum.z / all, sum.xz / all};
}

/// Returns the angle from a principal direction to a side of the window [rad]; empty if it is not to be turned.
std::optional<double> sideFor(const PatchSettings& settings)
{
    const PlateEdges edges = edgesOfWindow(settings);
    const bool       alike = edges.x1 == edges.x0 && edges.z0 == edges.x0 && edges.z1 == edges.x0;
    if (settings.theory != Theory::shell || !alike) return {};
    if (edges.x0 == Edge::supported) return std::numbers::pi / 4; // cut from a larger body
    if (edges.x0 == Edge::clamped) return 0;                      // held across its length, as a tube at its ends
    return {};
}

} // namespace

Frame turnedToBend(const Chart& chart, const SoftObject& object, const TouchedSurface& surface,
                   const PatchSettings& settings)
{
    // Below it the turn of the window changes what is felt by less than 0.3 %, and the directions are those of the
    // noise [1].
    constexpr double kAlike = 0.1;
    const auto       side   = sideFor(settings);
    if (!side) return chart.frame;
    const auto bend = bendAbout(chart, object, surface, radiusFor(surface, settings));
    if (!bend) return chart.frame;
    const double mean = (bend->x + bend->z) / 2, apart = std::hypot((bend->x - bend->z) / 2, bend->xz);
    if (!(apart > kAlike * (std::abs(mean) + apart))) return chart.frame;
    const double principal = std::atan2(2 * bend->xz, bend->x - bend->z) / 2; // [rad] from east
    return chart.frame.turned(std::remainder(principal - *side, std::numbers::pi / 2));
}

} // namespace palp
