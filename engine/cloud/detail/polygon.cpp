#include "engine/cloud/detail/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace palp {
namespace {

/// Most corners of a polygon that is tried: the time grows with the square of their number.
constexpr std::size_t kMostCorners = 256;

/// Area of a triangle of a fan, over that of the polygon, below which it is no more than rounded [1].
constexpr double kRounding = 1e-9;

/// Returns twice the area of a triangle, negative if it is passed clockwise.
double cross(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Returns the corners in a plane, so that the polygon is passed anticlockwise; empty if it has no area.
std::vector<glm::dvec2> flattened(std::span<const glm::dvec3> corners)
{
    glm::dvec3 normal(0);
    for (std::size_t k = 2; k < corners.size(); ++k)
        normal += glm::cross(corners[k - 1] - corners[0], corners[k] - corners[0]);
    const double length = glm::length(normal);
    if (!(length > 0) || !std::isfinite(length)) return {};
    normal /= length;
    const glm::dvec3        helper = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3        east = glm::normalize(glm::cross(helper, normal)), north = glm::cross(normal, east);
    std::vector<glm::dvec2> flat;
    for (const glm::dvec3& corner : corners)
        flat.emplace_back(glm::dot(corner - corners[0], east), glm::dot(corner - corners[0], north));
    return flat;
}

bool fanLiesWithin(std::span<const glm::dvec2> flat)
{
    double all = 0, least = 0;
    for (std::size_t k = 2; k < flat.size(); ++k) {
        const double twice = cross(flat[0], flat[k - 1], flat[k]);
        all += twice;
        least = std::min(least, twice);
    }
    return least >= -kRounding * all;
}

/// Returns whether no other corner lies in the triangle at a place of what is left of the polygon, or on its edge,
/// which would leave a piece without area. The polygon must turn left there.
bool isEar(std::span<const glm::dvec2> flat, std::span<const std::uint32_t> left, std::size_t place)
{
    const std::size_t last = (place + left.size() - 1) % left.size(), next = (place + 1) % left.size();
    const glm::dvec2 &a = flat[left[last]], &b = flat[left[place]], &c = flat[left[next]];
    if (!(cross(a, b, c) > 0)) return false;
    for (std::size_t k = 0; k < left.size(); ++k) {
        if (k == last || k == place || k == next) continue;
        const glm::dvec2& p = flat[left[k]];
        if (p == a || p == b || p == c) continue;
        if (cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0) return false;
    }
    return true;
}

} // namespace

std::optional<std::vector<Triangle>> trianglesOfConcave(std::span<const glm::dvec3> corners)
{
    if (corners.size() < 4 || corners.size() > kMostCorners) return std::nullopt;
    const std::vector<glm::dvec2> flat = flattened(corners);
    if (flat.empty() || fanLiesWithin(flat)) return std::nullopt;
    std::vector<std::uint32_t> left(corners.size());
    std::iota(left.begin(), left.end(), 0U);
    std::vector<Triangle> triangles;
    // An ear that is cut off changes its two neighbours, rarely others, which are asked again only when none is left.
    std::vector<char> isNone(corners.size());
    int               rounds     = 8; // of asking everybody again; real polygons need one or two
    bool              askedAgain = false;
    for (std::size_t place = 0, tried = 0; left.size() > 3;) {
        if (tried == left.size()) {
            if (std::exchange(askedAgain, true) || --rounds == 0) return std::nullopt; // it crosses itself
            std::ranges::fill(isNone, false);
            tried = 0;
        }
        const std::size_t next = (place + 1) % left.size(), last = (place + left.size() - 1) % left.size();
        if (isNone[place] || !isEar(flat, left, place)) {
            isNone[place] = true;
            place         = next;
            ++tried;
            continue;
        }
        triangles.push_back({left[last], left[place], left[next]});
        isNone[last] = isNone[next] = askedAgain = false;
        left.erase(left.begin() + std::ptrdiff_t(place));
        isNone.erase(isNone.begin() + std::ptrdiff_t(place));
        place %= left.size();
        tried = 0;
    }
    triangles.push_back({left[0], left[1], left[2]});
    return triangles;
}

} // namespace palp
