// Sheets whose points are 10, 40 and 100 times closer in the middle than outside. Lengths in spacings of the middle.
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "tests/contact/proxy_scenes.h"

namespace palp {
namespace {

using namespace proxytest;

constexpr int    kRatios[]  = {10, 40, 100};
constexpr int    kDensities = 4;   ///< seeds a case; with each ratio 100 000 points are sorted
constexpr double kMiddle    = 1.5; ///< half the side of the middle [outer spacings]

/// A random sheet of 24 x 24 outer spacings, its points 1 apart in the middle and `ratio` outside.
/// \param noise  [spacings] standard deviation, of the place's own spacing
Points mixedSheet(int ratio, std::uint64_t seed, double noise = 0)
{
    Sheet        sheet(Layout::random, seed);
    const double half   = kMiddle * ratio;
    Points       points = sheet.over(-half, half, -half, half);
    addNoise(points, noise, sheet.random());
    Points outer = sheet.over(-12, 12, -12, 12);
    std::erase_if(outer, [](const glm::dvec3& p) { return std::max(std::abs(p.x), std::abs(p.y)) < kMiddle; });
    addNoise(outer, noise, sheet.random());
    for (const glm::dvec3& p : outer) points.push_back(double(ratio) * p);
    return points;
}

/// A sheet of 120 spacings a side whose points are 1 apart but for a strip across it, where they are 10 apart.
Points sheetWithASparseStrip(std::uint64_t seed)
{
    Sheet  sheet(Layout::random, seed);
    Points points = sheet.over(-60, 60, -60, 60);
    std::erase_if(points, [](const glm::dvec3& p) { return std::abs(p.x) < 20; });
    for (const glm::dvec3& p : sheet.over(-2, 2, -6, 6)) points.push_back(10.0 * p);
    return points;
}

TEST(ProxyDensity, PressesFindTheSheetWhereverTheyCome)
{
    for (const int ratio : kRatios)
        for (int seed = 0; seed < kDensities; ++seed) {
            Touch touch(mixedSheet(ratio, kFirstSeed + std::uint64_t(seed)));
            for (const double place : {0.0, 0.7, 1.2, 1.45, 1.5, 1.55, 1.8, 2.5, 4.0})
                for (const double speed : {0.02 * ratio, 0.3 * ratio, 1e9}) {
                    const glm::dvec3 end(place * ratio, 0.13 * ratio, -0.4 * ratio);
                    touch.start(end + glm::dvec3(0, 0, 6.0 * ratio));
                    touch.move(end, speed);
                    for (int tick = 0; tick < 20; ++tick) touch.step(end);
                    EXPECT_TRUE(touch.touching() && std::abs(touch.at().z) < 0.01 && !touch.state().limited)
                        << "1:" << ratio << ", seed " << seed << ", at " << place << ", speed " << speed << ": z "
                        << touch.at().z;
                }
        }
}

struct Crossing {
    Slide  slide;
    double jump = 0; ///< [1] of the depth: largest change of the pull in one tick
    double fade = 1; ///< [1] the least
    double high = 0; ///< [place's own spacing] furthest from the sheet

    void add(const Crossing& b)
    {
        slide.add(b.slide);
        jump = std::max(jump, b.jump);
        fade = std::min(fade, b.fade);
        high = std::max(high, b.high);
    }
};

void PrintTo(const Crossing& c, std::ostream* out)
{
    *out << "off the sheet or lost in " << c.slide.popped << " of " << c.slide.ticks << " ticks, normal "
         << c.slide.angle() << " deg RMS, lag " << c.slide.lag << ", height " << c.high << ", pull step " << c.jump
         << ", least fade " << c.fade;
}

/// \param spacing  of the sheet at a place
Crossing cross(Touch& touch, const glm::dvec3& from, const glm::dvec3& way, double depth, double speed,
               const std::function<double(const glm::dvec3&)>& spacing)
{
    Crossing crossing;
    touch.start({from.x, from.y, 5 * depth});
    touch.move({from.x, from.y, -depth}, 0.1 * depth);
    for (int tick = 0; tick < 20; ++tick) touch.step(touch.hip());
    touch.move(touch.hip() + way, speed, [&] {
        const glm::dvec3 x    = touch.at();
        const double     high = x.z / spacing(x);
        crossing.slide.add(touch, {0, 0, 1}, high, std::hypot(x.x - touch.hip().x, x.y - touch.hip().y));
        crossing.jump = std::max(crossing.jump, touch.pullStep() / depth);
        crossing.fade = std::min(crossing.fade, touch.state().fade);
        crossing.high = std::max(crossing.high, std::abs(high));
    });
    return crossing;
}

/// Slides of 3 outer spacings across the border of the middle, both ways.
Crossing crossings(int ratio, double noise, const std::vector<double>& depths)
{
    Crossing   all;
    const auto spacing = [=](const glm::dvec3& x) { return std::abs(x.x) < kMiddle * ratio ? 1.0 : ratio; };
    // With noise the middle is felt with the outer spacing up to here, as near a border a fit has points of both.
    const auto coarse = [=](const glm::dvec3& x) { return std::abs(x.x) < 0.5 * kMiddle * ratio ? 1.0 : ratio; };
    for (int seed = 0; seed < kDensities; ++seed) {
        Touch touch(mixedSheet(ratio, kFirstSeed + std::uint64_t(seed), noise));
        for (const double depth : depths)
            for (const double speed : {0.5, 0.02 * ratio, 0.1 * ratio})
                for (const double way : {3.0, -3.0}) {
                    const glm::dvec3 from((way > 0 ? 0.4 : 3.4) * ratio, 0.13 * ratio, 0);
                    if (noise > 0)
                        all.add(cross(touch, from, {way * ratio, 0, 0}, depth, speed, coarse));
                    else
                        all.add(cross(touch, from, {way * ratio, 0, 0}, depth, speed, spacing));
                }
    }
    return all;
}

// As over a uniform plane: no tick is lost, nothing fades, no step.
TEST(ProxyDensity, SlidesOverAStepInDensityAreSlidesOverAPlane)
{
    for (const int ratio : kRatios) {
        const Crossing all = crossings(ratio, 0, {5, 0.5 * ratio});
        SCOPED_TRACE(record(testing::PrintToString(all), "1:" + std::to_string(ratio)));
        EXPECT_TRUE(all.slide.held());
        EXPECT_LT(all.slide.angle(), 0.1);
        EXPECT_LT(all.slide.lag, 0.01);
        EXPECT_LT(all.high, 0.001);
        EXPECT_EQ(all.fade, 1);
        EXPECT_LT(all.jump, 0.001);
    }
}

// A hand one outer spacing deep. The lag is depth times the slope that noise makes, as on a uniform sheet: 0.12 there.
TEST(ProxyDensity, NoiseOnBothSidesOfAStepIsSmoothed)
{
    for (const int ratio : kRatios) {
        const Crossing all = crossings(ratio, 0.2, {1.0 * ratio});
        SCOPED_TRACE(record(testing::PrintToString(all), "1:" + std::to_string(ratio)));
        EXPECT_TRUE(all.slide.held());
        EXPECT_LT(all.slide.angle(), 3) << "as on a uniform sheet";
        EXPECT_LT(all.high, 0.3);
        EXPECT_LT(all.slide.lag, 0.2 * ratio);
        EXPECT_EQ(all.fade, 1);
        EXPECT_LT(all.jump, 0.25) << "recorded: 0.17, at a tenth of the outer spacing per tick";
    }
}

TEST(ProxyDensity, ASparseStripIsBridged)
{
    Crossing all;
    for (int seed = 0; seed < kSeeds; ++seed) {
        Touch touch(sheetWithASparseStrip(kFirstSeed + std::uint64_t(seed)));
        for (const double depth : {1.0, 5.0, 20.0})
            for (const double speed : {0.1, 0.5, 2.0})
                for (const double way : {80.0, -80.0})
                    all.add(cross(touch, {-0.5 * way, 0.13, 0}, {way, 0, 0}, depth, speed,
                                  [](const glm::dvec3&) { return 1.0; }));
    }
    SCOPED_TRACE(record(testing::PrintToString(all)));
    EXPECT_TRUE(all.slide.held());
    EXPECT_LT(all.high, 0.001);
    EXPECT_EQ(all.fade, 1);
    EXPECT_LT(all.jump, 0.001);
}

} // namespace
} // namespace palp
