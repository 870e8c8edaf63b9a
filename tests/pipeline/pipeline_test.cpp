#include "engine/pipeline/deform.h"
#include "engine/pipeline/patch_warnings.h"
#include "engine/pipeline/presets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/cloud/samples.h"
#include "engine/core/contract.h"
#include "engine/plate/load.h"
#include "tests/support/errors.h"

namespace palp {
namespace {

/// An object that is touched by the reference solver.
struct Object : SoftObject {
    using SoftObject::SoftObject;

    [[nodiscard]] Patch touch(const glm::dvec3& place, const glm::dvec3& from, const PatchSettings& settings) const
    {
        return deform(*this, touchAt(*this, place, from, 10e-3), settings);
    }
};

Object homogeneous(const char* name, unsigned seed)
{
    const SpatialLaw constant{.kind = SpatialLaw::Kind::constant, .from = 1e6};
    return Object(makeSample(sampleNamed(name), 20'000, seed, constant));
}

/// A bowl seen from inside: radius of curvature 80 mm, noise of 0.1 mm along the normal.
Object noisyBowl(unsigned seed)
{
    std::mt19937_64                        bits(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    std::normal_distribution<double>       noise(0, 1e-4);
    std::vector<glm::dvec3>                points;
    while (points.size() < 15'000) {
        const glm::dvec3 d = glm::normalize(glm::dvec3(0.7 * unit(bits), 0.7 * unit(bits), -1));
        points.push_back((80e-3 + noise(bits)) * d);
    }
    return Object(PointCloud(points, std::vector<double>(points.size(), 1e6), StiffnessKind::modulus));
}

bool warned(const Patch& patch, const PatchSettings& settings, double force, const char* words)
{
    const auto sentences = warnings(patch, settings, force, {.thickness = patch.thickness});
    return std::any_of(sentences.begin(), sentences.end(),
                       [&](const std::string& s) { return s.find(words) != std::string::npos; });
}

const PatchSettings kCoarse{.window = 24e-3, .cells = 32, .footprintRadius = 3e-3};

/// The floor of every perception measurement: on a homogeneous object nothing that sets compliance comes from points.
TEST(Pipeline, ComplianceIsConstantAlongAPathOnHomogeneousObjects)
{
    struct Path {
        Object     object;
        glm::dvec3 start, step, from;
    };
    const Path paths[] = {{homogeneous("ellipsoid", 1), {-10e-3, 3e-3, 35e-3}, {2e-3, 0, 0}, {0, 0, 1}},
                          {homogeneous("sheet", 2), {-10e-3, 3e-3, 0}, {2e-3, 0, 0}, {0, 0, 1}},
                          {noisyBowl(3), {-10e-3, 3e-3, -79e-3}, {2e-3, 0, 0}, {0, 0, 1}}};
    for (Preset preset : {Preset::palpate, Preset::paper})
        for (const Path& path : paths) {
            std::vector<double> compliances;
            for (int n = 0; n <= 10; ++n) {
                const Patch patch =
                    path.object.touch(path.start + double(n) * path.step, path.from, withPreset(kCoarse, preset));
                ASSERT_TRUE(patch.deformed());
                compliances.push_back(patch.compliance);
            }
            const auto [least, most] = std::minmax_element(compliances.begin(), compliances.end());
            EXPECT_LT(*most / *least - 1, 1e-6)
                << "exact up to the rounding of the factorisation, preset " << name(preset);
        }
}

/// Square plate, clamped, point load: w = 0.0056 F a^2/D at the load (Timoshenko); a footprint of finite radius a
/// little less.
TEST(Pipeline, ComplianceOfAFlatSheetIsThatOfAClampedPlate)
{
    const Object        sheet = homogeneous("sheet", 4);
    const PatchSettings settings{.window = 40e-3, .cells = 64, .footprintRadius = 1.3e-3};
    const Patch         patch    = sheet.touch({0, 0, 0}, {0, 0, 1}, settings);
    const double        rigidity = sheet.material().rigidity(1e6);

    EXPECT_EQ(patch.sphere.outcome, FitOutcome::plane);
    EXPECT_NEAR(patch.plate.rigidity(32, 32) / rigidity, 1, 1e-12);
    // 1/178.19 is the exact factor of a point load. The footprint's second moment is R^2/8 = (0.011 a)^2, and
    // w falls as r^2 ln r: the loss is (R^2/8)/(8 pi) ln(a/R) / (a^2/178) ~ 1 %. The grid adds 0.4 % at 64 cells.
    EXPECT_NEAR(patch.compliance * rigidity / (40e-3 * 40e-3) * 178.19, 1, 0.03);
    EXPECT_LT(patch.compliance * rigidity / (40e-3 * 40e-3) * 178.19, 1.005) << "a footprint gives less than a point";
}

TEST(Pipeline, TheFootprintCarriesExactlyOneNewtonInTheMiddle)
{
    const PatchWindow window = PatchWindow::square(24e-3, 32);
    const NodeField   load   = footprintLoad(window.grid, 1, 12e-3, 12e-3, 3e-3);
    double            sum    = 0;
    for (double f : load.values()) sum += f;
    EXPECT_NEAR(sum, 1, 1e-14) << "a sum of some hundred terms";
    EXPECT_GT(load(16, 16), 0);
}

/// What the paper's figure 4 shows.
TEST(Pipeline, DeflectionFallsWhereRigidityRises)
{
    for (SpatialLaw::Kind kind : {SpatialLaw::Kind::linear, SpatialLaw::Kind::hyperbolic}) {
        const SpatialLaw law{.kind = kind, .from = 0.3e6, .to = 3e6, .start = {-60e-3, 0, 0}, .end = {60e-3, 0, 0}};
        const Object     ellipsoid(makeSample(sampleNamed("ellipsoid"), 40'000, 5, law));
        for (Preset preset : {Preset::palpate, Preset::paper}) {
            double last = 1e9;
            for (double x : {-40e-3, -20e-3, 0.0, 20e-3, 40e-3}) {
                const glm::dvec3 place{x, 0, 35e-3 * std::sqrt(1 - x * x / (60e-3 * 60e-3))};
                const Patch      patch =
                    ellipsoid.touch(place, {0, 0, 1}, withPreset({.window = 30e-3, .cells = 48}, preset));
                EXPECT_LT(patch.compliance, 0.9 * last)
                    << "rigidity rises by at least a third from place to place, x = " << x;
                last = patch.compliance;
            }
        }
    }
}

TEST(Pipeline, PointsMoveIntoTheSurfaceByTheFieldAndOnlyInTheWindow)
{
    const Object ellipsoid = homogeneous("ellipsoid", 6);
    const Patch  patch     = ellipsoid.touch({0, 0, 35e-3}, {0, 0, 1}, kCoarse);
    const auto   moved     = displaced(ellipsoid.cloud(), patch, 0.5);
    const auto   depth     = deflections(ellipsoid.cloud(), patch, 0.5);

    std::size_t dented  = 0;
    double      deepest = 0;
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const glm::dvec3 move = moved[i] - ellipsoid.positions()[i];
        EXPECT_NEAR(glm::dot(move, patch.forceDirection()), depth[i], 1e-15) << "rounding of 35 mm";
        EXPECT_NEAR(glm::length(glm::cross(move, patch.forceDirection())), 0, 1e-15);
        dented += depth[i] != 0;
        deepest       = std::max(deepest, depth[i]);
        const auto at = patch.chart.project(ellipsoid.positions()[i]);
        if (!at || !patch.window.holds(*at)) {
            EXPECT_EQ(depth[i], 0) << "outside the window";
        }
    }
    EXPECT_GT(patch.forceDirection().z, -1.01);
    EXPECT_LT(patch.forceDirection().z, -0.99) << "down, at the top of the ellipsoid";
    EXPECT_GT(dented, 300u);
    EXPECT_NEAR(deepest / (0.5 * patch.response(16, 16)), 1, 0.03)
        << "the nearest point is a fraction of a spacing off";
}

TEST(Pipeline, ABowlIsPushedAwayFromTheHand)
{
    const Object bowl  = noisyBowl(7);
    const Patch  patch = bowl.touch({0, 0, -79e-3}, {0, 0, 1}, kCoarse);
    EXPECT_LT(patch.chart.curvature, 0) << "hollow towards the hand";
    EXPECT_NEAR(1 / patch.chart.curvature, -80e-3, 2e-3) << "noise of 0.1 mm on a cap of 17 mm half width";
    EXPECT_LT(patch.forceDirection().z, -0.99);
}

/// Under the finger Gall-Peters stretches by sqrt2 one way and shrinks by it the other. A window fixed in metres of the
/// chart keeps the depth; a window fixed on the object would lose 36 % of it (an independent solution on a 10-degree
/// cap).
TEST(Pipeline, PaperPresetDentsAsDeepButTwiceAsLongAsWide)
{
    const Object ellipsoid = homogeneous("hemisphere", 8);
    const Patch  ours      = ellipsoid.touch({0, 0, 50e-3}, {0, 0, 1}, withPreset(kCoarse, Preset::palpate));
    const Patch  paper     = ellipsoid.touch({0, 0, 50e-3}, {0, 0, 1}, withPreset(kCoarse, Preset::paper));
    EXPECT_NEAR(paper.compliance / ours.compliance, 1, 1e-9) << "the same plate in the chart, but on the object ...";

    const auto halfWidth = [&](const Patch& patch, const glm::dvec3& along) {
        double widest = 0;
        for (std::size_t n = 0; n < patch.points.size(); ++n)
            if (patch.pointResponse[n] > 0.5 * patch.response(16, 16)) {
                const glm::dvec3 d = ellipsoid.positions()[patch.points[n]] - patch.chart.origin;
                widest             = std::max(widest, std::abs(glm::dot(d, along)));
            }
        return widest;
    };
    EXPECT_NEAR(halfWidth(ours, ours.chart.frame.east) / halfWidth(ours, ours.chart.frame.north), 1, 0.1)
        << "point spacing 0.8 of 5 mm";
    EXPECT_NEAR(halfWidth(paper, paper.chart.frame.east) / halfWidth(paper, paper.chart.frame.north), 2, 0.3)
        << "sqrt2 one way and 1/sqrt2 the other, in the limit of small patches";
}

TEST(Pipeline, BordersAreReportedAndBend)
{
    const Object sheet = homogeneous("sheet", 9);
    const Patch  patch = sheet.touch({74e-3, 0, 0}, {0, 0, 1}, kCoarse);
    ASSERT_TRUE(patch.deformed());
    EXPECT_GT(patch.nodesWithoutPoint, 300u) << "almost half of 33 x 33 nodes lie beyond the border";
    const Patch inside = sheet.touch({0, 0, 0}, {0, 0, 1}, kCoarse);
    EXPECT_NEAR(patch.compliance / inside.compliance, 1, 1e-9) << "the rigidity of the nearest point carries on";
    const auto moved = deflections(sheet.cloud(), patch, 1);
    EXPECT_GT(*std::max_element(moved.begin(), moved.end()), 0.8 * patch.response(16, 16));
    EXPECT_TRUE(warned(patch, kCoarse, 0.1, "no point nearby"));
}

TEST(Pipeline, TwoThinSheetsBendTogether)
{
    const Sample& sample = sampleNamed("ear-lobe");
    const Object  lobe(makeSample(sample, sample.points, 1), sample.material);
    PatchSettings settings{.window = sample.window, .cells = 32, .footprintRadius = sample.footprintRadius};
    const Patch   patch = lobe.touch(sample.place, {0, 0, 1}, settings);
    ASSERT_TRUE(patch.deformed());
    std::size_t front = 0, back = 0;
    for (std::size_t n = 0; n < patch.points.size(); ++n)
        if (patch.pointResponse[n] > 0.5 * patch.response(16, 16))
            ++(lobe.positions()[patch.points[n]].z > 0 ? front : back);
    EXPECT_GT(front, 100u);
    EXPECT_GT(back, 100u) << "a lobe is thin: both skins move";
}

// With 300 000 points cells are so wide that the chart lays one point for some.
TEST(Pipeline, NothingOfAFreeLobeStaysBehind)
{
    const Sample&       sample = sampleNamed("ear-lobe");
    const PatchSettings settings{.window          = 28e-3,
                                 .cells           = 64,
                                 .footprintRadius = sample.footprintRadius,
                                 .edges           = {Edge::free, Edge::free, Edge::free, Edge::clamped}};
    for (const std::size_t points : {sample.points, std::size_t(300'000)}) {
        const Object lobe(makeSample(sample, points, 1), sample.material);
        const Patch  patch   = lobe.touch({0, -4e-3, 1.5e-3}, {0, 0, 1}, settings);
        const auto   moved   = deflections(lobe.cloud(), patch, 1);
        const double contact = patch.response(32, 32);
        ASSERT_EQ(patch.coarse != nullptr, points > sample.points);
        double most = 0;
        for (std::size_t n = 0; n < lobe.cloud().size(); ++n) {
            const glm::dvec3& p = lobe.positions()[n];
            if (p.y > 0) continue; // towards the root the window ends inside the lobe
            most = worse(most, moved[n] - responseAt(patch, {p.x, std::max(p.y + 4e-3, -14e-3)}));
        }
        // The unrolled faces are up to 3 % longer than what they cover; the rim, within a thickness of the window, goes
        // along with its edge.
        EXPECT_LT(most, 0.1 * contact) << points;
        EXPECT_FALSE(warned(patch, settings, 0.1, "torn")) << points;
    }
}

TEST(Pipeline, TheWallAndTheBottomOfABoxKeepTheirOwnPlaces)
{
    // Touched 4 mm from the edge of its top: the wall, 10 mm high, and the bottom are unrolled beside it. The bottom
    // faces away from the finger, as the far face of a lobe does, but not that of a sheet of a millimetre.
    std::mt19937_64                        random(3);
    std::uniform_real_distribution<double> along(-30e-3, 30e-3), across(0, 30e-3), down(0, 10e-3);
    std::vector<glm::dvec3>                places;
    for (int n = 0; n < 7200; ++n) {
        places.push_back({along(random), -across(random), 0});
        places.push_back({along(random), -across(random), -10e-3});
        if (n % 3 == 0) places.push_back({along(random), 0, -down(random)});
    }
    const Object box(PointCloud(places, std::vector<double>(places.size(), 1e6), StiffnessKind::modulus), {1e-3, 0.45});
    const Patch  patch = box.touch({0, -4e-3, 0}, {0, 0, 1}, kCoarse);
    std::size_t  wall = 0, bottom = 0;
    for (std::size_t k = 0; k < patch.touched; ++k) {
        const double z = box.positions()[patch.points[k]].z;
        wall += z < -1e-3 && z > -9e-3;
        bottom += z == -10e-3;
        ASSERT_EQ(patch.followed[k].x, patch.positions[k].x);
        ASSERT_EQ(patch.followed[k].z, patch.positions[k].z);
    }
    EXPECT_GT(wall, 100u) << "else nothing was unrolled";
    EXPECT_GT(bottom, 100u);
}

TEST(Pipeline, EitherFaceOfTheLobeIsFeltWithItsOwnStiffness)
{
    const Sample&       sample = sampleNamed("ear-lobe");
    const Object        lobe(makeSample(sample, sample.points, 1), sample.material);
    const PatchSettings settings{.window = sample.window, .cells = 32, .footprintRadius = sample.footprintRadius};
    const glm::dvec3    behind = {sample.place.x, sample.place.y, -sample.place.z};
    const double        front  = lobe.touch(sample.place, {0, 0, 1}, settings).compliance;
    const double        back   = lobe.touch(behind, {0, 0, -1}, settings).compliance;
    // The faces' points are not mirror images, so the means over some hundred of them differ by a few thousandths.
    EXPECT_NEAR(front / back, 2, 0.02) << "twice the modulus; both faces as one would give 1";
}

TEST(Pipeline, WhatIsNoSurfaceIsAnOutcomeAndNotACrash)
{
    std::vector<glm::dvec3> line;
    for (int n = 0; n < 100; ++n) line.push_back({n * 1e-4, 0, 0});
    const Object wire(PointCloud(line, std::vector<double>(100, 1e6), StiffnessKind::modulus));
    const Patch  patch = wire.touch({5e-3, 0, 0}, {0, 0, 1}, kCoarse);
    EXPECT_FALSE(patch.deformed());
    EXPECT_THROW(demandDeformed(patch), Error);
    EXPECT_EQ(displaced(wire.cloud(), patch, 1)[3], line[3]);

    EXPECT_THROW((void)wire.touch({1, 0, 0}, {0, 0, 1}, kCoarse), Error) << "a contact far from the cloud";
}

TEST(Pipeline, AnAnswerWithAnErrorOfATenthIsRefused)
{
    Patch      patch;
    const auto isRefused = [&](std::optional<double> error, bool converged = false) {
        patch.report.errorEstimate = error;
        patch.report.converged     = converged;
        try {
            demandUsable(patch);
        } catch (const Error& refusal) {
            return std::string(refusal.what()).find("is not as good as asked for") != std::string::npos;
        }
        return false;
    };
    EXPECT_TRUE(isRefused(0.88));
    EXPECT_TRUE(isRefused(std::numeric_limits<double>::quiet_NaN()));
    EXPECT_TRUE(isRefused({})) << "nobody knows it";
    EXPECT_FALSE(isRefused(0.01)) << "it has a warning";
    EXPECT_FALSE(isRefused(0.5, true)) << "as good as asked for";
}

TEST(Pipeline, DiscretisationErrorBoundsTheTrueErrorWithinAFactorOfThree)
{
    const Object  skin(makeSample(sampleNamed("skin"), 40'000, 1));
    PatchSettings settings{.foundation = 1.74e6, .window = 70e-3, .footprintRadius = 3.6e-3};
    settings.cells     = 128;
    const Patch fine   = skin.touch({0, 0, 1.5e-3}, {0, 0, 1}, settings);
    settings.cells     = 64;
    const Patch coarse = skin.touch({0, 0, 1.5e-3}, {0, 0, 1}, settings);

    const double truth = std::abs(coarse.compliance / fine.compliance - 1) * 4 / 3; // Richardson, second order
    PlateSolver  reference("reference");
    const auto   estimate = discretisationError(coarse, settings, reference);
    ASSERT_TRUE(estimate.has_value());
    EXPECT_GT(*estimate, truth / 3) << "an estimate may be off, but not by more than a factor of three";
    EXPECT_LT(*estimate, truth * 3);
}

/// Tendons as wide as three cells are averaged out by wider ones, which a coarser grid of the same map would not show.
TEST(Pipeline, DiscretisationErrorCountsWhatIsAveragedOut)
{
    const Object  palm(makeSample(sampleNamed("palm"), 40'000, 1));
    PatchSettings settings{.foundation = 4e6, .window = 67.2e-3, .cells = 40, .footprintRadius = 3.6e-3};
    const Patch   coarse = palm.touch({0, 0, 0}, {0, 0, 1}, settings);
    settings.cells       = 160;
    const double fine    = palm.touch({0, 0, 0}, {0, 0, 1}, settings).compliance;
    settings.cells       = 40;
    PlateSolver  reference("reference");
    const auto   estimate = discretisationError(coarse, settings, reference);
    const double truth    = std::abs(coarse.compliance / fine - 1);
    ASSERT_TRUE(estimate.has_value());
    EXPECT_GT(*estimate, truth / 3) << "0.1 % for 1.3 where the map was not blurred";
    EXPECT_LT(*estimate, truth * 3);
}

TEST(Pipeline, PaperPresetHasNoDifferencesAndOursNamesEachOfThem)
{
    const PatchSettings skin{.foundation = 1e6};
    EXPECT_TRUE(differencesFromPaper(withPreset(skin, Preset::paper)).empty());
    EXPECT_EQ(differencesFromPaper(withPreset(skin, Preset::palpate)).size(), 5u)
        << "map, neighbourhood, resampling, foundation, force law";
}

TEST(Pipeline, DeepDentsAreCalledOutOfTheory)
{
    const Object sheet = homogeneous("sheet", 10);
    const Patch  patch = sheet.touch({0, 0, 0}, {0, 0, 1}, kCoarse);
    const double limit = 0.5 * sheet.material().thickness / patch.response(16, 16);
    EXPECT_FALSE(warned(patch, kCoarse, 0.9 * limit, "Kirchhoff"));
    EXPECT_TRUE(warned(patch, kCoarse, 1.1 * limit, "Kirchhoff"));
}

TEST(Pipeline, AGuessedSideIsOutsideOfClosedObjectsAndCalledAGuessOnOpenOnes)
{
    const auto touch = [](const Object& object, const glm::dvec3& place) {
        return deform(object, touchAt(object, place, {}, 20e-3), kCoarse);
    };
    const Object ellipsoid = homogeneous("ellipsoid", 16);
    for (const glm::dvec3& p : {glm::dvec3(0, 0, 35e-3), glm::dvec3(-60e-3, 0, 0), glm::dvec3(30e-3, -25e-3, -23e-3)}) {
        const Patch patch = touch(ellipsoid, p);
        EXPECT_GT(glm::dot(patch.chart.frame.normal, p), 0) << "away from the middle, at x = " << p.x;
        EXPECT_FALSE(warned(patch, kCoarse, 0.1, "--from"));
    }
    const Object saddle = homogeneous("saddle", 17);
    for (const glm::dvec3& p : {glm::dvec3(0, 0, 0), glm::dvec3(20e-3, 20e-3, 0), glm::dvec3(-20e-3, 20e-3, 0)}) {
        const Patch patch = touch(saddle, p);
        EXPECT_GT(patch.chart.frame.normal.z, 0.5) << "at " << p.x << ", " << p.y;
        EXPECT_TRUE(warned(patch, kCoarse, 0.1, "--from"));
    }
}

TEST(Pipeline, AHandThatComesAlongTheSurfaceIsRefused)
{
    const Object ellipsoid = homogeneous("ellipsoid", 11);
    EXPECT_THROW((void)ellipsoid.touch({0, 0, 35e-3}, {1, 0, 0}, kCoarse), Error);
    EXPECT_THROW((void)ellipsoid.touch({0, 0, 35e-3}, {1, 0, 0.1}, kCoarse), Error) << "84 degrees";
    EXPECT_NO_THROW((void)ellipsoid.touch({0, 0, 35e-3}, {1, 0, 0.4}, kCoarse)) << "68 degrees";
}

TEST(Pipeline, AWindowThatHoldsNextToNothingIsRefused)
{
    const PointCloud        sheet = makeSample(sampleNamed("sheet"), 2000, 12);
    std::vector<glm::dvec3> metres;
    for (const glm::dvec3& p : sheet.positions()) metres.push_back(1000.0 * p);
    const Object large(PointCloud(metres, std::vector<double>(metres.size(), 1e6), StiffnessKind::modulus));
    EXPECT_THROW((void)large.touch(metres[0], {0, 0, 1}, kCoarse), Error) << "millimetres read as metres";

    for (glm::dvec3& p : metres) p *= 1e-6;
    const Object small(PointCloud(metres, std::vector<double>(metres.size(), 1e6), StiffnessKind::modulus));
    EXPECT_THROW((void)small.touch(metres[0], {0, 0, 1}, kCoarse), Error) << "metres read as millimetres";
}

TEST(Pipeline, WhatTheDataOrTheWindowLimitsIsSaid)
{
    const Object sheet(makeSample(sampleNamed("sheet"), 500, 13));
    const Patch  sparse = sheet.touch({0, 0, 0}, {0, 0, 1}, {.window = 60e-3, .cells = 32});
    EXPECT_TRUE(warned(sparse, {.window = 60e-3, .cells = 32}, 0.1, "not in the data")) << "points 7 mm apart";
    const Object        dense(makeSample(sampleNamed("sheet"), 40'000, 1));
    const PatchSettings wideCells{.window = 60e-3, .cells = 16};
    const Patch         averaged = dense.touch({0, 0, 0}, {0, 0, 1}, wideCells);
    EXPECT_TRUE(warned(averaged, wideCells, 0.1, "take more cells")) << "3.75 mm wide";
    EXPECT_FALSE(warned(averaged, wideCells, 0.1, "not in the data"));
    EXPECT_TRUE(warned(sparse, {.window = 60e-3, .cells = 32}, 0.1, "no foundation"));

    PatchSettings open = kCoarse;
    open.foundation    = 1e6;
    open.edges         = {Edge::free, Edge::free, Edge::free, Edge::free};
    const Patch torn   = homogeneous("sheet", 14).touch({0, 0, 0}, {0, 0, 1}, open);
    EXPECT_TRUE(warned(torn, open, 0.1, "torn"));
    EXPECT_FALSE(warned(torn, open, 0.1, "no foundation"));

    const PatchSettings wide{.window = 120e-3, .cells = 32, .neighbourhood = Neighbourhood::ball};
    const Patch         whole = homogeneous("ellipsoid", 15).touch({0, 0, 35e-3}, {0, 0, 1}, wide);
    EXPECT_TRUE(warned(whole, wide, 0.1, "off the fitted sphere"));
}

/// The wart's top lies off the sphere by far more than a touch elsewhere: an even share has to say what all points do.
TEST(Pipeline, DensePointsFeelAsTheirEvenShareDoes)
{
    const Sample&           sample = sampleNamed("skin");
    const Object            skin(makeSample(sample, 100'000, 1));
    const PatchSettings     settings{.foundation      = sample.foundation,
                                     .window          = sample.window,
                                     .cells           = 100,
                                     .footprintRadius = sample.footprintRadius};
    const Patch             patch = skin.touch(sample.place, {0, 0, 1}, settings);
    std::vector<glm::dvec3> places;
    std::vector<double>     weights;
    const double            radius = std::sqrt(2.0) * settings.window / 2 + 4 * patch.spacing;
    for (const std::uint32_t point : patch.gathered) {
        const glm::dvec3 d = skin.positions()[point] - patch.sphere.fit.reference;
        places.push_back(skin.positions()[point]);
        weights.push_back(std::pow(std::max(0.0, 1 - glm::dot(d, d) / (radius * radius)), 2));
    }
    ASSERT_GT(patch.gathered.size(), 20'000u);

    const SphereFitResult all = fitSphereThrough(patch.sphere.fit.reference, places, weights);
    EXPECT_GT(all.fit.misfit, 0.1e-3) << "else every share says the same";
    EXPECT_NEAR(patch.sphere.fit.curvature / all.fit.curvature, 1, 5e-3) << "2000 points of a surface that differs";
    EXPECT_GT(glm::dot(glm::normalize(patch.sphere.fit.gradient), glm::normalize(all.fit.gradient)), 1 - 1e-6);
}

TEST(Pipeline, ResponsesOfManyPlacesAreThoseOfEach)
{
    PatchSettings open             = kCoarse;
    open.foundation                = 1e6;
    open.edges                     = {Edge::free, Edge::free, Edge::free, Edge::free}; // the sides move as well
    const Patch             patch  = homogeneous("sheet", 16).touch({0, 0, 0}, {0, 0, 1}, open);
    std::vector<ChartPoint> places = patch.positions;
    const double            half   = kCoarse.window / 2;
    for (const double x : {-half, half, -1.01 * half, 1.01 * half}) places.push_back({x, -x});
    const std::vector<double> responses = responsesAt(patch, places);
    for (std::size_t n = 0; n < places.size(); ++n)
        ASSERT_NEAR(responses[n], responseAt(patch, places[n]), 1e-13 * patch.compliance) << "rounding, of " << n;
}

} // namespace
} // namespace palp
