#include "engine/chart/curvature_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/support/errors.h"

namespace palp {
namespace {

constexpr double kSpacing = 1e-3, kNoise = 0.3e-3; ///< [m]
constexpr double kReach = 42e-3;                   ///< half side of the square of points: window and largest fit [m]

/// Height over the plane, its slopes and second derivatives.
struct Height {
    double h = 0, hx = 0, hz = 0, hxx = 0, hzz = 0, hxz = 0; ///< [m], [1], [1/m]
};
using Surface = std::function<Height(double x, double z)>;

Surface quadric(double kx, double kz, double kxz)
{
    return [=](double x, double z) {
        return Height{
            -(kx * x * x + 2 * kxz * x * z + kz * z * z) / 2, -kx * x - kxz * z, -kz * z - kxz * x, -kx, -kz, -kxz};
    };
}

/// The upper half of an ellipsoid of half axes a, b along x, z and c along the height, below the plane.
Surface ellipsoid(double a, double b, double c)
{
    return [=](double x, double z) {
        const double rest = std::max(0.02, 1 - x * x / (a * a) - z * z / (b * b)), root = std::sqrt(rest);
        const double px = x / (a * a), pz = z / (b * b);
        return Height{c * (root - 1),
                      -c * px / root,
                      -c * pz / root,
                      -c / root / (a * a) - c * px * px / (rest * root),
                      -c / root / (b * b) - c * pz * pz / (rest * root),
                      -c * px * pz / (rest * root)};
    };
}

/// A cylinder whose axis is turned by half a right angle from the chart's.
Surface turnedCylinder(double radius)
{
    return [=](double x, double z) {
        const double t = (x + z) / std::numbers::sqrt2, root = std::sqrt(radius * radius - t * t);
        const double slope = -t / root / std::numbers::sqrt2, bend = -radius * radius / (root * root * root) / 2;
        return Height{root - radius, slope, slope, bend, bend, bend};
    };
}

/// Parallel ridges, aslant in the window and with their crest beside its middle.
Surface ridges(double crestRadius, double length)
{
    return [=](double x, double z) {
        constexpr double kX = 0.8, kZ = 0.6, kBeside = 0.7;
        const double     q = 2 * std::numbers::pi / length, high = 1 / (crestRadius * q * q);
        const double     y = q * (kX * x + kZ * z) + kBeside, slope = -high * q * std::sin(y),
                     bend = -std::cos(y) / crestRadius;
        return Height{high * std::cos(y), kX * slope, kZ * slope, kX * kX * bend, kZ * kZ * bend, kX * kZ * bend};
    };
}

/// Points on a surface, known as those of a cloud are.
struct Points {
    std::vector<glm::dvec3> places, normals;
    std::vector<ChartPoint> positions;
};

Points scattered(const Surface& surface, double noise, unsigned seed)
{
    std::mt19937                           random(seed);
    std::uniform_real_distribution<double> along(-kReach, kReach);
    std::normal_distribution<double>       away(0, noise > 0 ? noise : 1);
    const auto                             count = std::size_t(4 * kReach * kReach / (kSpacing * kSpacing));
    Points                                 points;
    for (std::size_t n = 0; n < count; ++n) {
        const double     x = along(random), z = along(random);
        const Height     at     = surface(x, z);
        const glm::dvec3 normal = glm::normalize(glm::dvec3(-at.hx, -at.hz, 1));
        points.places.push_back(glm::dvec3(x, z, at.h) + (noise > 0 ? away(random) : 0.0) * normal);
        points.normals.push_back(normal);
        points.positions.push_back({x, z});
    }
    return points;
}

/// The window about a place, and how it lies in the chart of all points.
PatchWindow windowAt(double x)
{
    PatchWindow window = PatchWindow::square(40e-3, 32);
    window.corner.x += x;
    return window;
}

/// Fits about one point of each square of half a radius, wherever the window is.
CurvatureSites sitesOn(const Points& points)
{
    return [&points, known = std::map<int, std::vector<CurvatureSite>>()](int rung, FitsFor) mutable {
        if (const auto found = known.find(rung); found != known.end()) return found->second;
        std::map<std::pair<int, int>, std::vector<std::size_t>> squares;
        const double                                            side = rungRadius(rung) / 2;
        for (std::size_t n = 0; n < points.positions.size(); ++n)
            squares[{int(std::floor(points.positions[n].x / side)), int(std::floor(points.positions[n].z / side))}]
                .push_back(n);
        std::vector<CurvatureSite> sites;
        for (const auto& [square, members] : squares) {
            const std::size_t one = members.front();
            const auto        fit = fitCurvature({points.places, points.normals}, points.places[one], rungRadius(rung));
            if (fit) sites.push_back({points.positions[one], *fit, double(members.size())});
        }
        return known[rung] = sites;
    };
}

CurvatureField fieldOf(const CurvatureSites& sites, double noise, double x = 0)
{
    const CurvatureSettings settings{.spacing = kSpacing, .noise = noise, .mostRadius = 20e-3, .lengthRoot = 0.018};
    return curvatureField(windowAt(x), Frame{}, sites, settings).value();
}

CurvatureField fieldOf(const Points& points, double noise)
{
    return fieldOf(sitesOn(points), noise);
}

struct Tensor {
    double x = 0, z = 0, xz = 0; ///< [1/m]
};

/// The tensor of a surface in axes that are carried along the shortest arc from its plane.
Tensor exactAt(const Surface& surface, double x, double z)
{
    const Height at    = surface(x, z);
    const double slope = std::sqrt(1 + at.hx * at.hx + at.hz * at.hz);
    const Frame  axes  = Frame{}.carriedTo(glm::normalize(glm::dvec3(-at.hx, -at.hz, 1)));
    const auto   form  = [&](const glm::dvec3& a, const glm::dvec3& b) { // of tangents, by their parts in the plane
        return -(at.hxx * a.x * b.x + at.hxz * (a.x * b.y + a.y * b.x) + at.hzz * a.y * b.y) / slope;
    };
    return {form(axes.east, axes.east), form(axes.north, axes.north), form(axes.east, axes.north)};
}

/// Returns the root mean square error of the tensor within `within` [m] of the middle, over `size` [1/m].
double errorOf(const CurvatureField& field, const Surface& surface, double within, double size)
{
    const PatchWindow window = windowAt(0);
    double            sum = 0, count = 0;
    for (int i = 0; i <= window.grid.cellsX; ++i)
        for (int j = 0; j <= window.grid.cellsZ; ++j) {
            const double x = window.corner.x + i * window.grid.spacingX, z = window.corner.z + j * window.grid.spacingZ;
            if (std::hypot(x, z) > within) continue;
            const Tensor exact = exactAt(surface, x, z);
            const double dx = field.x(i, j) - exact.x, dz = field.z(i, j) - exact.z, dxz = field.xz(i, j) - exact.xz;
            sum += (dx * dx + dz * dz + 2 * dxz * dxz) / 2;
            ++count;
        }
    return std::sqrt(sum / count) / size;
}

struct Case {
    std::string name;
    Surface     surface;
    double      size;         ///< the larger curvature [1/m]
    double      clean, noisy; ///< errors that are permitted, relative to it [1]
};

std::vector<Case> cases()
{
    // A fit's bias grows as (radius/length)^2. Without noise radii are 5 spacings or the shell's length, 4 mm; with it
    // some 14 mm, and 5 % of the size are left of the noise by choice. Ridges are 60 mm long, so that the fit takes
    // half of the smallest radius of curvature, 10 mm.
    return {{"sphere", ellipsoid(50e-3, 50e-3, 50e-3), 20, 0.01, 0.08},
            {"cylinder", turnedCylinder(40e-3), 25, 0.01, 0.08},
            {"ellipsoid", ellipsoid(60e-3, 45e-3, 35e-3), 17, 0.02, 0.10},
            {"saddle", quadric(20, -20, 5), 20, 0.01, 0.08},
            {"ridges", ridges(20e-3, 60e-3), 50, 0.03, 0.10}};
}

TEST(CurvatureField, IsThatOfTheSurfaceOverTheWholeWindow)
{
    for (const Case& c : cases()) {
        const CurvatureField field = fieldOf(scattered(c.surface, 0, 1), 0);
        EXPECT_LT(errorOf(field, c.surface, 20e-3, c.size), c.clean) << c.name << ", radius " << field.radius;
    }
}

TEST(CurvatureField, IsThatOfTheSurfaceWhereThePointsAreNoisy)
{
    for (const Case& c : cases()) {
        const CurvatureField field = fieldOf(scattered(c.surface, kNoise, 2), kNoise);
        EXPECT_LT(errorOf(field, c.surface, 20e-3, c.size), c.noisy) << c.name << ", radius " << field.radius;
    }
}

TEST(CurvatureField, IsHardlyMovedByStrayPoints)
{
    const Surface surface = ellipsoid(50e-3, 50e-3, 50e-3);
    Points        points  = scattered(surface, kNoise, 3);
    const double  before  = errorOf(fieldOf(points, kNoise), surface, 20e-3, 20);
    for (std::size_t n = 0; n < points.places.size(); n += 50) points.places[n].z += 5 * kSpacing;
    // 2 % of the points, all to one side: least squares alone are then off by 0.2
    EXPECT_LT(errorOf(fieldOf(points, kNoise), surface, 20e-3, 20), before + 0.02);
}

TEST(CurvatureField, ChangesSmoothlyAsTheWindowMovesOverNoisyPoints)
{
    const Points         points = scattered(ellipsoid(50e-3, 50e-3, 50e-3), kNoise, 4);
    const int            middle = 16;
    const CurvatureSites sites  = sitesOn(points);
    std::vector<double>  means; // [1/m]
    for (int n = -10; n <= 10; ++n) {
        const CurvatureField field = fieldOf(sites, kNoise, n * 0.5e-3);
        means.push_back((field.x(middle, middle) + field.z(middle, middle)) / 2);
    }
    for (std::size_t n = 1; n + 1 < means.size(); ++n) {
        // Noise leaves 5 %, which comes and goes within some 5 mm: 1.5 % a step, and 0.3 % from step to step.
        EXPECT_LT(std::abs(means[n - 1] - 2 * means[n] + means[n + 1]) / 20, 0.006);
    }
}

/// Fits that all found the same bend, of both kinds, on a lattice of places.
CurvatureSites bentBy(double curvature)
{
    return [curvature](int, FitsFor) {
        std::vector<CurvatureSite> sites;
        for (double x = -40e-3; x <= 40e-3; x += 2e-3)
            for (double z = -40e-3; z <= 40e-3; z += 2e-3)
                sites.push_back({{x, z}, {Frame{}.normal, glm::dmat3(curvature)}});
        return sites;
    };
}

/// The rule of curvatureField(), by its words: what noise wants or the shell feels, within the bounds.
TEST(CurvatureField, TheRadiusOfTheFitsIsAsSmallAsNoiseAndShellPermit)
{
    const auto radiusOf = [](double bend, CurvatureSettings settings) {
        settings.spacing = kSpacing;
        return curvatureField(windowAt(0), Frame{}, bentBy(bend), settings).value().radius;
    };
    const auto wanted = [](double bend, double noise) { return std::cbrt(9.5 * noise * kSpacing / (0.025 * bend)); };
    // The survey takes what noise leaves of its fits off the bend: some 1 % of the radius.
    for (const double noise : {0.1e-3, 0.3e-3})
        EXPECT_NEAR(radiusOf(20, {.noise = noise, .mostRadius = 30e-3}) / wanted(20, noise), 1, 0.01) << noise;
    EXPECT_NEAR(radiusOf(20, {.mostRadius = 30e-3, .lengthRoot = 0.06}), 0.06 / std::sqrt(20), 1e-9) << "the shell's";
    EXPECT_NEAR(radiusOf(60, {.noise = 0.5e-3, .mostRadius = 30e-3}), 0.5 / 60, 1e-9) << "half of the least radius";
    EXPECT_NEAR(radiusOf(20, {.noise = 0.3e-3, .mostRadius = 12e-3}), 12e-3, 1e-12) << "the most";
    EXPECT_NEAR(radiusOf(20, {.mostRadius = 12e-3}), 5 * kSpacing, 1e-12) << "five spacings";
    EXPECT_NEAR(radiusOf(20, {.noise = 0.3e-3}), 5 * kSpacing, 1e-12) << "more than the most, if that is less";
}

/// A plane but for a part of it, by fits that noise makes wrong, of either sign in turn.
TEST(CurvatureField, InAWideWindowTheRadiusSuitsTheMostCurvedFiftieth)
{
    constexpr double kRoot    = 0.03; // [m^(1/2)]
    const auto       radiusOf = [&](double lump, double part, double noise, bool isWide) {
        const auto sites = [&](int rung, FitsFor) {
            const double               error = kFitNoiseError * noise * kSpacing / std::pow(rungRadius(rung), 3);
            std::vector<CurvatureSite> all;
            for (int i = 0; i < 40; ++i)
                for (int j = 0; j < 40; ++j) {
                    const double bend = (i * 40 + j < part * 1600 ? lump : 0) + ((i + j) % 2 == 0 ? error : -error);
                    all.push_back({{(i - 20) * 1e-3, (j - 20) * 1e-3}, {Frame{}.normal, glm::dmat3(bend)}});
                }
            return all;
        };
        const CurvatureSettings settings{
                  .spacing = kSpacing, .noise = noise, .mostRadius = 30e-3, .lengthRoot = kRoot, .isWide = isWide};
        return curvatureField(windowAt(0), Frame{}, sites, settings).value().radius;
    };
    const double felt = kRoot / std::sqrt(20);
    ASSERT_GT(felt, 5 * kSpacing);
    EXPECT_NEAR(radiusOf(20, 0.03, 0, true), felt, 1e-9);
    EXPECT_GT(radiusOf(20, 0.03, 0, false), 1.5 * felt) << "of what is typical";
    EXPECT_EQ(radiusOf(20, 0.01, 0, true), radiusOf(20, 0.01, 0, false)) << "less than a fiftieth";
    EXPECT_EQ(radiusOf(0, 0, 0.2e-3, true), radiusOf(0, 0, 0.2e-3, false)) << "noise is no lump";
    const double noise = 0.1e-3, cube = kFitNoiseError * noise * kSpacing;
    // What noise adds to a curvature, and what is taken off for it, are some 6 % here, and a third of that counts.
    EXPECT_NEAR(radiusOf(10, 0.1, noise, true) / std::cbrt(cube / (0.06 * 10)), 1, 0.03) << "6 % of the lump";
    EXPECT_NEAR(radiusOf(40, 0.1, noise, true) / std::cbrt(cube / 1.2), 1, 1e-9) << "1.2 1/m elsewhere";
}

TEST(CurvatureField, WhatGrowsEvenlyIsFoundUpToTheSidesOfTheWindow)
{
    const auto bend  = [](double x, double z) { return 50 + 1000 * x + 500 * z; }; // [1/m]
    const auto sites = [&](int, FitsFor) {
        std::vector<CurvatureSite> all;
        for (double x = -40e-3; x <= 40e-3; x += 2e-3)
            for (double z = -40e-3; z <= 40e-3; z += 2e-3)
                all.push_back({{x, z}, {Frame{}.normal, glm::dmat3(bend(x, z))}});
        return all;
    };
    const PatchWindow window = windowAt(0);
    const auto field = curvatureField(window, Frame{}, sites, {.spacing = kSpacing, .mostRadius = 20e-3}).value();
    for (int i = 0; i <= window.grid.cellsX; ++i)
        for (int j = 0; j <= window.grid.cellsZ; ++j) {
            const double x = window.corner.x + i * window.grid.spacingX, z = window.corner.z + j * window.grid.spacingZ;
            // Sites lie unevenly about a place, which costs up to a fiftieth of the slope over the radius of 5 mm.
            EXPECT_NEAR(field.x(i, j), bend(x, z), 0.05) << x << ", " << z;
        }
}

TEST(CurvatureField, TheSurveyIsAsWideAsALongWindowWants)
{
    PatchWindow long_{{32, 8, 40e-3 / 32, 10e-3 / 8}, {-20e-3, -5e-3}};
    for (const bool turned : {false, true}) {
        if (turned) long_ = {{8, 32, 10e-3 / 8, 40e-3 / 32}, {-5e-3, -20e-3}};
        std::vector<int> asked;
        const auto       sites = [&](int rung, FitsFor what) {
            asked.push_back(rung);
            return bentBy(20)(rung, what);
        };
        static_cast<void>(curvatureField(long_, Frame{}, sites, {.spacing = 0.2e-3, .mostRadius = 20e-3}));
        ASSERT_FALSE(asked.empty());
        EXPECT_NEAR(rungRadius(asked[0]) / 4e-3, 1, 0.15) << "a tenth of 40 mm, to half a rung";
    }
}

/// Of h = c r^4 the weights (1 - r^2)^2 of a fit find 2/3 of the quadric that equal ones do: see the means of a disc.
TEST(CurvatureField, AFitLooksAtItsMiddleMoreThanAtItsRim)
{
    constexpr double kRadius = 10e-3, kHigh = 0.2e-3; // [m] of the fit, and at its rim
    Points           points;
    for (double x = -kRadius; x <= kRadius; x += 0.25e-3)
        for (double z = -kRadius; z <= kRadius; z += 0.25e-3) {
            const double squared = (x * x + z * z) / (kRadius * kRadius);
            points.places.push_back({x, z, -kHigh * squared * squared});
            points.normals.push_back({0, 0, 1});
        }
    const auto fit = fitCurvature({points.places, points.normals}, {}, kRadius);
    ASSERT_TRUE(fit.has_value());
    const double quadric = 2 * kHigh / (kRadius * kRadius); // [1/m] of c r^2
    // Tukey's weights, which see the rim lie far away, take a little more.
    EXPECT_NEAR(fit->tensor[0][0] / quadric, 2.0 / 3, 0.08);
    EXPECT_NEAR(fit->tensor[1][1] / quadric, 2.0 / 3, 0.08);
}

TEST(CurvatureField, TurnsWithTheChart)
{
    const Points points = scattered(quadric(20, 5, 0), 0, 5);
    const double angle  = std::numbers::pi / 6;
    const Frame  turned = Frame{}.turned(angle);
    Points       other  = points;
    for (std::size_t n = 0; n < points.places.size(); ++n)
        other.positions[n] = {glm::dot(points.places[n], turned.east), glm::dot(points.places[n], turned.north)};
    const CurvatureField field =
        curvatureField(windowAt(0), turned, sitesOn(other), {.spacing = kSpacing, .mostRadius = 20e-3}).value();
    const double c = std::cos(angle), s = std::sin(angle);
    EXPECT_NEAR(field.x(16, 16), 20 * c * c + 5 * s * s, 0.1); // 0.5 % by the fit
    EXPECT_NEAR(field.z(16, 16), 20 * s * s + 5 * c * c, 0.1);
    // e' T n = 15 (e.x)(n.x)
    EXPECT_NEAR(field.xz(16, 16), 15 * turned.east.x * turned.north.x, 0.1);
}

/// Beside the border of a tube the sphere of a chart leans, here by ten degrees; the axes that were carried from its
/// normal to the tube's other normals were turned there.
TEST(CurvatureField, InAWideWindowTheAxesAreCarriedFromTheSurfaceAtTheContact)
{
    constexpr double kRadius = 30e-3;
    const Surface    tube    = [](double x, double) {
        const double root = std::sqrt(kRadius * kRadius - x * x);
        return Height{root - kRadius, -x / root, 0, -kRadius * kRadius / (root * root * root), 0, 0};
    };
    Points points = scattered([&](double x, double z) { return tube(0.6 * x, z); }, 0, 4); // within 25 mm of its crest
    for (std::size_t n = 0; n < points.places.size(); ++n) {
        const double x        = 0.6 * points.positions[n].x;
        points.places[n]      = {x, points.positions[n].z, tube(x, 0).h};
        points.normals[n]     = glm::normalize(glm::dvec3(-tube(x, 0).hx, 0, 1));
        points.positions[n].x = kRadius * std::asin(x / kRadius);
    }
    const Frame       leaning = Frame{}.carriedTo(glm::normalize(glm::dvec3(0, 0.18, 1)));
    CurvatureSettings settings{
        .spacing = kSpacing, .noise = 0, .mostRadius = 20e-3, .lengthRoot = 0.018, .isWide = true};
    const auto field = curvatureField(windowAt(0), leaning, sitesOn(points), settings).value();
    EXPECT_LT(largest(field.xz), 0.01 / kRadius) << "5 % without";
}

TEST(CurvatureField, IsFlatOnAPlaneAndNegativeInABowl)
{
    const CurvatureField plane = fieldOf(scattered(quadric(0, 0, 0), 0, 6), 0);
    EXPECT_LT(std::abs(plane.x(16, 16)) + std::abs(plane.z(16, 16)) + std::abs(plane.xz(16, 16)), 1e-9); // rounding
    const CurvatureField bowl = fieldOf(scattered(quadric(-10, -10, 0), 0, 7), 0);
    EXPECT_NEAR(bowl.x(16, 16), -10, 0.1);
}

TEST(CurvatureField, GoesOnBeyondTheBorderOfTheSurface)
{
    const Surface surface = ellipsoid(50e-3, 50e-3, 50e-3);
    Points        all     = scattered(surface, 0, 8), half;
    for (std::size_t n = 0; n < all.places.size(); ++n) {
        if (all.places[n].x > 0) continue; // the window's middle is a point of the border
        half.places.push_back(all.places[n]);
        half.normals.push_back(all.normals[n]);
        half.positions.push_back(all.positions[n]);
    }
    const CurvatureField field = fieldOf(half, 0);
    EXPECT_NEAR(field.x(16, 16), 20, 1); // a one-sided fit: 5 %
    EXPECT_NEAR(field.x(32, 16), 20, 2);
}

TEST(CurvatureField, IsEmptyWherePointsDetermineNoQuadric)
{
    Points line;
    for (int n = -20; n <= 20; ++n) {
        line.places.push_back({n * kSpacing, 0, 0});
        line.normals.push_back({0, 0, 1});
        line.positions.push_back({n * kSpacing, 0});
    }
    EXPECT_FALSE(
        curvatureField(windowAt(0), Frame{}, sitesOn(line), {.spacing = kSpacing, .mostRadius = 20e-3}).has_value());
    EXPECT_FALSE(fitCurvature({line.places, line.normals}, {}, 10e-3).has_value());
}

} // namespace
} // namespace palp
