#include "engine/chart/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp {
namespace {

// Largest angle beyond the rim of the hemisphere that counts as rounding [rad]: keeps the rim itself in the chart, and
// lift(project(rim)) too. The maps go on smoothly there, so nothing depends on its size.
constexpr double kRim = 1e-12;

// Below this argument [rad] the series are exact to rounding: the first term omitted is t^6/7 = 1.4e-19.
constexpr double kSeries = 1e-3;

// Between normals whose sum is shorter than this [1] (turned by all but 1e-6 rad of a half turn) the shortest arc is a
// matter of rounding: the direction of the sum has fewer than ten digits left.
constexpr double kOpposite = 1e-6;

double sinc(double t)
{
    return std::abs(t) < kSeries ? 1 - t * t / 6 * (1 - t * t / 20) : std::sin(t) / t;
}

/// Returns atan2(curvature y, x) / curvature for x >= 0, also when the curvature is 0.
double arcOf(double curvature, double y, double x)
{
    const double angle = curvature * y;
    if (std::abs(angle) >= kSeries * x) return std::atan2(angle, x) / curvature;
    const double squared = angle / x * (angle / x);
    return y / x * (1 - squared * (1.0 / 3 - squared / 5));
}

void expectUnit(const glm::dvec3& normal)
{
    constexpr double kTolerance = 1e-6; // [1] of the squared length: callers may have rounded to single precision
    PALP_EXPECT(std::abs(glm::dot(normal, normal) - 1) < kTolerance,
                "the normal has length " + std::to_string(glm::length(normal)) + ", not 1");
}

} // namespace

Frame Frame::about(const glm::dvec3& normal)
{
    return Frame{}.carriedTo(normal);
}

Frame Frame::carriedTo(const glm::dvec3& newNormal) const
{
    expectUnit(newNormal);
    // The shortest rotation from n to m is a reflection in the plane across n, which leaves east and north alone, then
    // one in the plane across n + m. The sum, unlike 1 + n.m, keeps its digits when m is nearly -n.
    const glm::dvec3 sum    = normal + newNormal;
    const glm::dvec3 across = glm::length(sum) > kOpposite ? glm::normalize(sum) : north;

    Frame carried;
    carried.normal           = glm::normalize(newNormal);
    const glm::dvec3 newEast = east - 2 * glm::dot(across, east) * across;
    // Made square again, so that rounding does not build up over many steps.
    carried.east  = glm::normalize(newEast - glm::dot(carried.normal, newEast) * carried.normal);
    carried.north = glm::cross(carried.normal, carried.east);
    return carried;
}

Frame Frame::turned(double angle) const
{
    const double c = std::cos(angle), s = std::sin(angle);
    return {normal, c * east + s * north, c * north - s * east};
}

Chart Chart::around(const SphereFit& fit, const glm::dvec3& contact, const glm::dvec3& outward, Map map,
                    const std::optional<Frame>& frame)
{
    const double length = glm::length(outward);
    PALP_EXPECT(std::isfinite(length) && length > 0, "outward has length " + std::to_string(length) + ", not > 0");

    const glm::dvec3 away = fit.normal(contact);
    const double     side = glm::dot(away, outward) < 0 ? -1 : 1;
    return {map, fit.foot(contact), frame ? frame->carriedTo(side * away) : Frame::about(side * away),
            side * fit.curvature};
}

std::optional<ChartPoint> Chart::project(const glm::dvec3& point) const
{
    // With the distance d of the point from the centre and q = point - origin in the frame's axes:
    // up = cos beta cos alpha d/r, stretch = d/r, both finite on the plane (1 and 1).
    const glm::dvec3 q       = point - origin;
    const double     east    = glm::dot(q, frame.east);
    const double     north   = glm::dot(q, frame.north);
    const double     up      = 1 + curvature * glm::dot(q, frame.normal);
    const double     stretch = std::sqrt(up * up + curvature * curvature * (east * east + north * north));
    if (!(up >= -kRim * stretch) || stretch == 0) return {}; // the centre itself has no direction

    if (map == Map::lambertAzimuthal) {
        // (east, north) / stretch has length r sin theta; the map wants 2 r sin(theta/2) = r sin theta / cos(theta/2).
        const double scale = std::sqrt(2 / (stretch * (stretch + up)));
        return ChartPoint{scale * east, scale * north};
    }
    const ChartPoint cylindrical{arcOf(curvature, east, up), north / stretch};
    if (map == Map::lambertCylindrical) return cylindrical;
    return ChartPoint{cylindrical.x / std::numbers::sqrt2, cylindrical.z * std::numbers::sqrt2};
}

void Chart::project(std::span<const glm::dvec3> points, std::span<ChartPoint> positions,
                    std::span<std::uint8_t> on) const
{
    PALP_EXPECT(positions.size() == points.size() && on.size() == points.size(), "room for every point");
    if (map != Map::lambertAzimuthal) {
        for (std::size_t n = 0; n < points.size(); ++n) {
            const auto position = project(points[n]);
            on[n]               = position.has_value();
            if (position) positions[n] = *position;
        }
        return;
    }
    // The formulas of the single point, with neither calls nor branches, so that they become vector instructions.
    const glm::dvec3 o = origin, e = frame.east, n = frame.north, u = frame.normal;
    const double     c = curvature, c2 = curvature * curvature;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const double x = points[k].x - o.x, y = points[k].y - o.y, z = points[k].z - o.z;
        const double east    = x * e.x + y * e.y + z * e.z;
        const double north   = x * n.x + y * n.y + z * n.z;
        const double up      = 1 + c * (x * u.x + y * u.y + z * u.z);
        const double stretch = std::sqrt(up * up + c2 * (east * east + north * north));
        const double scale   = std::sqrt(2 / (stretch * (stretch + up)));
        positions[k]         = {scale * east, scale * north};
        on[k]                = std::uint8_t((up >= -kRim * stretch) & (stretch != 0));
    }
}

std::optional<glm::dvec3> Chart::lift(const ChartPoint& position) const
{
    double x = position.x, z = position.z;
    if (map == Map::lambertAzimuthal) {
        const double squared   = x * x + z * z;
        const double halfSine2 = curvature * curvature * squared / 4; // sin^2(theta/2)
        if (!(halfSine2 <= 0.5 + kRim)) return {};
        const double halfCosine = std::sqrt(1 - halfSine2);
        return origin + halfCosine * (x * frame.east + z * frame.north) - 0.5 * curvature * squared * frame.normal;
    }
    if (map == Map::gallPeters) {
        x *= std::numbers::sqrt2;
        z /= std::numbers::sqrt2;
    }
    const double longitude = curvature * x, sineLatitude = curvature * z;
    if (!(std::abs(longitude) <= std::numbers::pi / 2 + kRim && std::abs(sineLatitude) <= 1 + kRim)) return {};

    const double cosineLatitude = std::sqrt(std::max(0.0, 1 - sineLatitude * sineLatitude));
    const double halfSinc       = sinc(longitude / 2);
    // Depth below the tangent plane, (1 - cos beta cos alpha) / curvature without the difference.
    const double depth =
        curvature * (z * z / (1 + cosineLatitude) + 0.5 * cosineLatitude * x * x * halfSinc * halfSinc);
    return origin + cosineLatitude * x * sinc(longitude) * frame.east + z * frame.north - depth * frame.normal;
}

} // namespace palp
