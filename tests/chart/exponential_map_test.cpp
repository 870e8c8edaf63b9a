#include "engine/chart/exponential_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/support/errors.h"

namespace palp {
namespace {

using std::numbers::pi;

constexpr double kSpacing = 0.0005; // [m]

/// A piece of surface whose chart is known: the origin is the world's, with the world's axes.
struct Piece {
    std::vector<glm::dvec3> positions, normals;
    std::vector<double>     steps; ///< [m]
    std::vector<ChartPoint> truth; ///< chart positions [m]

    void add(const glm::dvec3& position, const glm::dvec3& normal, double step, const ChartPoint& chart)
    {
        positions.push_back(position);
        normals.push_back(normal);
        steps.push_back(step);
        truth.push_back(chart);
    }
};

/// Random points of a chart's square, laid onto a surface.
/// \param lay  (piece, chart position) adds the point
template <class Lay>
Piece scattered(double halfX, double halfZ, double spacing, unsigned seed, const Lay& lay)
{
    std::mt19937                     random(seed);
    std::uniform_real_distribution<> along(-1, 1);
    Piece                            piece;
    for (int n = int(4 * halfX * halfZ / (spacing * spacing)); n > 0; --n) {
        const double x = halfX * along(random);
        lay(piece, ChartPoint{x, halfZ * along(random)});
    }
    return piece;
}

/// A cylinder about an axis along north that lies below the origin; of a negative radius, above it.
Piece cylinder(double radius, double halfX, double halfZ, double spacing, unsigned seed)
{
    return scattered(halfX, halfZ, spacing, seed, [&](Piece& piece, const ChartPoint& at) {
        const glm::dvec3 out(std::sin(at.x / radius), 0, std::cos(at.x / radius));
        piece.add({radius * out.x, at.z, radius * (out.z - 1)}, out, 2 * spacing, at);
    });
}

Piece plane(double half, double spacing, unsigned seed)
{
    return scattered(half, half, spacing, seed, [&](Piece& piece, const ChartPoint& at) {
        piece.add({at.x, at.z, 0}, {0, 0, 1}, 2 * spacing, at);
    });
}

/// A sphere below the origin; its chart has the length and direction of the great circles from there.
Piece sphere(double radius, double reach, double spacing, unsigned seed)
{
    return scattered(reach, reach, spacing, seed, [&](Piece& piece, const ChartPoint& at) {
        // The chart's square has to be filled evenly in the area of the sphere: by Lambert's equal-area map.
        const double     lambert = std::hypot(at.x, at.z), angle = 2 * std::asin(std::min(1.0, lambert / (2 * radius)));
        const double     east = at.x / lambert, north = at.z / lambert, across = std::sin(angle);
        const glm::dvec3 out(across * east, across * north, std::cos(angle));
        piece.add(radius * (out - glm::dvec3(0, 0, 1)), out, 2 * spacing,
                  {radius * angle * east, radius * angle * north});
    });
}

using Mapped = std::vector<std::optional<ChartPoint>>;

Mapped mapped(const Piece& piece, double reach)
{
    return exponentialMap({}, {}, piece.positions, piece.normals, piece.steps, reach);
}

double length(const ChartPoint& p)
{
    return std::hypot(p.x, p.z);
}

double distance(const ChartPoint& a, const ChartPoint& b)
{
    return std::hypot(a.x - b.x, a.z - b.z);
}

/// Errors of a map over all that is truly within its reach.
struct Errors {
    double      largest  = 0; ///< [m]
    double      relative = 0; ///< [1] largest error over distance from the origin
    double      rms      = 0; ///< [m]
    std::size_t missing  = 0; ///< points without a place
    std::size_t count    = 0;

    Errors(const Piece& piece, const Mapped& map, double reach)
    {
        for (std::size_t i = 0; i < map.size(); ++i) {
            if (length(piece.truth[i]) > reach) continue;
            ++count;
            if (!map[i]) {
                ++missing;
                continue;
            }
            const double error = distance(*map[i], piece.truth[i]);
            largest            = worse(largest, error);
            relative           = worse(relative, error > 0 ? error / length(piece.truth[i]) : error);
            rms += error * error;
        }
        rms = std::sqrt(rms / double(std::max<std::size_t>(count, 1)));
    }
};

bool sameBits(const Mapped& a, const Mapped& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
        return p.has_value() == q.has_value() && (!p || std::memcmp(&*p, &*q, sizeof *p) == 0);
    });
}

void addNoise(Piece& piece, double ofPositions, double ofNormals, unsigned seed)
{
    std::mt19937                     random(seed);
    std::normal_distribution<double> normal;
    const auto                       noise = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
    for (glm::dvec3& p : piece.positions) p += ofPositions * noise();
    for (glm::dvec3& n : piece.normals) n = glm::normalize(n + ofNormals * noise());
}

TEST(ExponentialMap, APlaneIsExactToRounding)
{
    const Piece piece = plane(0.02, kSpacing, 1);

    const Errors errors(piece, mapped(piece, 0.02), 0.02 - 1e-9);

    EXPECT_GT(errors.count, 3000u);
    EXPECT_EQ(errors.missing, 0u);
    EXPECT_LE(errors.largest, 1e-16) << "some 60 edges, each rounded to 4e-18 m";
}

TEST(ExponentialMap, ACylinderKeepsItsLengthsAtAnyRadius)
{
    for (const double radius : {-4.0, 4.0, 6.0, 16.0, 100.0}) { // spacings
        const double reach = std::min(0.9 * pi * std::abs(radius), 40.0) * kSpacing;
        const Piece  piece =
            cylinder(radius * kSpacing, std::min(pi * std::abs(radius), 45.0) * kSpacing, 45 * kSpacing, kSpacing, 2);

        const Errors errors(piece, mapped(piece, reach), reach - 1e-9);

        EXPECT_GT(errors.count, 300u);
        EXPECT_EQ(errors.missing, 0u) << radius;
        EXPECT_LE(errors.relative, 1e-7) << radius << ": the series of arcs is right to 2e-8 at half a radian";
    }
}

TEST(ExponentialMap, AFingerIsUnrolledAlmostAllAround)
{
    const double radius = 0.008, reach = 0.9 * pi * radius; // [m]
    const Piece  piece = cylinder(radius, pi * radius, 0.03, kSpacing, 3);

    const Errors errors(piece, mapped(piece, reach), reach - 1e-9);

    EXPECT_EQ(errors.missing, 0u);
    EXPECT_LE(errors.largest, 1e-10) << "steps of an eighth of a radian";
}

TEST(ExponentialMap, WhereTwoWaysAroundMeetPointsTakeOneOfThem)
{
    const double radius = 0.008; // [m]
    const Piece  piece  = cylinder(radius, pi * radius, 0.03, kSpacing, 4);

    const Mapped map = mapped(piece, 0.035);

    for (std::size_t i = 0; i < map.size(); ++i) {
        if (length(piece.truth[i]) > 0.034) continue;
        ASSERT_TRUE(map[i]);
        ChartPoint other = piece.truth[i];
        other.x -= std::copysign(2 * pi * radius, other.x);
        const bool around = distance(*map[i], other) < distance(*map[i], piece.truth[i]);
        EXPECT_LE(distance(*map[i], around ? other : piece.truth[i]), 1e-9) << "no mean of two ways";
        EXPECT_LE(length(*map[i]), length(piece.truth[i]) + piece.steps[i]) << "the shorter one, but for an edge";
    }
}

/// A cylinder whose curvature differs from place to place: z = -height (1 - cos(k x)), with its length tabulated.
Piece wave(double spacing, unsigned seed)
{
    const double height = 0.004, k = 2 * pi / 0.03; // [m], [1/m]
    const auto   slope = [&](double x) { return -height * k * std::sin(k * x); };
    const auto   arc   = [&](double x) { // Simpson's rule: right to 1e-14 m
        constexpr int kParts = 400;
        double        sum    = 0;
        for (int i = 0; i <= kParts; ++i)
            sum += (i == 0 || i == kParts ? 1 : i % 2 == 1 ? 4 : 2) * std::hypot(1, slope(x * i / kParts));
        return sum * x / (3 * kParts);
    };
    return scattered(0.015, 0.015, spacing, seed, [&](Piece& piece, const ChartPoint& at) {
        piece.add({at.x, at.z, -height * (1 - std::cos(k * at.x))}, glm::normalize(glm::dvec3(-slope(at.x), 0, 1)),
                  3 * spacing, {arc(at.x), at.z});
    });
}

TEST(ExponentialMap, ACylinderOfVaryingCurvatureConvergesWithAtLeastThirdOrderInTheSpacing)
{
    const double          reach = 0.012; // [m]
    std::array<double, 3> errors{};
    for (std::size_t k = 0; k < errors.size(); ++k) {
        const Piece  piece = wave(0.0008 / double(1 << k), 5);
        const Errors found(piece, mapped(piece, reach), reach - 1e-4);
        EXPECT_EQ(found.missing, 0u);
        EXPECT_LE(found.relative, 0.01) << k;
        errors[k] = found.rms;
    }
    EXPECT_GT(errors[0], 1e-9) << "there is something to converge";
    for (std::size_t k = 1; k < errors.size(); ++k)
        EXPECT_GT(std::log2(errors[k - 1] / errors[k]), 3) << errors[k - 1] << " to " << errors[k];
}

TEST(ExponentialMap, ASphereIsAzimuthalEquidistantToSecondOrderInTheWindow)
{
    // The same number of points in smaller and smaller windows: the error over the distance is some K d^2 over it.
    const double          radius = 0.05; // [m]
    std::array<double, 4> relative{};
    for (std::size_t k = 0; k < relative.size(); ++k) {
        const double reach = 0.05 / double(1 << k);
        for (const unsigned seed : {6u, 7u, 8u}) {
            const Piece  piece = sphere(radius, 1.1 * reach, reach / 30, seed);
            const Errors errors(piece, mapped(piece, reach), 0.95 * reach);
            EXPECT_EQ(errors.missing, 0u);
            EXPECT_LE(errors.largest, 0.04 * reach * (reach / radius) * (reach / radius));
            relative[k] += errors.rms / reach / 3;
        }
    }
    for (std::size_t k = 1; k < relative.size(); ++k)
        EXPECT_NEAR(std::log2(relative[k - 1] / relative[k]), 2, 0.4) << "terms of fourth order, and chance";
}

TEST(ExponentialMap, ASphereConvergesWithTheSpacing)
{
    const double          radius = 0.05, reach = 0.04; // [m]
    std::array<double, 3> errors{};
    for (std::size_t k = 0; k < errors.size(); ++k)
        for (const unsigned seed : {6u, 7u, 8u, 9u}) {
            const Piece piece = sphere(radius, 0.044, 0.002 / double(1 << k), seed);
            errors[k] += Errors(piece, mapped(piece, reach), 0.038).rms / 4;
        }
    EXPECT_LE(errors[0], 0.01 * reach) << "twenty spacings from the middle to the rim";
    EXPECT_GT(std::log2(errors[0] / errors[2]) / 2, 0.5) << errors[0] << ", " << errors[1] << ", " << errors[2];
}

TEST(ExponentialMap, EdgesAcrossTheWayHardlyLengthenASphere)
{
    const double radius = 0.05; // [m]
    for (const unsigned seed : {6u, 7u, 8u}) {
        const Piece  piece = sphere(radius, 0.044, 0.001, seed);
        const Mapped map   = mapped(piece, 0.042);
        double       sum   = 0;
        int          count = 0;
        for (std::size_t i = 0; i < map.size(); ++i)
            if (map[i] && length(piece.truth[i]) > 0.03 && length(piece.truth[i]) < 0.04) {
                sum += length(*map[i]) - length(piece.truth[i]);
                ++count;
            }

        ASSERT_GT(count, 1000);
        EXPECT_NEAR(sum / count, 0, 3.5e-5) << "2.6e-5 m, where edges that count alike make it 5.1e-5 m";
    }
}

TEST(ExponentialMap, NoiseIsAveragedAway)
{
    for (const double radius : {1e9, 0.02, 0.008})
        for (const unsigned seed : {10u, 11u, 12u}) {
            const double reach = std::min(0.02, 0.9 * pi * radius); // [m]
            Piece        piece = cylinder(radius, std::min(0.021, pi * radius), 0.021, kSpacing, seed);
            addNoise(piece, 0.1 * kSpacing, 3 * pi / 180, seed + 100);

            const Errors errors(piece, mapped(piece, reach), 0.97 * reach);

            EXPECT_EQ(errors.missing, 0u);
            EXPECT_LE(errors.largest, 0.02 * 2 * reach) << "2 % of the window; radius " << radius;
            EXPECT_LE(errors.rms, 0.005 * 2 * reach) << radius;
        }
}

TEST(ExponentialMap, AStepInDensityIsCrossedBothWays)
{
    for (const bool sparseMiddle : {false, true}) {
        const double fine = 0.0002, coarse = 0.004; // [m]
        Piece        piece;
        for (const Piece& half : {plane(0.02, fine, 13), plane(0.04, coarse, 14)})
            for (std::size_t i = 0; i < half.positions.size(); ++i) {
                const double beyond = half.truth[i].x - 0.012; // out of the origin's own step [m]
                const bool   dense = half.steps[i] < 0.001, right = 0 < beyond;
                const bool   gap = !dense && std::abs(beyond) < 0.001; // wider than a fine step
                if (dense == (right == sparseMiddle) && !gap)
                    piece.add(half.positions[i], half.normals[i], half.steps[i], half.truth[i]);
            }

        const Errors errors(piece, mapped(piece, 0.02), 0.02 - 1e-9);

        EXPECT_EQ(errors.missing, 0u) << "of " << errors.count << "; sparse in the middle: " << sparseMiddle;
        EXPECT_LE(errors.largest, 1e-15) << "rounding of 200 edges";
    }
}

TEST(ExponentialMap, AroundAHoleAPlaneStaysExact)
{
    const Piece all = plane(0.02, kSpacing, 15);
    Piece       piece;
    for (std::size_t i = 0; i < all.positions.size(); ++i)
        if (distance(all.truth[i], {0.006, 0.002}) > 0.004)
            piece.add(all.positions[i], all.normals[i], all.steps[i], all.truth[i]);

    const Errors errors(piece, mapped(piece, 0.02), 0.019);

    EXPECT_EQ(errors.missing, 0u);
    EXPECT_LE(errors.largest, 1e-15) << "rounding";
}

TEST(ExponentialMap, TheBackOfAThinSheetIsNotReached)
{
    Piece             piece = plane(0.01, kSpacing, 16);
    const std::size_t front = piece.positions.size();
    for (std::size_t i = 0; i < front; ++i)
        piece.add(piece.positions[i] - glm::dvec3(1e-5, 0, kSpacing), {0, 0, -1}, 2 * kSpacing, {});

    const Mapped map = mapped(piece, 0.01);

    for (std::size_t i = 0; i < map.size(); ++i)
        EXPECT_EQ(map[i].has_value(), i < front && length(piece.truth[i]) <= 0.01) << i;
}

TEST(ExponentialMap, NothingBeyondTheReachHasAPlace)
{
    const double reach = 0.007; // [m]
    const Piece  piece = cylinder(0.008, 0.012, 0.012, kSpacing, 17);

    const Mapped map = mapped(piece, reach);

    std::size_t placed = 0;
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (!map[i]) continue;
        ++placed;
        EXPECT_LE(length(*map[i]), reach);
    }
    EXPECT_NEAR(double(placed), pi * reach * reach / (kSpacing * kSpacing), 75) << "three deviations of a count";
}

/// What lies outside of the window only moves along: it keeps its place roughly, and the inside does not notice.
TEST(ExponentialMap, OutsideOfTheCarefulSquareOnePredictionDoes)
{
    const double reach = 0.014, careful = 0.007; // [m]
    const Piece  piece = sphere(0.03, 1.1 * reach, kSpacing, 31);
    const Mapped all   = mapped(piece, reach);
    const Mapped some  = exponentialMap({}, {}, piece.positions, piece.normals, piece.steps, reach, careful);

    double inside = 0, outside = 0; // [m] largest differences
    int    placed = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        placed += int(some[i].has_value()) - int(all[i].has_value());
        if (!all[i] || !some[i]) continue;
        const bool in  = std::max(std::abs(all[i]->x), std::abs(all[i]->z)) < careful - 2 * kSpacing;
        double&    off = in ? inside : outside;
        off            = worse(off, distance(*all[i], *some[i]));
    }
    EXPECT_LT(inside, 1e-15) << "nothing outside comes before what is two spacings further in";
    EXPECT_GT(outside, 1e-7) << "else all predictions were made";
    EXPECT_LT(outside, 0.05 * reach);
    EXPECT_LT(std::abs(placed), 20) << "of some 2500, at the reach";
}

/// Area of the smallest polygon that holds points.
double hullArea(std::vector<ChartPoint> points)
{
    std::sort(points.begin(), points.end(),
              [](const ChartPoint& a, const ChartPoint& b) { return a.x < b.x || (a.x == b.x && a.z < b.z); });
    const auto twice = [](const ChartPoint& a, const ChartPoint& b, const ChartPoint& c) {
        return (b.x - a.x) * (c.z - a.z) - (b.z - a.z) * (c.x - a.x);
    };
    double area = 0;
    for (int side = 0; side < 2; ++side) {
        std::vector<ChartPoint> hull;
        for (const ChartPoint& p : points) {
            while (hull.size() > 1 && twice(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
            hull.push_back(p);
        }
        for (std::size_t i = 1; i < hull.size(); ++i) area += twice(points.front(), hull[i - 1], hull[i]) / 2;
        for (ChartPoint& p : points) p = {-p.x, -p.z};
        std::reverse(points.begin(), points.end());
    }
    // Each half is its hull's area on one side of the line from the first point to the last.
    return area;
}

TEST(ExponentialMap, AreasOnACylinderAreThoseOfTheSurface)
{
    // Patches here and there on it, each away from the origin, with noise as of a scanner.
    const double radius = 0.008; // [m]
    Piece        piece  = cylinder(radius, 0.015, 0.015, kSpacing / 2, 18);
    addNoise(piece, 0.02 * kSpacing, 0.5 * pi / 180, 19);

    const Mapped map = mapped(piece, 0.02);

    for (const ChartPoint middle : {ChartPoint{0, 0}, {0.008, 0}, {-0.008, 0.006}, {0.001, -0.009}}) {
        std::vector<ChartPoint> surface, chart;
        for (std::size_t i = 0; i < map.size(); ++i)
            if (map[i] && distance(piece.truth[i], middle) < 0.005) {
                surface.push_back(piece.truth[i]);
                chart.push_back(*map[i]);
            }
        ASSERT_GT(surface.size(), 500u);
        EXPECT_NEAR(hullArea(surface), pi * 0.005 * 0.005, 0.04 * pi * 0.005 * 0.005) << "a disc, but for its rim";
        EXPECT_NEAR(hullArea(chart), hullArea(surface), 0.01 * hullArea(surface)) << middle.x << ", " << middle.z;
    }
}

TEST(ExponentialMap, TurnsWithTheFrameAndMovesWithThePoints)
{
    const Piece      piece = cylinder(0.008, 0.02, 0.02, kSpacing, 20);
    const Mapped     truth = mapped(piece, 0.02);
    const glm::dvec3 shift(80, -15, 6); // [m]
    const Frame      frame = Frame::about(glm::normalize(glm::dvec3(1, -2, 0.5)));
    const auto turned = [&](const glm::dvec3& p) { return p.x * frame.east + p.y * frame.north + p.z * frame.normal; };
    Piece      other  = piece;
    for (glm::dvec3& p : other.positions) p = shift + turned(p);
    for (glm::dvec3& n : other.normals) n = turned(n);
    const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);

    const Mapped map =
        exponentialMap(shift, frame.turned(angle), other.positions, other.normals, other.steps, 0.02 + 1e-9);

    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (!truth[i]) continue;
        ASSERT_TRUE(map[i]);
        const ChartPoint expected{c * truth[i]->x + s * truth[i]->z, c * truth[i]->z - s * truth[i]->x};
        EXPECT_LE(distance(*map[i], expected), 1e-12) << "coordinates of 80 m are rounded to 1e-14 m";
    }
}

TEST(ExponentialMap, TheSamePointsHaveTheSameBitsInAnyOrder)
{
    Piece piece = sphere(0.02, 0.02, kSpacing, 21);
    addNoise(piece, 0.1 * kSpacing, 0.05, 22);
    const Mapped map = mapped(piece, 0.018);

    EXPECT_TRUE(sameBits(map, mapped(piece, 0.018))) << "a second time";

    std::vector<std::size_t> order(piece.positions.size());
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(23));
    Piece  shuffled;
    Mapped expected;
    for (const std::size_t i : order) {
        shuffled.add(piece.positions[i], piece.normals[i], piece.steps[i], {});
        expected.push_back(map[i]);
    }
    EXPECT_TRUE(sameBits(mapped(shuffled, 0.018), expected));
}

TEST(ExponentialMap, ALatticeFullOfTiesIsExact)
{
    Piece piece;
    for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j)
            for (int copies = 0; copies < 1 + (i == 3); ++copies) {
                const double x = kSpacing * i, z = kSpacing * j;
                piece.add({x, z, 0}, {0, 0, 1}, 2 * kSpacing, {x, z});
            }

    const Mapped map = mapped(piece, 1);

    for (std::size_t i = 0; i < map.size(); ++i) {
        ASSERT_TRUE(map[i]) << i;
        EXPECT_LE(distance(*map[i], piece.truth[i]), 1e-16) << "rounding; repeated points too";
    }
    EXPECT_TRUE(sameBits(map, mapped(piece, 1)));
}

TEST(ExponentialMap, AnOriginAwayFromThePointsStillFindsTheNearest)
{
    const Piece piece = plane(0.005, kSpacing, 24);

    const Mapped map = exponentialMap({0, 0, 0.003}, {}, piece.positions, piece.normals, piece.steps, 0.004);

    const Errors errors(piece, map, 0.0039);
    EXPECT_EQ(errors.missing, 0u);
    EXPECT_LE(errors.largest, 1e-16) << "what is above the plane is projected onto it";
    EXPECT_TRUE(exponentialMap({}, {}, {}, {}, {}, 1).empty());
    const Mapped none =
        exponentialMap({}, Frame::about({0, 0, -1}), piece.positions, piece.normals, piece.steps, 0.004);
    EXPECT_TRUE(std::none_of(none.begin(), none.end(), [](const auto& p) { return p.has_value(); }))
        << "all normals are opposite to the frame's";
}

TEST(ExponentialMap, BrokenArgumentsAreContractViolationsThatNameThem)
{
    const auto why = [](const Piece& piece, double reach) -> std::string {
        try {
            (void)mapped(piece, reach);
        } catch (const ContractViolation& violation) {
            return violation.what();
        }
        return "nothing thrown";
    };
    const auto contains = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos ? ::testing::AssertionSuccess()
                                                    : ::testing::AssertionFailure() << text;
    };
    const double nan  = std::numeric_limits<double>::quiet_NaN();
    Piece        good = plane(0.001, kSpacing, 25), piece = good;
    good.positions.resize(10), good.normals.resize(10), good.steps.resize(10);
    piece              = good;
    piece.positions[3] = {0, nan, 0};
    EXPECT_TRUE(contains(why(piece, 1), "position 3 of 10"));
    piece            = good;
    piece.normals[4] = {0, 0, 1.001};
    EXPECT_TRUE(contains(why(piece, 1), "normal 4 of 10 has length 1.001"));
    piece          = good;
    piece.steps[5] = -1;
    EXPECT_TRUE(contains(why(piece, 1), "step 5 of 10"));
    piece = good;
    piece.normals.pop_back();
    EXPECT_TRUE(contains(why(piece, 1), "10 positions, 9 normals, 10 steps"));
    EXPECT_TRUE(contains(why(good, nan), "the reach"));
    EXPECT_TRUE(contains(why(good, -1e-9), "the reach"));
    EXPECT_EQ(why(good, 0), "nothing thrown") << "the origin alone";
}

} // namespace
} // namespace palp
