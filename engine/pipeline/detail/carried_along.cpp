#include "engine/pipeline/detail/carried_along.h"

#include <cmath>
#include <cstddef>
#include <optional>

#include <glm/geometric.hpp>

namespace palp {
namespace {

/// Returns the place of the touched face that lies straight over a point; empty if it is too far off to be its sheet's.
std::optional<ChartPoint> placeOver(const Patch& patch, const glm::dvec3& point)
{
    constexpr double kMost = 2.5; // [thicknesses], as onOtherFace() has it
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

void carryAlong(Patch& patch, const SoftObject& object, std::span<const glm::dvec3> normals)
{
    for (std::size_t k = 0; k < normals.size(); ++k)
        if (glm::dot(normals[k], patch.chart.frame.normal) < 0)
            if (const auto over = placeOver(patch, object.positions()[patch.points[k]])) patch.positions[k] = *over;

    const PlateEdges& edges = patch.plate.edges;
    for (ChartPoint& p : patch.positions) {
        if (patch.window.holds(p)) continue;
        const ChartPoint inside = patch.window.nearest(p);
        if (hangsOver(p.x, inside.x, edges.x0, edges.x1, patch.thickness)) p.x = inside.x;
        if (hangsOver(p.z, inside.z, edges.z0, edges.z1, patch.thickness)) p.z = inside.z;
    }
}

} // namespace palp
