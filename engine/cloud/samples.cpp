#include "engine/cloud/samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"
#include "engine/core/nearest_name.h"
#include "engine/core/uniform.h"

namespace palp {
namespace {

double bump(double dx, double dy, double sigma)
{
    return std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
}

/// Semi-axes of the ellipsoid, 40 000 points on it as in the paper, which states no size [m].
constexpr glm::dvec3 kEllipsoid{60e-3, 45e-3, 35e-3};
constexpr double     kHemisphere = 50e-3;  ///< radius [m]
constexpr double     kSheet      = 150e-3; ///< edge [m]
constexpr double     kPad        = 240e-3; ///< edge [m]: a window of 150 mm stays on it 45 mm around its middle
constexpr double     kSaddle     = 120e-3; ///< edge [m]
constexpr double     kSkin       = 120e-3; ///< edge [m]
constexpr double     kPalm       = 110e-3; ///< edge [m]
/// Semi-axes of the ear lobe: two sheets of skin that meet at the rim [m].
constexpr glm::dvec3 kLobe{14e-3, 18e-3, 1.5e-3};

glm::dvec3 onSphere(Uniform& u)
{
    const double z = u(-1, 1), longitude = u(0, 2 * std::numbers::pi), s = std::sqrt(1 - z * z);
    return {s * std::cos(longitude), s * std::sin(longitude), z};
}

/// Returns a point, uniform per area: the unit sphere's element grows by a b c |(x/a, y/b, z/c)| when it is stretched
/// to the ellipsoid.
glm::dvec3 onEllipsoid(Uniform& u, const glm::dvec3& axes)
{
    const double largest = 1 / std::min({axes.x, axes.y, axes.z});
    for (;;) {
        const glm::dvec3 d = onSphere(u);
        if (u() * largest < glm::length(d / axes)) return d * axes;
    }
}

using Height = double (*)(double x, double y); ///< [m] over [m]

/// Returns a point, uniform per area, on z = height(x, y) over a centred square: keeps one with probability
/// |dA|/(dx dy) / kSteepest.
glm::dvec3 onHeightField(Uniform& u, double edge, Height height)
{
    constexpr double kSteepest = 1.6; // above sqrt(1 + slope^2) of every height field here; their slopes stay below 1.2
    constexpr double kStep     = 1e-6; // of the slopes [m]
    for (;;) {
        const double x = u(-edge / 2, edge / 2), y = u(-edge / 2, edge / 2);
        const double sx = (height(x + kStep, y) - height(x - kStep, y)) / (2 * kStep);
        const double sy = (height(x, y + kStep) - height(x, y - kStep)) / (2 * kStep);
        if (u() * kSteepest < std::sqrt(1 + sx * sx + sy * sy)) return {x, y, height(x, y)};
    }
}

double flat(double, double)
{
    return 0;
}
double saddle(double x, double y)
{
    return (x * x - y * y) / (2 * 80e-3);
}

/// Returns the height of a forearm's gentle curve and a wart 1.5 mm high.
double skin(double x, double y)
{
    return -y * y / (2 * 150e-3) + 1.5e-3 * bump(x, y, 3e-3);
}

/// The hollow of the hand, the thumb's mound, and tendons that stand out by 0.6 mm.
constexpr std::array<double, 4> kTendonSlopes = {-0.28, -0.09, 0.10, 0.29}; // dx/dy, fanning out from the wrist [1]
double                          tendonDistance(double x, double y)
{
    double nearest = 1;
    for (double slope : kTendonSlopes) nearest = std::min(nearest, std::abs(x - slope * (y + 70e-3)));
    return nearest; // [m]
}
constexpr double     kTendonWidth = 2.5e-3;         // standard deviation across a tendon [m]
constexpr glm::dvec3 kThenar{34e-3, -26e-3, 14e-3}; // x, y and standard deviation of the thumb's mound [m]
double               palm(double x, double y)
{
    const double tendon = tendonDistance(x, y) / kTendonWidth;
    return (x * x + y * y) / (2 * 200e-3) + 7e-3 * bump(x - kThenar.x, y - kThenar.y, kThenar.z) +
           0.6e-3 * std::exp(-tendon * tendon / 2);
}

glm::dvec3 onHemisphere(Uniform& u)
{
    glm::dvec3 d = onSphere(u);
    d.z          = std::abs(d.z);
    return kHemisphere * d;
}

double ellipsoidModulus(const glm::dvec3& p)
{
    return 0.3e6 + (3e6 - 0.3e6) * (p.x / kEllipsoid.x + 1) / 2;
}
double sheetModulus(const glm::dvec3&)
{
    return 1.5e6;
}
/// Returns the modulus of a pad with a tendon 8 mm wide, ten times as stiff, along y.
double padModulus(const glm::dvec3& p)
{
    return std::abs(p.x) <= 4e-3 ? 3.5e6 : 0.35e6;
}
double saddleModulus(const glm::dvec3&)
{
    return 1e6;
}
double skinModulus(const glm::dvec3& p)
{
    return 0.3e6 * (1 + 9 * bump(p.x, p.y, 3e-3));
}
double lobeModulus(const glm::dvec3& p)
{
    const double front = 0.4e6 + (1e6 - 0.4e6) * (p.y / kLobe.y + 1) / 2;
    return p.z < 0 ? 2 * front : front; // the faces differ, so that a touch that confused them would be seen
}
double hemisphereModulus(const glm::dvec3& p)
{
    return 0.6e6 * (1 + 7 * bump(p.x - 15e-3, p.y, 5e-3)) / (1 + 2 * bump(p.x + 15e-3, p.y, 5e-3));
}
double palmModulus(const glm::dvec3& p)
{
    const double tendon = tendonDistance(p.x, p.y) / kTendonWidth;
    return 0.3e6 * (1 + 9 * std::exp(-tendon * tendon / 2)) /
           (1 + 1.5 * bump(p.x - kThenar.x, p.y - kThenar.y, kThenar.z));
}

Bounds square(double edge, double low, double high)
{
    return {{-edge / 2, -edge / 2, low}, {edge / 2, edge / 2, high}};
}

/// The parts of a sample: what users see of it, and how its points are made.
struct Shape {
    Sample sample;
    Bounds bounds;                          ///< [m]
    glm::dvec3 (*pointOn)(Uniform&);        ///< a random point, uniform per area [m]
    double (*modulus)(const glm::dvec3& p); ///< where the user names no law [Pa]
};

const std::array<Shape, 8>& shapes()
{
    constexpr glm::dvec3              kUp{0, 0, 1};
    static const std::array<Shape, 8> kShapes = {{
        {{"ellipsoid",
          "the paper's object: semi-axes 60, 45, 35 mm, modulus rising along x from 0.3 to 3 MPa",
          40'000,
          {4e-3, 0.45},
          0,
          40e-3,
          4e-3,
          {0, 0, kEllipsoid.z},
          {}},
         {-kEllipsoid, kEllipsoid},
         [](Uniform& u) { return onEllipsoid(u, kEllipsoid); },
         ellipsoidModulus},
        {{"sheet", "flat rubber, 150 mm square, 1.5 MPa", 40'000, {4e-3, 0.49}, 0, 60e-3, 4e-3, {0, 0, 0}, kUp},
         square(kSheet, 0, 0),
         [](Uniform& u) { return onHeightField(u, kSheet, flat); },
         sheetModulus},
        {{"pad",
          "flat pad on soft tissue, 240 mm square, 0.35 MPa, crossed by a tendon ten times as stiff",
          60'000,
          {6e-3, 0.45},
          0.3e6,
          150e-3,
          6e-3,
          {0, 0, 0},
          kUp},
         square(kPad, 0, 0),
         [](Uniform& u) { return onHeightField(u, kPad, flat); },
         padModulus},
        {{"hemisphere",
          "half a sphere of radius 50 mm, 0.6 MPa with a soft and a stiff spot",
          40'000,
          {4e-3, 0.45},
          0,
          40e-3,
          4e-3,
          {0, 0, kHemisphere},
          {}},
         {{-kHemisphere, -kHemisphere, 0}, glm::dvec3(kHemisphere)},
         onHemisphere,
         hemisphereModulus},
        {{"saddle",
          "120 mm square, curvature radii +80 and -80 mm, 1 MPa",
          40'000,
          {4e-3, 0.45},
          0,
          50e-3,
          4e-3,
          {0, 0, 0},
          kUp},
         square(kSaddle, saddle(0, kSaddle / 2), saddle(kSaddle / 2, 0)),
         [](Uniform& u) { return onHeightField(u, kSaddle, saddle); },
         saddleModulus},
        {{"skin",
          "skin on soft tissue (0.3 MPa) with a wart ten times as stiff",
          40'000,
          {4e-3, 0.45},
          1.74e6,
          70e-3,
          3.6e-3,
          {0, 0, skin(0, 0)},
          kUp},
         square(kSkin, skin(kSkin / 2, kSkin / 2), skin(0, 0)),
         [](Uniform& u) { return onHeightField(u, kSkin, skin); },
         skinModulus},
        {{"palm",
          "palm with stiff tendons (x 10) and a soft ball of the thumb",
          40'000,
          {4e-3, 0.45},
          4e6,
          72e-3,
          3.6e-3,
          {1e-3, 0, 0},
          kUp},
         square(kPalm, 0, palm(kPalm / 2, -kPalm / 2)),
         [](Uniform& u) { return onHeightField(u, kPalm, palm); },
         palmModulus},
        {{"ear-lobe",
          "two thin sheets, 28 by 36 mm, 3 mm apart in the middle, 0.4 MPa at the tip to 1 MPa at the root, the back "
          "twice that",
          20'000,
          {3e-3, 0.45},
          0,
          20e-3,
          2.5e-3,
          {0, 0, kLobe.z},
          {}},
         {-kLobe, kLobe},
         [](Uniform& u) { return onEllipsoid(u, kLobe); },
         lobeModulus},
    }};
    return kShapes;
}

const Shape& shapeNamed(std::string_view name)
{
    std::string                   listed;
    std::vector<std::string_view> known;
    for (const Shape& shape : shapes()) {
        if (shape.sample.name == name) return shape;
        listed += (listed.empty() ? "" : ", ") + std::string(shape.sample.name);
        known.emplace_back(shape.sample.name);
    }
    const auto meant = nearestName(name, known);
    throw Error("unknown sample \"" + std::string(name) + "\"; " +
                (meant ? "did you mean \"" + std::string(*meant) + "\"? " : "") + "samples: " + listed);
}

} // namespace

std::vector<Sample> samples()
{
    std::vector<Sample> all;
    for (const Shape& shape : shapes()) all.push_back(shape.sample);
    return all;
}

const Sample& sampleNamed(std::string_view name)
{
    return shapeNamed(name).sample;
}

Bounds boundsOf(const Sample& sample)
{
    return shapeNamed(sample.name).bounds;
}

PointCloud makeSample(const Sample& sample, std::size_t points, std::uint64_t seed,
                      const std::optional<SpatialLaw>& law)
{
    if (points < 16 || points > 100'000'000)
        throw Error("sample " + std::string(sample.name) + ": expected 16 to 100000000 points, found " +
                    std::to_string(points));
    const Shape&            shape = shapeNamed(sample.name);
    Uniform                 uniform(seed);
    std::vector<glm::dvec3> positions(points);
    std::vector<double>     modulus(points);
    for (std::size_t i = 0; i < points; ++i) {
        positions[i] = shape.pointOn(uniform);
        modulus[i]   = law ? (*law)(positions[i]) : shape.modulus(positions[i]);
    }
    return PointCloud(std::move(positions), std::move(modulus), StiffnessKind::modulus);
}

} // namespace palp
