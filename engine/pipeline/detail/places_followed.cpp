#include "engine/pipeline/detail/places_followed.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include <glm/geometric.hpp>

namespace palp {
namespace {

/// Returns the place of the fitted surface straight over a point; empty if that is too far off to be the sheet's other
/// face.
std::optional<ChartPoint> placeOver(const Patch& patch, const glm::dvec3& point)
{
    constexpr double kMost = 2.5; // [thicknesses]: faces that bulge apart, and what the surface lies off its fit
    const auto       place = patch.chart.project(point);
    if (!place || !patch.window.holds(*place)) return {};
    const auto over = patch.chart.lift(*place);
    if (!over || glm::length(*over - point) > kMost * patch.thickness) return {};
    return place;
}

/// Returns whether a point may move along one axis onto the window: it hangs over a free side by `most` [m] or less.
bool hangsOver(double at, double inside, Edge low, Edge high, double most)
{
    return std::abs(at - inside) <= most && (at < inside ? low : high) == Edge::free;
}

} // namespace

std::vector<ChartPoint> placesFollowed(const Patch& patch, const SoftObject& object,
                                       std::span<const glm::dvec3> normals)
{
    constexpr double kAway = -0.5; // cosine of 120 degrees: not the walls of a box, nor the faces beside a rim [1]
    std::vector<ChartPoint> places = patch.positions;
    for (std::size_t k = 0; k < normals.size(); ++k)
        if (glm::dot(normals[k], patch.chart.frame.normal) < kAway)
            if (const auto over = placeOver(patch, object.positions()[patch.points[k]])) places[k] = *over;

    const PlateEdges& edges = patch.plate.edges;
    for (ChartPoint& p : places) {
        if (patch.window.holds(p)) continue;
        const ChartPoint inside = patch.window.nearest(p);
        if (hangsOver(p.x, inside.x, edges.x0, edges.x1, patch.thickness)) p.x = inside.x;
        if (hangsOver(p.z, inside.z, edges.z0, edges.z1, patch.thickness)) p.z = inside.z;
    }
    return places;
}

} // namespace palp
