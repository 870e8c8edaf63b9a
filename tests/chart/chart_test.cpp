#include "engine/chart/chart.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double kPi        = std::numbers::pi;
constexpr double kRadian    = kPi / 180; // [rad] in a degree
constexpr Map    kAllMaps[] = {Map::gallPeters, Map::lambertCylindrical, Map::lambertAzimuthal};

/// One value of a map.
struct MapValue {
    Map    map;
    double radius;              ///< [m]
    double longitude, latitude; ///< alpha, beta [degrees]
    double x, z;                ///< [m]
    double largest, smallest;   ///< principal scales of the map there [1]
};

// All 42 rows of the project's shared table equal_area_maps.csv: the maps' definitions and their derivatives in
// 40-digit arithmetic.
constexpr MapValue kMapValues[] = {
    {Map::gallPeters, 1, 0, 0, 0, 0, 1.414213562373095, 0.70710678118654752},
    {Map::lambertAzimuthal, 1, 0, 0, 0, 0, 1, 1},
    {Map::lambertCylindrical, 1, 10, 0, 0.17453292519943296, 0, 1, 1},
    {Map::gallPeters, 1, 0, 10, 0, 0.24557560793794569, 1.3927284806400379, 0.7180150430616908},
    {Map::lambertAzimuthal, 1, 0, 10, 0, 0.17431148549531635, 1.0038198375433474, 0.99619469809174553},
    {Map::lambertCylindrical, 1, 30, 20, 0.52359877559829887, 0.34202014332566873, 1.0641777724759121,
     0.93969262078590838},
    {Map::gallPeters, 1, -45, 45, -0.55536036726979578, 1, 1, 1},
    {Map::lambertAzimuthal, 1, -45, 45, -0.57735026918962576, 0.81649658092772603, 1.1547005383792515,
     0.86602540378443865},
    {Map::lambertCylindrical, 1, 60, -50, 1.0471975511965977, -0.76604444311897804, 1.5557238268604123,
     0.64278760968653933},
    {Map::gallPeters, 1, -30, -75, -0.37024024484653052, -1.3660254037844386, 2.7320508075688773, 0.36602540378443865},
    {Map::lambertAzimuthal, 1, -30, -75, -0.16541123416321902, -1.2346462600796124, 1.2781998642928151,
     0.78235026300309166},
    {Map::lambertCylindrical, 1, 89, 0, 1.5533430342749533, 0, 1, 1},
    {Map::gallPeters, 1, 0, 89, 0, 1.4139981707976484, 40.516291190420472, 0.024681429879653853},
    {Map::lambertAzimuthal, 1, 0, 89, 0, 1.4018185285997018, 1.4020320648740769, 0.71325044915418158},
    {Map::lambertCylindrical, 1, -89.5, 10, -1.562069680534925, 0.17364817766693035, 1.015426611885745,
     0.98480775301220806},
    {Map::gallPeters, 1, 90, 0, 1.1107207345395916, 0, 1.414213562373095, 0.70710678118654752},
    {Map::lambertAzimuthal, 1, 90, 0, 1.414213562373095, 0, 1.414213562373095, 0.70710678118654752},
    {Map::lambertCylindrical, 1, 0, 90, 0, 1, std::numeric_limits<double>::infinity(), 0},
    {Map::gallPeters, 1, 90, 45, 1.1107207345395916, 1, 1, 1},
    {Map::lambertAzimuthal, 1, 90, 45, 1, 1, 1.414213562373095, 0.70710678118654752},
    {Map::lambertCylindrical, 1, 1e-06, 1e-06, 1.7453292519943296e-8, 1.7453292519943295e-8, 1, 1},
    {Map::gallPeters, 2.5, 0, 0, 0, 0, 1.414213562373095, 0.70710678118654752},
    {Map::lambertAzimuthal, 2.5, 0, 0, 0, 0, 1, 1},
    {Map::lambertCylindrical, 2.5, 10, 0, 0.43633231299858239, 0, 1, 1},
    {Map::gallPeters, 2.5, 0, 10, 0, 0.61393901984486423, 1.3927284806400379, 0.7180150430616908},
    {Map::lambertAzimuthal, 2.5, 0, 10, 0, 0.43577871373829087, 1.0038198375433474, 0.99619469809174553},
    {Map::lambertCylindrical, 2.5, 30, 20, 1.3089969389957472, 0.85505035831417183, 1.0641777724759121,
     0.93969262078590838},
    {Map::gallPeters, 2.5, -45, 45, -1.3884009181744895, 2.5, 1, 1},
    {Map::lambertAzimuthal, 2.5, -45, 45, -1.4433756729740644, 2.0412414523193151, 1.1547005383792515,
     0.86602540378443865},
    {Map::lambertCylindrical, 2.5, 60, -50, 2.6179938779914944, -1.9151111077974451, 1.5557238268604123,
     0.64278760968653933},
    {Map::gallPeters, 2.5, -30, -75, -0.9256006121163263, -3.4150635094610966, 2.7320508075688773, 0.36602540378443865},
    {Map::lambertAzimuthal, 2.5, -30, -75, -0.41352808540804755, -3.0866156501990311, 1.2781998642928151,
     0.78235026300309166},
    {Map::lambertCylindrical, 2.5, 89, 0, 3.8833575856873833, 0, 1, 1},
    {Map::gallPeters, 2.5, 0, 89, 0, 3.5349954269941211, 40.516291190420472, 0.024681429879653853},
    {Map::lambertAzimuthal, 2.5, 0, 89, 0, 3.5045463214992545, 1.4020320648740769, 0.71325044915418158},
    {Map::lambertCylindrical, 2.5, -89.5, 10, -3.9051742013373124, 0.43412044416732587, 1.015426611885745,
     0.98480775301220806},
    {Map::gallPeters, 2.5, 90, 0, 2.7768018363489789, 0, 1.414213562373095, 0.70710678118654752},
    {Map::lambertAzimuthal, 2.5, 90, 0, 3.5355339059327376, 0, 1.414213562373095, 0.70710678118654752},
    {Map::lambertCylindrical, 2.5, 0, 90, 0, 2.5, std::numeric_limits<double>::infinity(), 0},
    {Map::gallPeters, 2.5, 90, 45, 2.7768018363489789, 2.5, 1, 1},
    {Map::lambertAzimuthal, 2.5, 90, 45, 2.5, 2.5, 1.414213562373095, 0.70710678118654752},
    {Map::lambertCylindrical, 2.5, 1e-06, 1e-06, 4.3633231299858239e-8, 4.3633231299858237e-8, 1.0000000000000002,
     0.99999999999999984}};

/// A chart in general position: nothing is aligned with the world.
Chart tilted(Map map, double curvature)
{
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.8, 0.5));
    return {map, {0.2, -0.1, 0.4}, Frame::about(normal).turned(0.7), curvature};
}

/// The point of the chart's surface at a longitude and latitude [rad] about the contact; curvature is not 0.
glm::dvec3 onSphere(const Chart& chart, double longitude, double latitude)
{
    const Frame&     f         = chart.frame;
    const glm::dvec3 direction = std::cos(latitude) * std::cos(longitude) * f.normal + std::sin(latitude) * f.north +
                                 std::cos(latitude) * std::sin(longitude) * f.east;
    const double radius = 1 / std::abs(chart.curvature);
    // A bowl's centre is on the hand's side, so that its points lie against the normal.
    const double     side       = chart.curvature > 0 ? 1 : -1;
    const glm::dvec3 tangential = direction - glm::dot(direction, f.normal) * f.normal;
    return chart.origin + radius * (tangential + side * (glm::dot(direction, f.normal) - 1) * f.normal);
}

double separation(const ChartPoint& a, const ChartPoint& b)
{
    return std::hypot(a.x - b.x, a.z - b.z);
}

double areaOf(const std::vector<ChartPoint>& polygon)
{
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const ChartPoint &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        twice += a.x * b.z - b.x * a.z;
    }
    return twice / 2;
}

void expectOrthonormal(const Frame& frame, const char* because)
{
    EXPECT_NEAR(glm::length(frame.normal), 1, 1e-15) << because;
    EXPECT_NEAR(glm::length(frame.east), 1, 1e-15) << because;
    EXPECT_LE(std::abs(glm::dot(frame.east, frame.normal)), 1e-15) << because;
    EXPECT_LE(glm::distance(glm::cross(frame.east, frame.north), frame.normal), 1e-15) << because;
}

/// Derivatives of the map along the parallel and the meridian of the unit direction there [1], by central differences.
struct Derivatives {
    double xAlong, zAlong, xUp, zUp;

    Derivatives(const Chart& chart, double longitude, double latitude)
    {
        const double step   = 1e-5; // [rad]: truncation step^2/6 and rounding 1e-16/step are both about 1e-11
        const auto   at     = [&](double a, double b) { return chart.project(onSphere(chart, a, b)).value(); };
        const double radius = 1 / std::abs(chart.curvature);
        const double along = 2 * step * radius * std::cos(latitude), up = 2 * step * radius;
        const auto   east = at(longitude + step, latitude), west = at(longitude - step, latitude);
        const auto   north = at(longitude, latitude + step), south = at(longitude, latitude - step);
        xAlong = (east.x - west.x) / along, zAlong = (east.z - west.z) / along;
        xUp = (north.x - south.x) / up, zUp = (north.z - south.z) / up;
    }

    [[nodiscard]] double determinant() const { return xAlong * zUp - zAlong * xUp; }
    [[nodiscard]] double largestScale() const
    {
        // Of a 2x2 matrix: half the lengths of its conformal and anticonformal parts, added.
        return 0.5 * (std::hypot(xAlong + zUp, zAlong - xUp) + std::hypot(xAlong - zUp, zAlong + xUp));
    }
};

TEST(Chart, ProjectsToTheTabulatedValuesOfEveryMap)
{
    for (const double side : {1.0, -1.0})
        for (const MapValue& v : kMapValues) {
            const Chart chart = tilted(v.map, side / v.radius);
            const auto  p     = chart.project(onSphere(chart, v.longitude * kRadian, v.latitude * kRadian));

            ASSERT_TRUE(p.has_value()) << name(v.map) << " " << v.longitude << ", " << v.latitude;
            const double slope = 1 / std::cos(v.latitude * kRadian); // of longitude: beyond measure at the pole
            if (slope < 1e9) {
                EXPECT_NEAR(p->x, v.x, 2e-15 * v.radius * slope) << "rounding times the slope";
            }
            EXPECT_NEAR(p->z, v.z, 2e-15 * v.radius) << "rounding";
        }
}

TEST(Chart, LiftsTheTabulatedValuesBackToTheSphere)
{
    for (const double side : {1.0, -1.0})
        for (const MapValue& v : kMapValues) {
            const Chart chart = tilted(v.map, side / v.radius);
            const auto  point = chart.lift({v.x, v.z});

            ASSERT_TRUE(point.has_value()) << name(v.map) << " " << v.longitude << ", " << v.latitude;
            const double slope = 1 / std::max(std::cos(v.latitude * kRadian), 1e-8); // pole: square root of rounding
            EXPECT_LE(glm::distance(*point, onSphere(chart, v.longitude * kRadian, v.latitude * kRadian)),
                      2e-15 * v.radius * slope)
                << name(v.map) << " " << v.longitude << ", " << v.latitude;
        }
}

TEST(Chart, StretchesByTheTabulatedScales)
{
    for (const MapValue& v : kMapValues) {
        if (std::abs(v.longitude) > 89.9 || std::abs(v.latitude) > 88)
            continue; // differences would cross the rim or the pole
        for (const double side : {1.0, -1.0}) {
            const Derivatives d(tilted(v.map, side / v.radius), v.longitude * kRadian, v.latitude * kRadian);

            EXPECT_NEAR(d.largestScale(), v.largest, 1e-8 * v.largest) << name(v.map) << " " << v.latitude;
            EXPECT_NEAR(d.determinant(), 1, 1e-8) << "equal area; differences are good to 1e-9";
        }
    }
}

TEST(Chart, OnlyGallPetersIsDistortedAtTheContact)
{
    for (const double curvature : {2.0, 1e-3, -1e-3, -2.0}) {
        const Derivatives paper(tilted(Map::gallPeters, curvature), 0, 0);
        EXPECT_NEAR(paper.xAlong, 1 / std::numbers::sqrt2, 1e-9);
        EXPECT_NEAR(paper.zUp, std::numbers::sqrt2, 1e-9);
        for (const Map map : {Map::lambertCylindrical, Map::lambertAzimuthal}) {
            const Derivatives ours(tilted(map, curvature), 0, 0);
            EXPECT_NEAR(ours.xAlong, 1, 1e-9) << name(map);
            EXPECT_NEAR(ours.zUp, 1, 1e-9) << name(map);
        }
    }
}

TEST(Chart, SmallQuadsKeepTheirArea)
{
    std::mt19937                           random(17);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const double                           size = 1e-4; // [rad]: its square is the error of taking a quad for flat
    for (const Map map : kAllMaps)
        for (int i = 0; i < 300; ++i) {
            const double curvature = (i % 2 ? 1 : -1) * std::pow(10.0, 3 * uniform(random)); // [1/m]
            const Chart  chart     = tilted(map, curvature);
            const double longitude = 1.5 * uniform(random), latitude = 1.4 * uniform(random);
            const double wide = size * (1.5 + uniform(random)), tall = size * (1.5 + uniform(random));

            std::vector<ChartPoint> quad;
            for (const auto& [a, b] : {std::pair{0.0, 0.0}, {wide, 0.0}, {wide, tall}, {0.0, tall}})
                quad.push_back(chart.project(onSphere(chart, longitude + a, latitude + b)).value());

            const double truth = wide * (std::sin(latitude + tall) - std::sin(latitude)) / (curvature * curvature);
            EXPECT_NEAR(areaOf(quad), truth, 1e-6 * truth) << name(map) << " " << longitude << ", " << latitude;
        }
}

TEST(Chart, LargePatchesKeepTheirArea)
{
    const double west = -0.9, east = 0.4, south = -0.3, north = 1.1; // [rad]
    const int    n = 2000;                                           // chords a side: the error is 1/n^2
    for (const Map map : kAllMaps)
        for (const double curvature : {0.4, -0.4}) {
            const Chart             chart = tilted(map, curvature);
            std::vector<ChartPoint> outline;
            const auto              side = [&](double a0, double b0, double a1, double b1) {
                for (int i = 0; i < n; ++i) {
                    const double t = double(i) / n;
                    outline.push_back(chart.project(onSphere(chart, a0 + t * (a1 - a0), b0 + t * (b1 - b0))).value());
                }
            };
            side(west, south, east, south);
            side(east, south, east, north);
            side(east, north, west, north);
            side(west, north, west, south);

            const double truth = (east - west) * (std::sin(north) - std::sin(south)) / (curvature * curvature);
            EXPECT_NEAR(areaOf(outline), truth, 1e-6 * truth) << name(map) << ", chords inside arcs";
        }
}

TEST(Chart, LiftUndoesProject)
{
    std::mt19937                           random(23);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const Map map : kAllMaps)
        for (int i = 0; i < 2000; ++i) {
            const double curvature = (i % 2 ? 1 : -1) * std::pow(10.0, 3 * uniform(random)); // [1/m]
            const Chart  chart     = tilted(map, curvature);
            const double longitude = 0.5 * kPi * uniform(random), latitude = 0.49 * kPi * uniform(random);
            const auto   point = onSphere(chart, longitude, latitude);

            const auto position = chart.project(point);
            ASSERT_TRUE(position.has_value());
            const auto back = chart.lift(*position);
            ASSERT_TRUE(back.has_value());

            EXPECT_LE(glm::distance(*back, point), 2e-15 * (1 + 1 / std::abs(curvature)) / std::cos(latitude))
                << "rounding over the slope of the sine; " << name(map) << " " << longitude << ", " << latitude;
        }
}

TEST(Chart, ProjectUndoesLift)
{
    std::mt19937                           random(29);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (const Map map : kAllMaps)
        for (const double curvature : {0.0, 1e-12, -1e-6, 0.1, -1.0})
            for (int i = 0; i < 500; ++i) {
                const Chart      chart = tilted(map, curvature);
                const ChartPoint position{0.6 * uniform(random), 0.6 * uniform(random)};

                const auto point = chart.lift(position);
                ASSERT_TRUE(point.has_value());
                const auto back = chart.project(*point);
                ASSERT_TRUE(back.has_value());

                EXPECT_LE(separation(*back, position), 3e-15) << name(map) << ", curvature " << curvature;
            }
}

TEST(Chart, ProjectsAlongTheRadius)
{
    for (const Map map : kAllMaps)
        for (const double curvature : {2.0, -2.0}) {
            const Chart      chart  = tilted(map, curvature);
            const glm::dvec3 centre = chart.origin - chart.frame.normal / curvature;
            const glm::dvec3 point  = onSphere(chart, 0.6, -0.8);
            for (const double factor : {0.1, 0.9, 1.5, 10.0})
                EXPECT_LE(separation(*chart.project(centre + factor * (point - centre)), *chart.project(point)), 3e-15)
                    << name(map) << " " << factor;
        }
}

/// Domes, bowls and planes, with points in front, behind and in the very centre.
TEST(Chart, ManyPointsGoWhereEachOfThemGoes)
{
    std::mt19937_64                  random(6);
    std::uniform_real_distribution<> along(-0.2, 0.2);
    for (const Map map : kAllMaps)
        for (const double curvature : {8.0, -8.0, 0.0}) {
            const Chart             chart = tilted(map, curvature);
            std::vector<glm::dvec3> points(301);
            for (glm::dvec3& p : points) p = chart.origin + glm::dvec3(along(random), along(random), along(random));
            if (curvature != 0) points[7] = chart.origin - chart.frame.normal / curvature;
            std::vector<ChartPoint>   positions(points.size());
            std::vector<std::uint8_t> on(points.size());
            chart.project(points, positions, on);
            std::size_t dropped = 0;
            for (std::size_t k = 0; k < points.size(); ++k) {
                const auto alone = chart.project(points[k]);
                ASSERT_EQ(on[k] != 0, alone.has_value()) << name(map) << ", point " << k;
                dropped += !alone;
                if (!alone) continue;
                ASSERT_EQ(positions[k].x, alone->x) << name(map) << ", point " << k;
                ASSERT_EQ(positions[k].z, alone->z) << name(map) << ", point " << k;
            }
            EXPECT_EQ(dropped > 0, curvature != 0) << "else the fixture has no far hemisphere";
        }
}

TEST(Chart, FarHemisphereAndTheCentreAreDropped)
{
    for (const Map map : kAllMaps)
        for (const double curvature : {2.0, -2.0}) {
            const Chart chart = tilted(map, curvature);
            for (const double latitude : {-1.5, -0.3, 0.0, 0.9}) {
                EXPECT_TRUE(chart.project(onSphere(chart, 0.5 * kPi - 1e-9, latitude)).has_value());
                EXPECT_TRUE(chart.project(onSphere(chart, -0.5 * kPi, latitude)).has_value()) << "the rim belongs";
                EXPECT_FALSE(chart.project(onSphere(chart, 0.5 * kPi + 1e-9, latitude)).has_value());
                EXPECT_FALSE(chart.project(onSphere(chart, kPi, latitude)).has_value());
            }
            EXPECT_FALSE(Chart({map, {}, {}, curvature}).project({0, 0, -1 / curvature}).has_value());
            EXPECT_FALSE(chart.project(glm::dvec3(std::numeric_limits<double>::quiet_NaN())).has_value());
        }
}

TEST(Chart, NothingIsLiftedFromOutsideTheImageOfTheHemisphere)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double radius : {0.5, 2.5}) {
        const struct {
            Map    map;
            double halfX, halfZ; ///< [m] of the image, along its axes
        } images[] = {{Map::gallPeters, radius * kPi / std::sqrt(8.0), radius * std::numbers::sqrt2},
                      {Map::lambertCylindrical, radius * kPi / 2, radius},
                      {Map::lambertAzimuthal, radius * std::numbers::sqrt2, radius * std::numbers::sqrt2}};
        for (const auto& [map, halfX, halfZ] : images) {
            const Chart chart = tilted(map, 1 / radius);
            EXPECT_TRUE(chart.lift({halfX * 0.999999, 0}).has_value()) << name(map);
            EXPECT_TRUE(chart.lift({0, -halfZ * 0.999999}).has_value()) << name(map);
            EXPECT_FALSE(chart.lift({-halfX * 1.000001, 0}).has_value()) << name(map);
            EXPECT_FALSE(chart.lift({0, halfZ * 1.000001}).has_value()) << name(map);
            EXPECT_FALSE(chart.lift({nan, 0}).has_value()) << name(map);
        }
        EXPECT_FALSE(tilted(Map::lambertAzimuthal, 1 / radius).lift({1.2 * radius, 1.2 * radius}).has_value());
        EXPECT_TRUE(tilted(Map::lambertCylindrical, 1 / radius).lift({1.2 * radius, 0.9 * radius}).has_value());
    }
}

TEST(Chart, PoleIsLiftedEvenIfRoundingPutsItBeyondTheImage)
{
    const Chart chart = {Map::lambertCylindrical, {}, {}, 1};

    const auto pole = chart.lift({0.3, std::nextafter(1.0, 2.0)});

    ASSERT_TRUE(pole.has_value());
    EXPECT_LE(glm::distance(*pole, glm::dvec3(0, 1, -1)), 1e-15);
}

TEST(Chart, PlaneIsTheTangentPlaneWithTheSameStretch)
{
    for (const Map map : kAllMaps) {
        const Chart      chart   = tilted(map, 0);
        const double     stretch = map == Map::gallPeters ? std::numbers::sqrt2 : 1;
        const glm::dvec3 flat    = chart.origin + 30.0 * chart.frame.east - 40.0 * chart.frame.north;

        const auto p = chart.project(flat + 7.0 * chart.frame.normal);

        ASSERT_TRUE(p.has_value());
        EXPECT_NEAR(p->x, 30 / stretch, 1e-13) << "rounding of 70 m";
        EXPECT_NEAR(p->z, -40 * stretch, 1e-13);
        EXPECT_LE(glm::distance(chart.lift(*p).value(), flat), 1e-13);
    }
}

TEST(Chart, SphereTendsToThePlaneAtTheRateOfItsCurvature)
{
    const double east = 0.4, north = -0.3, up = 0.05; // [m]
    for (const Map map : kAllMaps)
        for (const double side : {1.0, -1.0}) {
            const Chart      plane      = tilted(map, 0);
            const glm::dvec3 inside     = plane.origin + east * plane.frame.east + north * plane.frame.north;
            const glm::dvec3 above      = inside + up * plane.frame.normal;
            double           lastInside = 0, lastAbove = 0;
            for (const double curvature : {1e-1, 1e-2, 1e-3}) {
                const Chart  chart      = tilted(map, side * curvature);
                const double fromInside = separation(*chart.project(inside), *plane.project(inside));
                const double fromAbove  = separation(*chart.project(above), *plane.project(above));
                if (lastInside > 0) {
                    EXPECT_NEAR(std::log10(lastInside / fromInside), 2, 0.02)
                        << name(map) << ": second order in the plane";
                    EXPECT_NEAR(std::log10(lastAbove / fromAbove), 1, 0.1) << name(map) << ": first order above it";
                }
                lastInside = fromInside, lastAbove = fromAbove;
            }
            for (double curvature = 1e-3; curvature > 1e-320; curvature *= 1e-3) {
                const Chart chart = tilted(map, side * curvature);
                EXPECT_LE(separation(*chart.project(above), *plane.project(above)), 0.1 * curvature + 2e-16);
                EXPECT_LE(glm::distance(*chart.lift({east, north}), *plane.lift({east, north})), curvature + 2e-16);
            }
        }
}

TEST(Chart, SeriesMeetTheFunctionsTheyReplace)
{
    // Angles on both sides of 1e-3 rad, where the code changes from series to atan and sin.
    for (const double angle : {0.3e-3, 0.9e-3, 0.999999e-3, 1.000001e-3, 1.1e-3, 1.999e-3, 2.001e-3, 3e-3}) {
        const Chart chart = {Map::lambertCylindrical, {}, {}, 1};
        const auto  exact = static_cast<long double>(angle);

        const auto lifted    = chart.lift({angle, 0}).value();
        const auto projected = chart.project({std::tan(angle), 0, 0}).value();

        EXPECT_NEAR(lifted.x, double(std::sin(exact)), 3e-19) << "one rounding of 1e-3";
        EXPECT_NEAR(lifted.z, double(-2 * std::sin(exact / 2) * std::sin(exact / 2)), 3e-21) << "of 1e-6";
        EXPECT_NEAR(projected.x, angle, 6e-19) << "two roundings of 1e-3";
    }
}

TEST(Chart, BowlIsTheMirroredDome)
{
    for (const Map map : kAllMaps) {
        const Chart dome = {map, {}, {}, 0.8}, bowl = {map, {}, {}, -0.8};
        for (const glm::dvec3& p :
             {glm::dvec3(0.3, -0.2, -0.1), glm::dvec3(-1, 0.1, -0.9), glm::dvec3(0.5, 0.6, 0.4)}) {
            const auto d = dome.project(p).value(), b = bowl.project({p.x, p.y, -p.z}).value();
            EXPECT_EQ(d.x, b.x) << name(map);
            EXPECT_EQ(d.z, b.z) << name(map);
            const auto up = dome.lift(d).value(), down = bowl.lift(b).value();
            EXPECT_EQ(up, glm::dvec3(down.x, down.y, -down.z)) << name(map);
        }
    }
}

TEST(Chart, IsBuiltAboutTheFootOfTheContact)
{
    const SphereFit  fit{{1, 2, 3}, 0.5, {0, 0, 1}, 0, 0}; // centre (1, 2, 1), radius 2 m
    const glm::dvec3 contact(1, 5, 1), foot(1, 4, 1);

    const Chart dome = Chart::around(fit, contact, {0.2, 1, -0.3}, Map::lambertAzimuthal);
    const Chart bowl = Chart::around(fit, contact, {0.2, -1, -0.3}, Map::gallPeters);

    EXPECT_LE(glm::distance(dome.origin, foot), 1e-15);
    EXPECT_LE(glm::distance(bowl.origin, foot), 1e-15);
    EXPECT_LE(glm::distance(dome.frame.normal, glm::dvec3(0, 1, 0)), 1e-15) << "away from the centre";
    EXPECT_LE(glm::distance(bowl.frame.normal, glm::dvec3(0, -1, 0)), 1e-15) << "towards the centre";
    EXPECT_EQ(dome.curvature, 0.5);
    EXPECT_EQ(bowl.curvature, -0.5) << "a bowl, seen from inside";
    EXPECT_EQ(dome.map, Map::lambertAzimuthal);
    EXPECT_EQ(bowl.map, Map::gallPeters);
    const auto atFoot = dome.project(contact).value();
    EXPECT_LE(separation(atFoot, {0, 0}), 1e-15) << "the contact is the origin of the chart";
    EXPECT_TRUE(dome.project({1.5, 3.9, 1}).has_value());
    EXPECT_TRUE(bowl.project({1.5, 3.9, 1}).has_value()) << "the same near points in both";
    EXPECT_FALSE(bowl.project({1, -1, 1}).has_value());
}

TEST(Chart, TakesOverTheFrameOfTheNeighbouringContact)
{
    const SphereFit fit{{1, 2, 3}, 0.5, {0, 0, 1}, 0, 0}; // centre (1, 2, 1), radius 2 m
    const Frame     before = Frame::about({0, 0, 1}).turned(0.3);

    const Chart chart = Chart::around(fit, {1.2, 2.1, 4}, {0, 0, 1}, Map::lambertAzimuthal, before);

    const Frame expected = before.carriedTo(glm::normalize(glm::dvec3(0.2, 0.1, 3)));
    EXPECT_LE(glm::distance(chart.frame.east, expected.east), 1e-15);
    EXPECT_GT(glm::distance(chart.frame.east, Frame::about(chart.frame.normal).east), 0.25) << "not a fresh frame";
}

TEST(Chart, RefusesAnOutwardDirectionOfNoLength)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)Chart::around({}, {}, {0, 0, 0}, Map::gallPeters), ContractViolation);
    for (const double bad : {nan, std::numeric_limits<double>::infinity()})
        EXPECT_THROW((void)Chart::around({}, {}, {0, bad, 0}, Map::gallPeters), ContractViolation);
}

TEST(Chart, MapsAreFoundByTheirNames)
{
    for (const Map map : kAllMaps) EXPECT_EQ(valueNamed<Map>(name(map)), map);
    EXPECT_STREQ(name(Map::gallPeters), "gall-peters");
    EXPECT_STREQ(name(Map::lambertCylindrical), "lambert-cylindrical");
    EXPECT_STREQ(name(Map::lambertAzimuthal), "lambert-azimuthal");
    EXPECT_FALSE(valueNamed<Map>("mercator").has_value());
    EXPECT_FALSE(valueNamed<Map>("").has_value());
}

TEST(Frame, AboutAnyNormalIsOrthonormal)
{
    std::mt19937                     random(31);
    std::normal_distribution<double> normal;
    std::vector<glm::dvec3>          normals{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int i = 0; i < 1000; ++i)
        normals.push_back(glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))));
    for (double tilt = 1e-17; tilt < 1e-2; tilt *= 3) // close to -z, where the shortest arc is not unique
        normals.push_back(glm::normalize(glm::dvec3(0.6 * tilt, -0.8 * tilt, -1)));
    for (const glm::dvec3& n : normals) {
        const Frame frame = Frame::about(n);
        expectOrthonormal(frame, "squared at every step");
        EXPECT_LE(glm::distance(frame.normal, n), 1e-15);
    }
    expectOrthonormal(Frame::about(1.0000001 * normals.back()), "a unit vector in single precision will do");
    EXPECT_THROW((void)Frame::about({0, 0, 2}), ContractViolation);
    EXPECT_THROW((void)Frame::about({0, 0, 0}), ContractViolation);
    EXPECT_THROW((void)Frame::about({0, 0, std::numeric_limits<double>::quiet_NaN()}), ContractViolation);
}

TEST(Frame, CarriedAlongAnArcKeepsItsAngleWithTheArc)
{
    std::mt19937                     random(37);
    std::normal_distribution<double> normal;
    const auto direction = [&] { return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))); };
    for (int i = 0; i < 500; ++i) {
        const Frame      start  = Frame::about(direction()).turned(normal(random));
        const glm::dvec3 target = direction(), axis = glm::normalize(glm::cross(start.normal, target));

        const Frame end = start.carriedTo(target);

        // The axis of the shortest rotation stays put, and so do its components.
        EXPECT_NEAR(glm::dot(end.east, axis), glm::dot(start.east, axis), 1e-14);
        EXPECT_NEAR(glm::dot(end.north, axis), glm::dot(start.north, axis), 1e-14);
        expectOrthonormal(end, "squared at every step");
    }
}

TEST(Frame, CarriedToTheOppositeNormalIsTurnedAboutEast)
{
    const Frame start = Frame::about(glm::normalize(glm::dvec3(0.3, -0.8, 0.5))).turned(0.4);
    for (const double tilt : {0.0, 1e-16, 1e-9}) {
        const Frame end = start.carriedTo(glm::normalize(-start.normal + tilt * (start.east - start.north)));

        EXPECT_LE(glm::distance(end.east, start.east), 3e-9);
        EXPECT_LE(glm::distance(end.north, -start.north), 3e-9);
        expectOrthonormal(end, "squared at every step");
    }
}

TEST(Frame, CarriedAroundATriangleTurnsByItsSolidAngle)
{
    std::mt19937                     random(41);
    std::normal_distribution<double> normal;
    const auto direction = [&] { return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))); };
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 a = i ? direction() : glm::dvec3(0, 0, 1), b = i ? direction() : glm::dvec3(1, 0, 0),
                         c = i ? direction() : glm::dvec3(0, 1, 0); // first an octant: a right angle
        const Frame start  = Frame::about(a).turned(0.1 * i);

        const Frame end = start.carriedTo(b).carriedTo(c).carriedTo(a);

        const double volume = glm::dot(a, glm::cross(b, c));
        const double solid  = 2 * std::atan2(volume, 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
        const Frame  turned = start.turned(i ? solid : kPi / 2);
        EXPECT_LE(glm::distance(end.east, turned.east), 1e-12) << "rounding, up to 1/(pi - arc) for long arcs";
        EXPECT_LE(glm::distance(end.north, turned.north), 1e-12);
    }
}

TEST(Frame, StaysOrthonormalOverAnHourOfSteps)
{
    Frame frame;
    for (int i = 1; i <= 216000; ++i) // 60 steps a second
        frame = frame.carriedTo(
            glm::normalize(glm::dvec3(std::cos(0.01 * i), std::sin(0.013 * i), 1.5 + std::sin(0.007 * i))));

    expectOrthonormal(frame, "squared at every step");
}

TEST(Frame, TurnedGoesFromEastToNorth)
{
    const Frame frame  = Frame::about(glm::normalize(glm::dvec3(1, 2, -2)));
    const Frame turned = frame.turned(kPi / 2);

    EXPECT_LE(glm::distance(turned.east, frame.north), 1e-15);
    EXPECT_LE(glm::distance(turned.north, -frame.east), 1e-15);
    EXPECT_EQ(turned.normal, frame.normal);
}

} // namespace
} // namespace palp
