#include "engine/tools/render/view_shapes.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

namespace palp {
namespace {

using Corners = std::vector<ShapeCorner>;

constexpr int    kAround = 24; ///< sides of round shapes
constexpr int    kThin   = 6;  ///< sides of lines, too thin to show them
constexpr double kTurn   = 2 * std::numbers::pi;

/// A point of a body of revolution, seen along its axis, and the normal there.
struct Ring {
    double along = 0, radius = 0;              // [m]
    double normalAlong = 0, normalOutward = 1; // [1]
};

/// Returns two unit vectors perpendicular to a unit vector and to each other.
struct Axes {
    explicit Axes(const glm::dvec3& axis)
        : along(axis),
          u(glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)))),
          v(glm::cross(axis, u))
    {
    }
    glm::dvec3 along, u, v;
};

/// The surface between two rings about an axis through `foot`.
void addBelt(Corners& corners, const glm::dvec3& foot, const Axes& axes, const Ring& low, const Ring& high, Rgb8 colour,
             int sides = kAround)
{
    const auto corner = [&](const Ring& ring, int n) {
        const double     angle   = kTurn * n / sides;
        const glm::dvec3 outward = std::cos(angle) * axes.u + std::sin(angle) * axes.v;
        return ShapeCorner{foot + ring.along * axes.along + ring.radius * outward,
                           glm::normalize(ring.normalAlong * axes.along + ring.normalOutward * outward), colour};
    };
    for (int n = 0; n < sides; ++n)
        for (const auto& [ring, side] :
             {std::pair{&low, n}, {&low, n + 1}, {&high, n + 1}, {&low, n}, {&high, n + 1}, {&high, n}})
            corners.push_back(corner(*ring, side));
}

void addBall(Corners& corners, const glm::dvec3& centre, double radius, Rgb8 colour)
{
    constexpr int kBelts = 16;
    const Axes    axes(glm::dvec3(0, 0, 1));
    const auto    ring = [&](int n) {
        const double latitude = std::numbers::pi * (double(n) / kBelts - 0.5);
        return Ring{radius * std::sin(latitude), radius * std::cos(latitude), std::sin(latitude), std::cos(latitude)};
    };
    for (int n = 0; n < kBelts; ++n) addBelt(corners, centre, axes, ring(n), ring(n + 1), colour);
}

void addOctahedron(Corners& corners, const glm::dvec3& centre, double radius, Rgb8 colour)
{
    for (int octant = 0; octant < 8; ++octant) {
        const glm::dvec3 sign(octant & 1 ? -1 : 1, octant & 2 ? -1 : 1, octant & 4 ? -1 : 1);
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 tip(0);
            tip[k] = sign[k] * radius;
            corners.push_back({centre + tip, glm::normalize(sign), colour});
        }
    }
}

void addArrow(Corners& corners, const ViewSegment& arrow, double radius, Rgb8 colour)
{
    const double length = glm::distance(arrow.from, arrow.to);
    if (!(length > 0)) return;
    const double headRadius = 2.4 * radius, head = std::min(length, 2.4 * headRadius), shaft = length - head;
    const Axes   axes((arrow.to - arrow.from) / length);
    const Ring   foot{0, 0, -1, 0}, rim{0, radius, -1, 0}, low{0, radius}, high{shaft, radius};
    addBelt(corners, arrow.from, axes, foot, rim, colour);
    addBelt(corners, arrow.from, axes, low, high, colour);
    const Ring under{shaft, radius, -1, 0}, brim{shaft, headRadius, -1, 0};
    const Ring side{shaft, headRadius, headRadius, head}, tip{length, 0, headRadius, head};
    addBelt(corners, arrow.from, axes, under, brim, colour);
    addBelt(corners, arrow.from, axes, side, tip, colour);
}

void addLine(Corners& corners, const ViewSegment& line, double radius, Rgb8 colour)
{
    const double length = glm::distance(line.from, line.to);
    if (length > 0)
        addBelt(corners, line.from, Axes((line.to - line.from) / length), {0, radius}, {length, radius}, colour, kThin);
}

/// A pen, with a ball on its side that shows how it is rolled.
void addStylus(Corners& corners, const ViewStylus& pen, Rgb8 colour)
{
    constexpr double kTip = 4, kButtonAt = 9, kButton = 0.7; // of the radius [1]
    const double     r = pen.radius, tip = std::min(kTip * r, pen.length);
    if (!(r > 0 && pen.length > 0)) return;
    const Axes axes(pen.axis);
    addBelt(corners, pen.tip, axes, {0, 0, -r, tip}, {tip, r, -r, tip}, colour);
    addBelt(corners, pen.tip, axes, {tip, r}, {pen.length, r}, colour);
    addBelt(corners, pen.tip, axes, {pen.length, r, 1, 0}, {pen.length, 0, 1, 0}, colour);
    addBall(corners, pen.tip + std::min(kButtonAt * r, pen.length) * pen.axis + r * pen.side, kButton * r, colour);
}

} // namespace

std::vector<ShapeCorner> shapesOf(const ViewScene& scene)
{
    constexpr double kThinner = 0.45,
                     kHip     = 1.6, // of the force's arrow; of the proxy, whose ball then shows in the faces [1]
        kStroke               = 1.6; // of the outline: short lines have to be seen on any colour [1]
    Corners corners;
    if (scene.proxy) addBall(corners, *scene.proxy, scene.markerRadius, kProxyColour);
    if (scene.hip) addOctahedron(corners, *scene.hip, kHip * scene.markerRadius, kHipColour);
    if (scene.stylus) addStylus(corners, *scene.stylus, kStylusColour);
    if (scene.force) addArrow(corners, *scene.force, scene.arrowRadius, kForceColour);
    if (scene.normal) addArrow(corners, *scene.normal, kThinner * scene.arrowRadius, kNormalColour);
    for (const ViewSegment& line : scene.outline) addLine(corners, line, scene.outlineRadius, inkOn(scene.ground));
    for (const ViewSegment& line : scene.brush) addLine(corners, line, scene.outlineRadius, inkOn(scene.ground));
    for (const ViewSegment& line : scene.sphere) addLine(corners, line, scene.outlineRadius, kSphereColour);
    const std::size_t shining = corners.size();
    for (const ViewSegment& line : scene.bulging) addLine(corners, line, kStroke * scene.outlineRadius, kBulgingColour);
    for (const ViewSegment& line : scene.hollow) addLine(corners, line, kStroke * scene.outlineRadius, kHollowColour);
    for (std::size_t n = shining; n < corners.size(); ++n) corners[n].shinesThrough = false;
    return corners;
}

} // namespace palp
