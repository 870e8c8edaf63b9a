// Ways through free space, and what a servo thread must be able to rely on.
#include <chrono>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/contact/proxy_scenes.h"
#include "tests/support/allocations.h"
#include "tests/support/sanitized.h"

namespace palp {
namespace {

using namespace proxytest;

/// A small sheet, and one behind it unless the gap is 0.
Points smallSheets(Layout layout, std::uint64_t seed, double gap, double half)
{
    Sheet  sheet(layout, seed);
    Points points = sheet.over(-half, half, -half, half);
    if (gap > 0) append(points, sheet.over(-half, half, -half, half), {0, 0, -gap});
    return points;
}

int missedPresses(double gap)
{
    int missed = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        Touch touch(smallSheets(Layout::random, 5000 + seed, gap, 15));
        touch.start({0.2, 0.3, 5});
        touch.move({0.2, 0.3, -gap - 5}, 0.1);
        missed += !touch.touching() || std::abs(touch.at().z) > 1;
    }
    return missed;
}

/// There a step of 1e-9 spacings is less than the last digit of a coordinate.
TEST(ProxyTravel, ASurfaceThousandsOfKilometresFromTheOriginIsReached)
{
    Sheet        sheet(Layout::random, kFirstSeed);
    const Points points = sheet.whole();
    for (const double far : {1e8, 1e9, 5e9}) { // spacings of 1 mm
        Touch touch(points, {}, glm::dvec3(far));
        int   limited = 0;
        for (int press = 0; press < 10; ++press) {
            touch.start({2.0 * press - 9, 0.3 * press, 12});
            touch.move({2.0 * press - 9, 0.3 * press, -5}, 0.1, [&] { limited += touch.state().limited; });
            EXPECT_TRUE(touch.touching() && std::abs(touch.at().z) < 0.01) << far << ", " << press;
        }
        EXPECT_EQ(limited, 0) << far << ": ticks whose rounds were used up by a touch that was met again and again";
    }
}

TEST(ProxyTravel, NothingIsFeltInFreeSpaceHoweverFarTheSphereLags)
{
    Sheet        sheet(Layout::random, 3);
    const Points points = sheet.whole();
    for (const ProxyForm form : {ProxyForm::hybrid, ProxyForm::sphere, ProxyForm::plainSphere}) {
        Touch  touch(points, {form});
        double lag = 0, pull = 0;
        touch.start({0, 0, 20});
        touch.move({0, 0, 6020}, 120, [&] {
            lag  = std::max(lag, glm::length(touch.hip() - touch.at()));
            pull = std::max(pull, glm::length(touch.pull()));
        });
        EXPECT_EQ(pull, 0);
        EXPECT_TRUE(lag > 40 || form == ProxyForm::hybrid) << "or the test shows nothing";
    }
}

TEST(ProxyTravel, PressesFindTheNearSheet)
{
    EXPECT_EQ(missedPresses(2), 0) << "of 100; prototype: 2";
    EXPECT_EQ(missedPresses(3), 0);
    EXPECT_EQ(missedPresses(0), 0);
}

constexpr int kWays = kSanitized ? 30 : 300; // the same code again

struct Missed {
    int fast = 0; ///< of kWays at 8 spacings per tick
    int jump = 0; ///< of kWays in one tick, 60 spacings or more
};

Missed missedWays(ProxyForm form)
{
    Missed missed;
    for (int run = 0; run < kWays; ++run) {
        const double                     gaps[] = {0, 2, 3};
        std::mt19937_64                  random(7000 + std::uint64_t(run));
        std::uniform_real_distribution<> unit(0, 1);
        const double                     gap = gaps[run % 3];
        const double     angle = unit(random) * 69 * std::numbers::pi / 180, turn = 2 * std::numbers::pi * unit(random);
        const double     far = 10 + 50 * unit(random);
        const glm::dvec3 back(std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle));
        const glm::dvec3 end(unit(random), unit(random), -gap - 5);
        Touch touch(smallSheets(run % 2 ? Layout::random : Layout::lattice, 7000 + std::uint64_t(run), gap, 30),
                    {form});
        for (const double speed : {8.0, 1e9}) {
            touch.start(end + (speed > 8 ? 60 : far) / std::cos(angle) * back);
            touch.move(end, speed);
            for (int tick = 0; tick < 20; ++tick) touch.step(end);
            // The paper's sphere lies on the points with all of its radius, up to three spacings above them.
            const double high = touch.at().z;
            const bool   off  = high < -0.5 || high > (form == ProxyForm::hybrid ? 0.5 : 3);
            (speed > 8 ? missed.jump : missed.fast) += !touch.touching() || off;
        }
    }
    return missed;
}

TEST(ProxyTravel, NoWayIsTooFast)
{
    const Missed missed = missedWays(ProxyForm::hybrid);
    EXPECT_EQ(missed.fast, 0) << "of " << kWays << " at 8 spacings per tick";
    EXPECT_EQ(missed.jump, 0) << "of " << kWays << " in one jump of 60 spacings or more";
}

TEST(ProxyTravel, ThePapersFormAsPublishedMissesSurfacesOnItsWay)
{
    if (kSanitized) GTEST_SKIP() << "too few ways to count what is missed";
    const Missed missed = missedWays(ProxyForm::plainSphere);
    record("fast " + std::to_string(missed.fast) + ", jump " + std::to_string(missed.jump));
    EXPECT_GE(missed.fast, 8) << "of 300; recorded: 17. The regulated form misses none";
}

TEST(ProxyTravel, InFreeSpaceTheProxyIsTheHand)
{
    Touch touch(smallSheets(Layout::random, 1, 0, 15));
    touch.start({0, 0, 30});
    touch.move({0, 0, 1.0}, 0.3, [&] {
        EXPECT_LT(glm::length(touch.at() - touch.hip()), 1e-12);
        EXPECT_EQ(touch.state().fade, 0);
        EXPECT_LT(glm::length(touch.pull()), 1e-12);
    });
    touch.move({0, 0, -1.0}, 0.3);
    EXPECT_TRUE(touch.touching());
    touch.move({0, 0, 1.0}, 0.3);
    EXPECT_FALSE(touch.touching()) << "lifted off";
    EXPECT_LT(glm::length(touch.at() - touch.hip()), 1e-12);
}

TEST(ProxyTravel, BothSidesOfASheetAreFelt)
{
    Touch touch(smallSheets(Layout::random, 1, 0, 15));
    for (const double side : {1.0, -1.0}) {
        touch.start({0, 0, side * 5});
        touch.move({0, 0, side * -5}, 0.5);
        EXPECT_TRUE(touch.touching());
        EXPECT_NEAR(touch.at().z, 0, 0.01);
        EXPECT_GT(side * touch.state().normal.z, 0.999) << "towards the hand";
    }
}

/// A motion with presses, slides, a border and a lift, through noise.
std::vector<glm::dvec3> longMotion()
{
    std::vector<glm::dvec3> hips;
    for (int k = 0; k < 2000; ++k) {
        const double t = 0.002 * std::numbers::pi * k;
        hips.emplace_back(17 * std::sin(3 * t), 11 * std::sin(2 * t + 0.4), 3 - 7 * std::sin(5 * t));
    }
    return hips;
}

TEST(ProxyTravel, TheSameHandGivesTheSameBits)
{
    Sheet  sheet(Layout::random, 4);
    Points points = sheet.over(-15, 15, -15, 15);
    addNoise(points, 0.2, sheet.random());
    Touch first(points, {ProxyForm::hybrid, 0.3, 0.2}), second(points, {ProxyForm::hybrid, 0.3, 0.2});
    first.start({0, 0, 50}); // a different past must not matter
    first.move({0, 0, -5}, 0.7);
    for (Touch* touch : {&first, &second}) touch->start({0, 0, 20});
    for (const glm::dvec3& hip : longMotion()) {
        first.step(hip);
        second.step(hip);
        const ProxyState &a = first.state(), &b = second.state();
        ASSERT_EQ(std::memcmp(&a.position, &b.position, sizeof a.position), 0);
        ASSERT_EQ(std::memcmp(&a.normal, &b.normal, sizeof a.normal), 0);
        ASSERT_EQ(a.fade, b.fade);
        ASSERT_EQ(a.touching, b.touching);
    }
}

TEST(ProxyTravel, TheSameWayEndsAtASheetOfFinerPointsToo)
{
    for (const double finer : {1.0, 0.1, 0.01}) { // down to ten micrometres
        Points points = smallSheets(Layout::random, 1, 0, 15);
        for (glm::dvec3& p : points) p *= finer;
        Touch touch(points);
        touch.start(finer * glm::dvec3(0.2, 0.3, 30));
        touch.step(finer * glm::dvec3(0.2, 0.3, -5));
        EXPECT_TRUE(touch.touching()) << finer;
        EXPECT_NEAR(touch.at().z / finer, 0, 0.3) << finer;
    }
}

/// The pull follows by no more than the hand has moved, which is counted from the place of the reset.
TEST(ProxyTravel, NothingOfAnEarlierTouchIsLeftAfterAReset)
{
    Touch touch(smallSheets(Layout::lattice, 1, 0, 15));
    touch.start({0.2, 0.3, 5});
    touch.move({0.2, 0.3, -3}, 0.5);
    ASSERT_NEAR(touch.pull().z, 3, 0.01);
    touch.start({0.2, 0.3, 1});
    EXPECT_FALSE(touch.touching());
    EXPECT_EQ(touch.pull(), glm::dvec3(0));
    touch.step({0.2, 0.3, -3});
    EXPECT_NEAR(touch.pull().z, 3, 0.01) << "the hand has moved by four";
}

TEST(ProxyTravel, NothingIsAllocatedAfterConstruction)
{
    Sheet  sheet(Layout::random, 4);
    Points points = sheet.over(-15, 15, -15, 15);
    addNoise(points, 0.2, sheet.random());
    const std::vector<glm::dvec3> hips = longMotion();
    for (const ProxyForm form : {ProxyForm::hybrid, ProxyForm::sphere, ProxyForm::plainSphere}) {
        Touch touch(points, {form});
        touch.start({0, 0, 60});
        const std::size_t before = allocationsOfThisThread();
        int               felt   = 0;
        for (const glm::dvec3& hip : hips) {
            touch.step(hip);
            felt += touch.touching();
        }
        EXPECT_EQ(allocationsOfThisThread() - before, 0U);
        EXPECT_GT(felt, 500);
    }
}

TEST(ProxyTravel, AHandThatIsNowhereMovesNothing)
{
    Touch touch(smallSheets(Layout::lattice, 1, 0, 15));
    touch.start({0, 0, 5});
    touch.move({0, 0, -2}, 0.5);
    const glm::dvec3 before = touch.at();
    touch.step({0, std::numeric_limits<double>::quiet_NaN(), 0});
    EXPECT_EQ(touch.at(), before);
    touch.step({0, 0, -2});
    EXPECT_NEAR(glm::length(touch.at() - before), 0, 1e-6);
    touch.step({1e300, 0, -2});
    EXPECT_TRUE(std::isfinite(touch.at().x));
}

/// Clouds that no one should send, and some do.
std::vector<Points> strangeClouds()
{
    std::mt19937_64            random(11);
    std::normal_distribution<> normal;
    const auto any = [&](double size) { return size * glm::dvec3(normal(random), normal(random), normal(random)); };
    std::vector<Points> clouds(6);
    for (int i = 0; i < 3000; ++i) clouds[0].push_back(any(5));               // a volume
    for (int i = 0; i < 300; ++i) clouds[1].emplace_back(0.1 * i - 15, 0, 0); // a line
    for (const glm::dvec3& p : smallSheets(Layout::lattice, 1, 0, 8))
        clouds[2].insert(clouds[2].end(), 3, p); // pairs of pairs
    clouds[3] = smallSheets(Layout::random, 1, 0, 8);
    for (int i = 0; i < 20; ++i) clouds[3].push_back(any(30)); // strays
    clouds[4] = smallSheets(Layout::random, 1, 0, 8);
    for (int i = 0; i < 20000; ++i) clouds[4].push_back(any(0.05)); // a clot
    for (int i = 0; i < 7; ++i) clouds[5].push_back(any(3));        // hardly any
    return clouds;
}

TEST(ProxyTravel, WhateverTheCloudTheProxyStaysFinite)
{
    int number = 0;
    for (const Points& cloud : strangeClouds())
        for (const ProxyForm form : {ProxyForm::hybrid, ProxyForm::sphere, ProxyForm::plainSphere}) {
            SCOPED_TRACE("cloud " + std::to_string(number++ / 3));
            std::unique_ptr<Touch> touch;
            try {
                touch = std::make_unique<Touch>(cloud, ProxySettings{form, 0.4, 0.2});
            } catch (const Error&) { // most points coincide
                continue;
            }
            std::mt19937_64            random(5);
            std::normal_distribution<> normal;
            touch->start({0, 0, 40});
            for (int way = 0; way < 25; ++way) {
                const glm::dvec3 goal = 6.0 * glm::dvec3(normal(random), normal(random), normal(random));
                touch->move(goal, std::exp(2 * normal(random) - 1) + 0.02, [&] {
                    const ProxyState& state = touch->state();
                    ASSERT_LT(glm::length(touch->at()), 1e3);
                    ASSERT_NEAR(glm::length(state.normal), 1, 1e-9);
                    ASSERT_TRUE(state.fade >= 0 && state.fade <= 1);
                    ASSERT_LT(glm::length(touch->pull()), 1e3);
                });
            }
        }
}

TEST(ProxyTravel, WrongFrictionAndCloudsWithoutASurfaceAreRefused)
{
    const Points points = smallSheets(Layout::lattice, 1, 0, 5);
    EXPECT_THROW(Touch(points, {ProxyForm::hybrid, -0.1, 0}), ContractViolation);
    EXPECT_THROW(Touch(points, {ProxyForm::hybrid, 0.2, 0.3}), ContractViolation);
    EXPECT_THROW(Touch(Points(100, glm::dvec3(1, 2, 3))), Error);
    EXPECT_THROW(Touch(Points(points.begin(), points.begin() + 3)), Error);
}

} // namespace
} // namespace palp
