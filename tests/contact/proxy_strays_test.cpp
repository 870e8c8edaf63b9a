// Points that belong to nothing, as scanners leave them in the air. Lengths are in spacings.
#include <gtest/gtest.h>

#include "tests/contact/proxy_scenes.h"

namespace palp {
namespace {

using namespace proxytest;

/// Strays above a sheet, as few together as localSpacings() takes for strays.
const Points kLow = {{3, 5, 5}, {-9, 14, 9}, {12, -8, 13}}, kHigh = {{-15, -12, 18}, {16, 11, 24}, {-2, -3, 30}};

struct Presses {
    int count = 0, missed = 0, inTheAir = 0, kept = 0;
};

/// Presses at random places, and on every stray, and lifts the hand again.
Presses presses(Touch& touch, const Points& strays, double speed)
{
    std::mt19937_64                  random(5);
    std::uniform_real_distribution<> unit(-20, 20);
    Presses                          presses;
    for (std::size_t press = 0; press < 30 + strays.size(); ++press) {
        glm::dvec3 over(unit(random), unit(random), 0);
        if (press < strays.size()) over = strays[press] + glm::dvec3(0.1, -0.2, 0);
        bool       early = false;
        const auto look  = [&] { early = early || (touch.touching() && touch.hip().z > 1.5); };
        touch.start({over.x, over.y, 40 + 0.3 * speed});
        touch.move({over.x, over.y, -5}, speed, look);
        presses.missed += !touch.touching() || std::abs(touch.at().z) > 0.5 || touch.state().normal.z < 0.95;
        touch.move({over.x, over.y, 40}, speed, look);
        for (int tick = 0; tick < 50; ++tick) touch.step(touch.hip());
        presses.kept += touch.touching() || glm::length(touch.pull()) > 0;
        presses.inTheAir += early;
        ++presses.count;
    }
    return presses;
}

TEST(ProxyStrays, StraysNeitherHoldTheHandNorHideTheSurface)
{
    for (const Layout layout : {Layout::lattice, Layout::random})
        for (const Points& strays : {kLow, kHigh}) {
            Sheet  sheet(layout, kFirstSeed);
            Points points = sheet.whole();
            append(points, strays);
            Touch touch(points);
            for (const double speed : {0.1, 0.5, 2.0, 8.0}) {
                const Presses found = presses(touch, strays, speed);
                SCOPED_TRACE("of " + std::to_string(found.count) + " at " + std::to_string(speed));
                EXPECT_EQ(found.missed, 0);
                EXPECT_LE(found.inTheAir, 1)
                    << "a plane through a stray 5 above and points of the sheet is seen at times";
                EXPECT_EQ(found.kept, 0);
            }
        }
}

/// A sheet with strays anywhere 3 to 30 above it, and presses at random places and at the first ten strays.
Presses pressesBelowStrays(Layout layout, std::uint64_t seed, double strayShare)
{
    Sheet                            sheet(layout, kFirstSeed + seed);
    Points                           points = sheet.whole(), strays;
    std::mt19937_64                  random(seed);
    std::uniform_real_distribution<> along(-35, 35), up(3, 30);
    const auto                       count = std::size_t(strayShare * double(points.size()));
    while (strays.size() < count) {
        const double x = along(random), y = along(random);
        strays.emplace_back(x, y, up(random));
    }
    append(points, strays);
    strays.resize(std::min<std::size_t>(10, strays.size()));
    Touch touch(points);
    return presses(touch, strays, 4);
}

TEST(ProxyStrays, ThreeInAThousandHideNothing)
{
    for (const double share : {0.001, 0.003})
        for (const Layout layout : {Layout::lattice, Layout::random})
            for (std::uint64_t seed = 1; seed <= 5; ++seed) {
                SCOPED_TRACE(std::to_string(share) + ", seed " + std::to_string(seed));
                const Presses found = pressesBelowStrays(layout, seed, share);
                EXPECT_EQ(found.missed, 0) << "where one in a thousand made planes in the air it was up to 34 of 40";
                EXPECT_LE(found.inTheAir, 1);
                EXPECT_EQ(found.kept, 0);
            }
}

TEST(ProxyStrays, ThirtyInAThousandHideLittle)
{
    for (const double share : {0.01, 0.03}) {
        Presses all;
        for (const Layout layout : {Layout::lattice, Layout::random})
            for (std::uint64_t seed = 1; seed <= 5; ++seed) {
                const Presses found = pressesBelowStrays(layout, seed, share);
                all.count += found.count;
                all.missed += found.missed;
                all.inTheAir += found.inTheAir;
            }
        EXPECT_LE(double(all.missed), 0.1 * all.count) << "all of them before strays were told by how they scatter";
        EXPECT_LE(double(all.inTheAir), 0.15 * all.count);
    }
}

} // namespace
} // namespace palp
