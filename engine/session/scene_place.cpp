#include "engine/session/scene_place.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/cloud/local_spacing.h"
#include "engine/cloud/neighbour_index.h"

namespace palp {
namespace {

/// Points within three spacings that a point of a surface has at least, itself among them: 28 of a sheet, 7 at a
/// corner.
constexpr std::size_t kCompany = 5;
constexpr double      kReach   = 3; // [spacings]

/// Returns the highest point that is no stray [m]; the highest of all where there is none.
glm::dvec3 highestOfSurface(std::span<const glm::dvec3> positions)
{
    std::vector<std::uint32_t> order(positions.size()); // from the top
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t point) { return -positions[point].z; });
    const NeighbourIndex index(positions);
    if (!(index.spacing() > 0)) return positions[order.front()];
    const std::vector<double> spacings = localSpacings(index);
    for (const std::uint32_t point : order)
        if (index.gather(positions[point], kReach * spacings[point]).size() >= kCompany) return positions[point];
    return positions[order.front()];
}

/// What a coordinate spans but for the outermost points, among which strays are [m].
struct Extent {
    double low = 0, high = 0;

    [[nodiscard]] double width() const { return high - low; }
    [[nodiscard]] double middle() const { return (low + high) / 2; }
};

Extent extentOf(std::span<const glm::dvec3> positions, int axis)
{
    constexpr double    kOutermost = 0.005; // of the points, at either end [1]
    std::vector<double> values;
    for (const glm::dvec3& p : positions) values.push_back(p[axis]);
    const auto skipped = std::ptrdiff_t(kOutermost * double(values.size()));
    const auto low = values.begin() + skipped, high = values.end() - 1 - skipped;
    std::nth_element(values.begin(), low, values.end());
    if (high > low) std::nth_element(low + 1, high, values.end());
    return {*low, *high};
}

/// Returns the point of the largest z; of a flat top, or a level ridge, the one in its middle. There the largest z is
/// noise, or all points have it, and the first may lie in a corner, or at an end.
glm::dvec3 highestOf(const PointCloud& cloud)
{
    constexpr double kFlat     = 0.9; // of the cloud's width, one way, is within a spacing of the largest z [1]
    const auto       positions = cloud.positions();
    const Extent     x = extentOf(positions, 0), y = extentOf(positions, 1);
    const double     spacing = std::sqrt(x.width() * y.width() / double(cloud.size())); // [m] of a flat cloud
    glm::dvec3       highest = *std::ranges::max_element(positions, {}, [](const glm::dvec3& p) { return p.z; });
    const auto       beside  = std::ranges::count_if(
               positions, [&](const glm::dvec3& p) { return glm::distance(p, highest) <= kReach * spacing; });
    if (std::size_t(beside) < kCompany) highest = highestOfSurface(positions);

    const auto aside = [&](const glm::dvec3& p) {
        return glm::length(glm::dvec2(p) - glm::dvec2(x.middle(), y.middle()));
    };
    glm::dvec3 low = highest, high = highest, inside = highest;
    for (const glm::dvec3& p : positions) {
        if (p.z < highest.z - spacing || p.z > highest.z) continue;
        low  = glm::min(low, p);
        high = glm::max(high, p);
        if (aside(p) < aside(inside)) inside = p;
    }
    const bool levelX = high.x - low.x >= kFlat * x.width(), levelY = high.y - low.y >= kFlat * y.width();
    if (levelX && levelY) return inside;
    if (!levelX && !levelY) return highest;
    const double along  = levelX ? x.middle() : y.middle(); // of a ridge
    const auto   fromIt = [&](const glm::dvec3& p) { return std::abs((levelX ? p.x : p.y) - along); };
    glm::dvec3   top    = inside;
    for (const glm::dvec3& p : positions) {
        if (fromIt(p) > kReach * spacing || p.z > highest.z) continue;
        if (p.z > top.z || (p.z == top.z && fromIt(p) < fromIt(top))) top = p;
    }
    return top;
}

} // namespace

glm::dvec3 placeOf(const Scene& scene, const PointCloud& cloud)
{
    return scene.place ? *scene.place : highestOf(cloud);
}

} // namespace palp
