// Sheets: pressed and slid over, clean, noisy, two behind one another. Thresholds in spacings and degrees; in brackets
// what our own prototype measured on such clouds, where it is known.
#include <gtest/gtest.h>

#include "tests/contact/proxy_scenes.h"

namespace palp {
namespace {

using namespace proxytest;

struct SheetCase {
    Layout layout = Layout::random;
    double noise  = 0; ///< [spacings] standard deviation
    double gap    = 0; ///< [spacings] to a second sheet behind; 0: none
    double hole   = 0; ///< [spacings] diameter, in the first sheet
    double depth  = 5; ///< [spacings]
};

Points sheetOf(Layout layout, std::uint64_t seed, double noise)
{
    Sheet  sheet(layout, seed);
    Points points = sheet.whole();
    if (noise > 0) addNoise(points, noise, sheet.random());
    return points;
}

Points pointsOf(const SheetCase& scene, std::uint64_t seed)
{
    Points points = sheetOf(scene.layout, seed, scene.noise);
    if (scene.hole > 0) cutHole(points, 0.5 * scene.hole);
    if (scene.gap > 0) append(points, sheetOf(scene.layout, seed + 500, scene.noise), {0, 0, -scene.gap});
    return points;
}

/// Eight clouds, 20 spacings each at 0.1 and 0.5 per tick.
Runs slides(const SheetCase& scene, ProxyForm form = ProxyForm::hybrid)
{
    Runs runs;
    for (int seed = 0; seed < kSeeds; ++seed) {
        // The object lies askew to the axes' planes, as no height is exactly zero in the world.
        Touch touch(pointsOf(scene, kFirstSeed + std::uint64_t(seed)), {form}, {3.7, -2.9, 13.3});
        for (const double speed : {0.1, 0.5}) runs.add(slideFlat(touch, {-10, 0.3, 0}, {20, 0, 0}, scene.depth, speed));
    }
    return runs;
}

TEST(ProxySheets, APlaneIsAPlaneAtEveryDepth)
{
    for (const Layout layout : {Layout::lattice, Layout::random})
        for (const double depth : {5.0, 10.0, 40.0}) {
            const Runs runs = slides({layout, 0, 0, 0, depth});
            SCOPED_TRACE(record(runs, "depth " + std::to_string(depth)));
            EXPECT_EQ(runs.popped, 0);
            EXPECT_LT(runs.worstAngle, 0.1);
            EXPECT_LT(runs.worstRipple, 0.001);
            EXPECT_LT(runs.worstLag, 0.01);
        }
}

TEST(ProxySheets, NoiseIsSmoothedAndLeftBehindLittle)
{
    const Runs runs = slides({Layout::random, 0.2, 0, 0, 5});
    SCOPED_TRACE(record(runs));
    EXPECT_EQ(runs.popped, 0);
    EXPECT_LT(runs.all.angle(), 0.6) << "recorded: 0.28; without the touch scale 2.0";
    EXPECT_LT(runs.worstRipple, 0.03) << "recorded: 0.019; without the touch scale 0.049";
    EXPECT_LT(runs.worstLag, 0.12) << "recorded: 0.060; without the touch scale 0.52";
}

TEST(ProxySheets, NoiseDoesNotLetADeepHandThrough)
{
    const Runs runs = slides({Layout::random, 0.2, 0, 0, 40});
    SCOPED_TRACE(record(runs));
    EXPECT_EQ(runs.popped, 0);
    EXPECT_LT(runs.worstLag, 1) << "depth times the error of the slope; recorded: 0.47, without the touch scale 4.1";
}

/// How far the proxy moves under a hand that has stopped on noise; infinite if it is lost. The noise is too little to
/// be averaged over a touch scale.
double chatter(int seed, double depth, ProxyForm form)
{
    Touch touch(pointsOf({Layout::random, 0.1}, kFirstSeed + std::uint64_t(seed)), {form});
    slideFlat(touch, {-5, 0.3, 0}, {5, 0, 0}, depth, 0.1);
    glm::dvec3 low(1e9), high(-1e9);
    for (int tick = 0; tick < 60; ++tick) {
        touch.step(touch.hip());
        if (tick < 40) continue;
        low  = glm::min(low, touch.at());
        high = glm::max(high, touch.at());
    }
    return touch.touching() ? glm::length(high - low) : HUGE_VAL;
}

TEST(ProxySheets, AStillHandIsStill)
{
    for (int seed = 0; seed < kSeeds; ++seed)
        for (const double depth : {5.0, 40.0})
            EXPECT_LT(chatter(seed, depth, ProxyForm::hybrid), 1e-4) << "seed " << seed << ", depth " << depth;
}

TEST(ProxySheets, ThePapersFormIsRestlessUnderADeepHand)
{
    int restless = 0;
    for (int seed = 0; seed < 2 * kSeeds; ++seed) restless += chatter(seed, 40, ProxyForm::sphere) > 0.1;
    record("restless: " + std::to_string(restless));
    EXPECT_GE(restless, 1) << "of 16 move by more than 0.1, a thousand times what is allowed; recorded: 5";
}

TEST(ProxySheets, TheNearOneOfTwoIsFelt)
{
    for (const double gap : {2.0, 3.0})
        for (const double beyond : {5.0, 20.0}) {
            const Runs runs = slides({Layout::random, 0, gap, 0, gap + beyond});
            SCOPED_TRACE(record(runs, "gap " + std::to_string(gap) + ", " + std::to_string(beyond) + " beyond"));
            EXPECT_EQ(runs.popped, 0);
            EXPECT_LT(runs.worstRipple, 0.001);
        }
    EXPECT_EQ(slides({Layout::random, 0.1, 2, 0, 22}).popped, 0);
    EXPECT_EQ(slides({Layout::random, 0.2, 3, 0, 23}).popped, 0);
}

TEST(ProxySheets, AHoleIsBridged)
{
    for (const Layout layout : {Layout::lattice, Layout::random})
        for (const SheetCase& scene : {SheetCase{layout, 0, 0, 3, 5}, SheetCase{layout, 0, 0, 3, 20},
                                       SheetCase{layout, 0, 0, 6, 5}, SheetCase{layout, 0, 2, 6, 5}}) {
            const Runs runs = slides(scene);
            SCOPED_TRACE(record(runs, "hole " + std::to_string(scene.hole) + ", depth " + std::to_string(scene.depth)));
            EXPECT_EQ(runs.popped, 0);
            EXPECT_LT(runs.all.forceStep / scene.depth, 0.1) << "prototype: 0.06";
        }
}

// Where the paper's form fails, or the cases above would be too easy.
TEST(ProxySheets, ThePapersFormLosesTheSurface)
{
    // Not among them: noise of 0.2 and more on either sheet, which is averaged before any form sees the points.
    const struct {
        const char* name;
        SheetCase   scene;
        int         least; ///< runs lost of 16; half of those recorded, as what is random may fall otherwise
    } cases[] = {
        {"random, depth 40", {Layout::random, 0, 0, 0, 40}, 1},
        {"noise, depth 40", {Layout::random, 0.1, 0, 0, 40}, 2},
        {"two sheets 2 apart, 20 beyond", {Layout::random, 0, 2, 0, 22}, 1},
        {"two sheets 3 apart, 20 beyond", {Layout::random, 0, 3, 0, 23}, 2},
        {"two noisy sheets 2 apart, 20 beyond", {Layout::random, 0.1, 2, 0, 22}, 1},
        {"hole of 3, depth 20", {Layout::random, 0, 0, 3, 20}, 7},
        {"hole of 6", {Layout::random, 0, 0, 6, 5}, 8},
    };
    for (const auto& [name, scene, least] : cases) {
        const Runs runs = slides(scene, ProxyForm::sphere);
        EXPECT_GE(runs.popped, least) << record(runs, name);
    }
    const Runs behind = slides({Layout::random, 0, 2, 6, 5}, ProxyForm::sphere);
    SCOPED_TRACE(record(behind, "hole of 6 over a second sheet"));
    EXPECT_GT(behind.all.forceStep / 5, 0.5) << "held by the second sheet, but with a step; 0.1 is allowed";
}

TEST(ProxySheets, ThePapersFormIsRoughWhereThePointsAreRandom)
{
    const Runs regulated = slides({Layout::random, 0, 0, 0, 5}, ProxyForm::sphere);
    EXPECT_GT(regulated.all.angle(), 5) << record(regulated, "regulated") << "degrees, on a plane; prototype: 8 to 9";
    const Runs plain = slides({Layout::lattice, 0, 0, 0, 5}, ProxyForm::plainSphere);
    EXPECT_GT(plain.all.angle(), 5) << record(plain, "plain") << "degrees, on a regular plane; prototype: 11.3";
    EXPECT_EQ(slides({Layout::lattice, 0, 0, 0, 5}, ProxyForm::sphere).popped, 0) << "on a lattice it holds";
}

} // namespace
} // namespace palp
