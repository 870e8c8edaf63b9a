#include "engine/pipeline/detail/other_face.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "engine/chart/exponential_map.h"
#include "engine/cloud/point_grid.h"

namespace palp {
namespace {

/// Returns how far along the surface the points are that lie straight behind one and face the other way [m], their
/// mean; empty if there are none.
std::optional<double> wayBehind(const TouchedSurface& surface, const PointGrid& grid, const std::vector<double>& ways,
                                std::size_t point, double radius, double deepest)
{
    constexpr double kOpposed = -0.5; // cosine of 120 degrees: the faces of a wedge of 60 degrees are two [1]
    const glm::dvec3 place = surface.place(point), normal = surface.normalAt(point);
    double           sum = 0, count = 0;
    const auto       look = [&](std::size_t k, const glm::dvec3& behind) {
        const glm::dvec3 d = surface.place(k) - behind;
        if (!std::isfinite(ways[k]) || glm::dot(d, d) > radius * radius) return;
        if (glm::dot(surface.normalAt(k), normal) > kOpposed) return;
        sum += ways[k];
        ++count;
    };
    for (double depth = radius; count == 0 && depth < deepest + radius; depth += radius) {
        const glm::dvec3 behind = place - depth * normal;
        grid.around(behind, radius, [&](std::size_t k, double) { look(k, behind); });
    }
    if (count == 0) return {};
    return sum / count;
}

enum class Face { unknown, touched, other };

/// Returns whether most of the points around that face as one does, and whose face is known, are on the other face: of
/// a few points chance, or the rim, leaves none straight behind.
bool isAmongOthers(const TouchedSurface& surface, const PointGrid& grid, const std::vector<Face>& faces,
                   std::size_t point, double radius)
{
    constexpr double kAlike = 0.5; // cosine of 60 degrees [1]
    int              more   = 0;
    grid.around(surface.place(point), radius, [&](std::size_t k, double distance2) {
        if (distance2 > radius * radius || faces[k] == Face::unknown) return;
        if (glm::dot(surface.normalAt(k), surface.normalAt(point)) < kAlike) return;
        more += faces[k] == Face::other ? 1 : -1;
    });
    return more > 0;
}

} // namespace

std::vector<bool> onOtherFace(const TouchedSurface& surface, const std::vector<std::optional<ChartPoint>>& places,
                              const glm::dvec3& outward, double thickness)
{
    constexpr double        kMost = 2.5, kNear = 1.5, kAlike = 4; // [thicknesses], [spacings], [spacings]
    constexpr int           kMostAlong = 128;                     // cubes: a sheet is a few of them thick
    std::vector<double>     ways(surface.size(), kEverywhere);
    std::vector<glm::dvec3> all(surface.size());
    for (std::size_t k = 0; k < surface.size(); ++k) {
        all[k] = surface.place(k);
        if (places[k]) ways[k] = std::hypot(places[k]->x, places[k]->z);
    }
    if (all.empty()) return {};
    PointGrid grid;
    grid.build(all, kNear * surface.spacing, kMostAlong);
    std::vector<Face> faces(surface.size(), Face::unknown);
    for (std::size_t k = 0; k < surface.size(); ++k) {
        const auto behind = wayBehind(surface, grid, ways, k, kNear * surface.spacing, kMost * thickness);
        if (!places[k] || !behind) continue;
        const double farther = ways[k] - *behind; // [m]
        const bool   isOther =
            std::abs(farther) > kAlike * surface.spacing ? farther > 0 : glm::dot(surface.normalAt(k), outward) < 0;
        faces[k] = isOther ? Face::other : Face::touched;
    }
    std::vector<bool> other(surface.size());
    for (std::size_t k = 0; k < surface.size(); ++k)
        other[k] = faces[k] == Face::other ||
                   (faces[k] == Face::unknown && isAmongOthers(surface, grid, faces, k, 2 * kNear * surface.spacing));
    return other;
}

} // namespace palp
