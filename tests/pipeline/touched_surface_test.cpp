// Real objects: bodies with two faces, uneven points, rims. Lengths are in metres; the clouds are random.

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/cloud/samples.h"
#include "engine/core/contract.h"
#include "engine/pipeline/deform.h"
#include "engine/pipeline/detail/touched_surface.h"
#include "engine/pipeline/patch_warnings.h"
#include "engine/pipeline/presets.h"

namespace palp {
namespace {

constexpr double kSoft = 0.3e6; ///< [Pa]
constexpr double kEdge = 60e-3; ///< of the sheets [m]

const PatchSettings kTouch{.window = 30e-3, .cells = 32, .footprintRadius = 4e-3};

using Points = std::vector<glm::dvec3>;

/// Points and stiffnesses that grow sheet by sheet.
struct Cloud {
    Points              points;
    std::vector<double> moduli; ///< [Pa]

    template <class Law>
    void add(const Points& more, Law&& law)
    {
        for (const glm::dvec3& p : more) {
            points.push_back(p);
            moduli.push_back(law(p));
        }
    }
    [[nodiscard]] SoftObject object() const { return SoftObject(PointCloud(points, moduli, StiffnessKind::modulus)); }
};

double uniform(const glm::dvec3&)
{
    return kSoft;
}

/// A tenfold wart of 3 mm (standard deviation) about the z axis.
double wart(const glm::dvec3& p)
{
    return kSoft * (1 + 9 * std::exp(-(p.x * p.x + p.y * p.y) / (2 * 3e-3 * 3e-3)));
}

/// Returns random points on the square of edge kEdge about (0, 0, z).
Points sheet(std::size_t count, double z, std::uint64_t seed)
{
    std::mt19937_64                  random(seed);
    std::uniform_real_distribution<> place(-kEdge / 2, kEdge / 2);
    Points                           points;
    for (std::size_t n = 0; n < count; ++n) {
        const double x = place(random);
        points.emplace_back(x, place(random), z);
    }
    return points;
}

Patch touch(const SoftObject& object, const glm::dvec3& place, const glm::dvec3& from,
            const PatchSettings& settings = kTouch)
{
    return deform(object, {place, from}, settings);
}

/// Thin bodies are what one touches: the other face moves, but its stiffness is not felt. Gaps in spacings of 0.42 mm:
/// 7, 2, 1 and a half.
TEST(TouchedSurface, AWartBeforeAPlainBackFeelsLikeItsOwnSheet)
{
    constexpr std::size_t kPoints = 20'000;
    Cloud                 front, back;
    front.add(sheet(kPoints, 0, 1), wart);
    back.add(sheet(kPoints, 0, 2), uniform);
    const double wartAlone = touch(front.object(), {0, 0, 0}, {0, 0, 1}).feltStiffness;
    const double backAlone = touch(back.object(), {0, 0, 0}, {0, 0, -1}).feltStiffness;
    ASSERT_GT(wartAlone, 1.4 * backAlone);
    for (const double gap : {3e-3, 0.85e-3, 0.42e-3, 0.21e-3}) {
        Cloud both = front;
        both.add(sheet(kPoints, -gap, 2), uniform);
        const SoftObject body = both.object();
        // A point in a hundred or so has no layer of its own, so one in some hundred of the other face takes part.
        EXPECT_NEAR(touch(body, {0, 0, 0}, {0, 0, 1}).feltStiffness / wartAlone, 1, 0.01) << gap;
        EXPECT_NEAR(touch(body, {0, 0, -gap}, {0, 0, -1}).feltStiffness / backAlone, 1, 0.01) << gap;
    }
}

TEST(TouchedSurface, BothFacesOfAThinBodyMoveTogether)
{
    Cloud both;
    both.add(sheet(20'000, 0, 1), wart);
    both.add(sheet(20'000, -1e-3, 2), uniform);
    const SoftObject    body  = both.object();
    const Patch         patch = touch(body, {0, 0, 0}, {0, 0, 1});
    std::vector<double> moved = deflections(body.cloud(), patch, 1);
    const auto          under = [&](std::size_t begin, std::size_t end) {
        double sum   = 0;
        int    count = 0;
        for (std::size_t n = begin; n < end; ++n)
            if (std::hypot(both.points[n].x, both.points[n].y) < 3e-3) {
                sum += moved[n];
                ++count;
            }
        return sum / count;
    };
    EXPECT_NEAR(under(20'000, 40'000) / under(0, 20'000), 1, 0.02) << "the mean over a disc of 150 random points";
}

TEST(TouchedSurface, ALayerBehindTheNamedPlaceIsTold)
{
    Cloud both;
    both.add(sheet(20'000, 0, 1), wart);
    both.add(sheet(20'000, -0.4e-3, 2), uniform);
    const SoftObject body = both.object();
    const auto       told = [&](const glm::dvec3& from) {
        const auto said = warnings(touch(body, {0, 0, 0}, from), PatchSettings{}, 0.1, body.material());
        return std::ranges::any_of(said, [](const std::string& s) { return s.find("another layer") != s.npos; });
    };
    EXPECT_TRUE(told({0, 0, -1})) << "the place is in front, the finger behind: the back is what it touches";
    EXPECT_FALSE(told({0, 0, 1}));
}

/// A box with six faces of random points; the 40 by 40 mm faces lie at z = +-10 mm.
Cloud box(std::size_t count, std::uint64_t seed)
{
    std::mt19937_64                  random(seed);
    std::uniform_real_distribution<> unit(-1, 1), pick(0, 1);
    Points                           points;
    const glm::dvec3                 half(20e-3, 20e-3, 10e-3);
    for (std::size_t n = 0; n < count; ++n) {
        glm::dvec3   p(unit(random), unit(random), unit(random));
        const double which = pick(random);
        const int    axis  = which < 0.5 ? 2 : which < 0.75 ? 0 : 1; // by area: 2 of 4 parts are top and bottom
        p[axis]            = p[axis] < 0 ? -1 : 1;
        points.push_back(p * half);
    }
    Cloud cloud;
    cloud.add(points, uniform);
    return cloud;
}

/// The sphere through all points of the ball has a radius of 18 mm, and its top lies 12 mm under the finger: a wart of
/// 5 mm is solved as one of 3 mm.
TEST(TouchedSurface, TheFlatFaceOfABoxIsFlat)
{
    const SoftObject body  = box(60'000, 3).object();
    const Patch      patch = touch(body, {0, 0, 10e-3}, {0, 0, 1});
    EXPECT_LT(glm::length(patch.chart.origin - glm::dvec3(0, 0, 10e-3)), 0.02 * kTouch.window);
    double stretched = 0, inside = 0; // [m^2] of chart over the face
    for (std::size_t n = 0; n < patch.touched; ++n) {
        const glm::dvec3& p = (patch.coarse ? patch.coarse->object() : body).positions()[patch.points[n]];
        if (p.z < 9.9e-3 || std::hypot(p.x, p.y) > 10e-3) continue;
        stretched += std::hypot(patch.positions[n].x, patch.positions[n].z);
        inside += std::hypot(p.x, p.y);
    }
    EXPECT_NEAR(stretched / inside, 1, 0.03) << "a wart keeps its size";
}

/// The radius of a bumpy ball [m], features of some 8 mm.
double bumpyRadius(const glm::dvec3& d)
{
    return 30e-3 + 3e-3 * std::sin(9 * d.x) * std::sin(8 * d.y + 1) * std::cos(7 * d.z);
}

TEST(TouchedSurface, TheChartsOriginIsAtTheContact)
{
    std::mt19937_64            random(4);
    std::normal_distribution<> normal;
    const auto                 direction = [&] {
        const double x = normal(random), y = normal(random);
        return glm::normalize(glm::dvec3(x, y, normal(random)));
    };
    Cloud  cloud;
    Points points;
    for (int n = 0; n < 40'000; ++n) {
        const glm::dvec3 d = direction();
        points.push_back(bumpyRadius(d) * d);
    }
    cloud.add(points, uniform);
    const SoftObject    body = cloud.object();
    std::vector<double> off; // [windows]
    for (int n = 0; n < 100; ++n) {
        const glm::dvec3 d = direction(), place = bumpyRadius(d) * d;
        const Patch      patch = deform(body, {place, d, true, true}, kTouch);
        ASSERT_TRUE(patch.deformed());
        off.push_back(glm::length(patch.chart.origin - place) / kTouch.window);
    }
    std::ranges::sort(off);
    EXPECT_LT(off[90], 0.02);
    EXPECT_LT(off.back(), 0.1);
}

/// Of very many points an even share makes the sphere: it is the one that all points of a sparser cloud make.
TEST(TouchedSurface, AnEvenShareOfManyPointsFindsTheSameSphere)
{
    const auto bowl = [](std::size_t count, std::uint64_t seed) {
        Points points = sheet(count, 0, seed);
        for (glm::dvec3& p : points) p.z = (p.x * p.x + 1.2 * p.y * p.y) / (2 * 0.05); // radii of 50 and 42 mm
        return points;
    };
    const auto curvature = [&](std::size_t count, std::uint64_t seed) {
        Cloud cloud;
        cloud.add(bowl(count, seed), uniform);
        PatchSettings settings = kTouch;
        settings.cells         = 128; // so that the points are not too many for the grid
        const Patch patch      = touch(cloud.object(), {0, 0, 0}, {0, 0, 1}, settings);
        EXPECT_GT(double(patch.gathered.size()), 0.3 * double(count));
        EXPECT_FALSE(patch.coarse);
        return std::abs(patch.sphere.fit.curvature);
    };
    const double few = curvature(8000, 41), many = curvature(60'000, 42); // 3100, all of which count, and 23 500
    EXPECT_NEAR(many / few, 1, 0.015) << "random points scatter it by 0.6 %, a share that is not even by 9 %";
}

/// A fifth of the spacing on one side of a line: 20 times as close along it. No place of the sheet is without an
/// answer, and a homogeneous one answers alike.
TEST(TouchedSurface, ADensityThatVariesIsNoHole)
{
    std::mt19937_64                  random(5);
    std::uniform_real_distribution<> place(-kEdge / 2, kEdge / 2);
    Cloud                            cloud;
    Points                           points;
    for (int n = 0; n < 200'000; ++n) {
        const double x = place(random), y = place(random);
        if (x > 0 || n < 500) points.emplace_back(x, y, 0); // spacings of 0.13 and 2.7 mm
    }
    cloud.add(points, uniform);
    const SoftObject body = cloud.object();
    const double     here = touch(body, {10e-3, 0, 0}, {0, 0, 1}).compliance;
    for (const double x : {-12e-3, -6e-3, -2e-3, 0.0, 2e-3, 6e-3}) {
        const Patch patch = touch(body, {x, 0, 0}, {0, 0, 1});
        ASSERT_TRUE(patch.deformed()) << x;
        EXPECT_NEAR(patch.compliance / here, 1, 1e-6) << x << ": homogeneous";
        EXPECT_LT(double(patch.nodesWithoutPoint), 0.02 * double(patch.plate.grid.nodes())) << x << ": no hole";
    }
}

/// At the rim of a thin body the points around determine a surface across the hand's. The proxy's normal stands in.
TEST(TouchedSurface, AStrayPointFarAwayCostsNothing)
{
    Cloud cloud;
    cloud.add(sheet(5'000, 0, 3), wart);
    const double alone = deform(cloud.object(), {glm::dvec3(0), {0, 0, 1}}, kTouch).feltStiffness;
    cloud.add({{0, 0, -1e8}, {1e8, 3, 2}}, uniform); // a scanner's error, or a wrong unit
    // Balls in turn along the way to it would be 1e10.
    const Patch beside = deform(cloud.object(), {glm::dvec3(0), {0, 0, 1}}, kTouch);
    EXPECT_NEAR(beside.feltStiffness / alone, 1, 1e-3) << "the survey counts them: two of 5000";
}

TEST(TouchedSurface, AWindowBetweenThePointsIsRefused)
{
    Cloud cloud;
    cloud.add(sheet(5'000, 0, 3), uniform);
    const SoftObject    object = cloud.object();
    const PatchSettings tiny{.window = 1e-7, .cells = 8, .footprintRadius = 2e-8}; // no point lies in it
    Contact             contact{glm::dvec3(0.2e-3, 0.1e-3, 0), {0, 0, 1}};
    for (const bool felt : {false, true}) {
        contact.felt = felt;
        try {
            EXPECT_FALSE(deform(object, contact, tiny).deformed());
        } catch (const Error&) { // one sentence is as good
        }
    }
}

TEST(TouchedSurface, TheRimOfAThinBodyIsTouched)
{
    Cloud plate;
    plate.add(sheet(20'000, 0, 6), uniform);
    plate.add(sheet(20'000, -1e-3, 7), uniform);
    Points rim;
    for (const glm::dvec3& p : sheet(700, 0, 8)) rim.emplace_back(kEdge / 2, p.y, -1e-3 * (p.x / kEdge + 0.5));
    plate.add(rim, uniform);
    const SoftObject body  = plate.object();
    const Patch      patch = deform(body, {{kEdge / 2, 0, -0.5e-3}, {1, 0, 0}, true, true}, kTouch);
    ASSERT_TRUE(patch.deformed());
    EXPECT_GT(patch.feltStiffness, 0);
    EXPECT_GT(glm::dot(patch.chart.frame.normal, glm::dvec3(1, 0, 0)), 0.5);
}

/// Beside a sharp rim: the wall behind it must not come to lie over the place that is touched.
TEST(TouchedSurface, TheStiffnessBesideARimIsThatOfThePlaceInEveryWindow)
{
    constexpr double kAngle = 1.2;                                  // [rad] 70 degrees of body between face and wall
    const glm::dvec3 down{-std::cos(kAngle), 0, -std::sin(kAngle)}; // along the wall, away from the rim at x = z = 0
    Cloud            cloud;
    for (const glm::dvec3& p : sheet(40'000, 0, 11)) {
        const double along = p.x + kEdge / 2; // 0 at the rim, to 60 mm away from it
        cloud.add({{-along, p.y, 0}}, [](const glm::dvec3& q) { return wart(q + glm::dvec3(2e-3, 0, 0)); });
    }
    for (const glm::dvec3& p : sheet(40'000, 0, 12)) {
        const double along = p.x + kEdge / 2;
        cloud.add({along * down + glm::dvec3(0, p.y, 0)}, uniform);
    }
    const SoftObject body  = cloud.object();
    double           first = 0;
    for (const double window : {20e-3, 24e-3, 30e-3, 40e-3}) {
        PatchSettings settings = kTouch;
        settings.window        = window;
        settings.cells         = 2 * int(std::lround(window / 2e-3)); // of 1 mm in each window
        const Patch patch      = deform(body, {{-2e-3, 0, 0}, glm::normalize(glm::dvec3(0.5, 0, 0.9))}, settings);

        if (first == 0) first = patch.contactStiffness;
        EXPECT_NEAR(patch.contactStiffness / first, 1, 0.03)
            << window << " m: what lies behind the rim is as soft as kSoft";
        EXPECT_GT(patch.plate.rigidity(settings.cells / 2, settings.cells / 2) / body.material().rigidity(kSoft), 8)
            << "in the middle of a tenfold wart";
    }
}

/// Beside an edge the mean points of large cubes would round it.
TEST(DenseCloud, KeepsItsEdges)
{
    Cloud cloud;
    for (const glm::dvec3& p : sheet(250'000, 0, 7)) cloud.add({p.x > 0 ? glm::dvec3(0, p.y, -p.x) : p}, uniform);
    const SoftObject body = cloud.object();
    const double     cell = kTouch.window / kTouch.cells;
    const Patch      flat = deform(body, {{-15e-3, 0, 0}, {0, 0, 1}}, kTouch);
    const Patch      edge = deform(body, {{-1e-3, 0, 0}, {0, 0, 1}}, kTouch);
    ASSERT_TRUE(flat.coarse);
    EXPECT_GT(flat.coarse->side(), 0.5 * cell);
    EXPECT_LE(flat.coarse->side(), cell);
    EXPECT_TRUE(!edge.coarse || edge.coarse->side() <= 0.25 * cell);
}

/// Noise that reaches from one cube into the next would make two surfaces of one.
TEST(DenseCloud, KeepsItsPointsWhereTheyAreNoisy)
{
    const double cell = kTouch.window / kTouch.cells;
    for (const double noise : {0.05, 0.15}) { // [cells]
        std::mt19937_64            random(3);
        std::normal_distribution<> normal(0, noise * cell);
        Cloud                      cloud;
        for (const glm::dvec3& p : sheet(90'000, 0, 6)) cloud.add({p + glm::dvec3(0, 0, normal(random))}, uniform);
        const Patch patch = deform(cloud.object(), {{1e-3, 1e-3, 0}, {0, 0, 1}}, kTouch);
        EXPECT_EQ(patch.coarse != nullptr, noise < 0.1) << noise;
    }
}

/// A cloud that is far denser than the grid is touched by a point or so per cell, and all of it moves.
TEST(DenseCloud, FeelsAsTheSparseOneAndMovesSmoothly)
{
    Cloud sparse, dense;
    sparse.add(sheet(8'000, 0, 5), wart);
    dense.add(sheet(300'000, 0, 6), wart);
    const SoftObject few = sparse.object(), many = dense.object();
    for (const double x : {0.0, 4e-3}) {
        const Contact contact{{x, 1e-3, 0}, {0, 0, 1}};
        const Patch   one = deform(few, contact, kTouch), other = deform(many, contact, kTouch);
        ASSERT_FALSE(one.coarse);
        ASSERT_TRUE(other.coarse);
        EXPECT_LT(other.points.size(), 4 * one.points.size()) << "38 times as dense";
        EXPECT_NEAR(other.feltStiffness / one.feltStiffness, 1, 0.02)
            << "the log mean over cells of 0.94 mm beside that over random points 0.67 mm apart";

        const std::vector<double> moved  = deflections(many.cloud(), other, 1);
        std::size_t               inside = 0;
        for (std::size_t i = 0; i < moved.size(); ++i) {
            const auto place = other.chart.project(many.positions()[i]);
            ASSERT_TRUE(place);
            if (!other.window.holds(*place)) continue;
            ++inside;
            ASSERT_NEAR(moved[i], responseAt(other, *place), 1e-3 * other.compliance);
        }
        EXPECT_GT(inside, 70'000u);
    }
}

/// Cubes' means are smoothed as the points themselves would be, so that a touch by cubes and one by points, as a place
/// with a few more points beside has, feel the same sharp disc.
TEST(DenseCloud, FeelsASharpDiscAsAllOfItsPointsDo)
{
    const auto disc = [](const glm::dvec3& p) { return std::hypot(p.x, p.y) < 4e-3 ? 100 * kSoft : kSoft; };
    struct Case {
        std::size_t points;
        int         cells;
        double      side, tolerance; ///< [cells], [1]
    };
    for (const Case& c : {Case{120'000, 28, 0.91, 0.02},
                          {120'000, 32, 0.52, 0.005},
                          {120'000, 42, 0.68, 0.005},
                          {120'000, 60, 0.98, 0.005},
                          {60'000, 32, 1.04, 0.025}}) { // the last too sparse for 0.52
        Cloud cloud;
        cloud.add(sheet(c.points, 0, 5), disc);
        const SoftObject body = cloud.object();
        PatchSettings    some = kTouch;
        some.cells            = c.cells;
        PatchSettings all     = some;
        all.neighbourhood     = Neighbourhood::ball; // takes the points themselves
        for (const double x : {0.0, 1e-3, 2.5e-3, 4e-3, 5e-3, 6.5e-3}) {
            const Contact contact{{x, 0.3e-3, 0}, {0, 0, 1}};
            const Patch   cubes = deform(body, contact, some), points = deform(body, contact, all);
            ASSERT_TRUE(cubes.coarse);
            ASSERT_FALSE(points.coarse);
            EXPECT_NEAR(cubes.coarse->side() * c.cells / kTouch.window, c.side, 0.01);
            EXPECT_NEAR(cubes.feltStiffness / points.feltStiffness, 1, c.tolerance)
                << c.points << " points, " << c.cells << " cells, at " << x;
        }
    }
}

/// A flood costs ten times as much. The ball reaches far down the sides, and its points come in any order.
TEST(TouchedSurface, ABallOfACurvedSurfaceIsTakenWhole)
{
    const Sample&    sample = sampleNamed("ellipsoid");
    const SoftObject object(makeSample(sample, 40'000, 1), sample.material);
    Ball             ball{{}, {}, sample.place, 30e-3};
    object.index().gatherRanks(ball.centre, ball.radius, ball.ranks);
    object.index().pointsOf(ball.ranks, ball.points);
    EXPECT_TRUE(touchedSurface(object, {sample.place, {0, 0, 1}}, ball).whole());
    std::reverse(ball.ranks.begin(), ball.ranks.end());
    std::reverse(ball.points.begin(), ball.points.end());
    EXPECT_TRUE(touchedSurface(object, {sample.place, {0, 0, 1}}, ball).whole());
}

} // namespace
} // namespace palp
