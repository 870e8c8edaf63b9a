#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/force/force_law.h"
#include "tests/session/sheet_session.h"
#include "tests/support/errors.h"

// A tap is how people tell softness: what it feels in its first milliseconds must be the place that it hits.

namespace palp {
namespace {

constexpr double kHeight = 6e-3; // [m] of the hand between taps
constexpr double kStay   = 0.15; // [s] in contact: eight periods of the deformation
constexpr double kTold   = 0.07; // [1] error of the felt stiffness that nobody notices

struct Taps {
    std::vector<glm::dvec3> places;                        ///< [m] of the surface
    double                  depth, speed;                  ///< [m], [m/s]
    double                  engaged = 1.7, between = 0.25; ///< [s] before the first tap and before each
};

/// Goes from place to place at 6 mm and taps straight down on each.
HandPath tapping(const Taps& taps)
{
    std::vector<HandPose> path;
    double                time = 0;
    const auto            go   = [&](double seconds, const glm::dvec3& to, bool smooth) {
        const glm::dvec3 from  = path.empty() ? to : path.back().position;
        const int        ticks = std::max(1, int(std::lround(seconds * 1e3)));
        for (int n = 1; n <= ticks; ++n) {
            const double u = double(n) / ticks, s = smooth ? u * u * (3 - 2 * u) : u;
            path.push_back({time += 1e-3, from + s * (to - from)});
        }
    };
    const glm::dvec3 far{0, 0, 7 * kHeight}, up{0, 0, kHeight}, down{0, 0, -taps.depth};
    go(taps.engaged, taps.places.front() + far, false);
    for (const glm::dvec3& place : taps.places) {
        go(taps.between, place + up, true);
        go((kHeight + taps.depth) / taps.speed, place + down, false);
        go(kStay, place + down, false);
        go((kHeight + taps.depth) / taps.speed, place + up, false);
    }
    return HandPath(path);
}

struct Tapped {
    double truth = 0; ///< [N/m] of a window about the place
    double error = 0; ///< [1] largest of the felt stiffness, from the first millisecond on
    double after = 0; ///< [s] from the first touch to that error
};

std::vector<TickRecord> run(const SceneSession& session, const HandPath& hand)
{
    return session.run(hand, hand.waypoints().back().time, true);
}

/// What the scene renders where a finger has rested for long [N/m].
double restingStiffness(const SceneSession& session, const glm::dvec3& place)
{
    Deformation deformation(session.object, session.scene);
    Touch       rests{.sequence = 1, .time = 0, .touching = true, .point = place, .outward = {0, 0, 1}, .velocity = {}};
    const auto  here = deformation.solve(rests, 0).update->table.middle();
    return std::min(
        session.scene.stiffnessCap,
        feltStiffness(session.scene.patch.forceLaw, std::exp(here.lnContactStiffness), std::exp(here.lnCompliance)));
}

std::vector<Tapped> tapped(const SceneSession& session, const Taps& taps)
{
    std::vector<Tapped> all;
    const auto          records = run(session, tapping(taps));
    const auto          touches = [](const TickRecord& s) { return s.normal != glm::dvec3(0); };
    for (auto begin = std::find_if(records.begin(), records.end(), touches); begin != records.end();) {
        const auto end = std::find_if_not(begin, records.end(), touches);
        Tapped     tap{.truth = restingStiffness(session, begin->proxy)};
        // The way up, where the governor may damp, is not judged.
        for (auto tick = begin + 1; tick < std::min(begin + std::ptrdiff_t(1e3 * kStay), end); ++tick) {
            const double felt  = glm::length(tick->force) / glm::length(tick->proxy - tick->hip);
            const double error = worse(tap.error, felt / tap.truth - 1);
            if (error > tap.error) tap.after = tick->time - begin->time;
            tap.error = error;
        }
        all.push_back(tap);
        begin = std::find_if(end, records.end(), touches);
    }
    return all;
}

/// \param contrast  [1] at least that of the stiffest place to the softest: there is something to tell
void expectTold(const SceneSession& session, const Taps& taps, double contrast)
{
    const std::vector<Tapped> all = tapped(session, taps);
    ASSERT_EQ(all.size(), taps.places.size());
    EXPECT_GT(all.front().truth / all[1].truth, contrast);
    for (const Tapped& tap : all) {
        std::printf("  %3.0f mm/s, %4.0f N/m: largest error %5.1f %%, %3.0f ms after the first touch\n",
                    taps.speed * 1e3, tap.truth, tap.error * 100, tap.after * 1e3);
        EXPECT_LE(tap.error, kTold) << taps.speed << " m/s on " << tap.truth << " N/m, " << tap.after << " s";
    }
}

TEST(Taps, BetweenSkinAndWartAreRightFromTheFirstMillisecond)
{
    const SceneSession session(readScene(PALPATE_SCENES "/palm_wart.json"));
    const glm::dvec3   wart{0, 0.7e-3, 0}, skin{25e-3, 0.7e-3, 0};
    for (double speed : {0.05, 0.1, 0.2}) expectTold(session, {{wart, skin, wart}, 1.5e-3, speed}, 1.8);
}

TEST(Taps, GentleOnesNineMillimetresApartToo)
{
    const SceneSession      session(readScene(PALPATE_SCENES "/palm_wart.json"));
    std::vector<glm::dvec3> places;
    for (int n = 0; n < 3; ++n) places.push_back({9e-3 * (n % 2), 0, 0});
    expectTold(session, {places, 1e-3, 0.05}, 1.5);
}

TEST(Taps, AcrossAStepOfAHundredAreRightFromTheFirstMillisecond)
{
    const SceneSession session(stepOfAHundred());
    const glm::dvec3   stiff{12e-3, 0.7e-3, 0}, soft{-14e-3, 0.7e-3, 0};
    for (double speed : {0.05, 0.1, 0.2}) expectTold(session, {{stiff, soft, stiff}, 1e-3, speed}, 4);
}

/// While the force still comes on, and from so close that no table can be ready: 1 mm at 0.2 m/s are 5 ms. Pressed by
/// 0.2 mm only, because the governor lets no force come on where it would be more than 0.2 N at once.
TEST(Taps, TheFirstTouchOfASessionHasAForceFromItsFirstTick)
{
    const SceneSession session(readScene(PALPATE_SCENES "/palm_wart.json"));
    const auto first = [](const TickRecord& s) { return (s.faults & std::uint32_t(SessionFlag::beyondTable)) != 0; };
    for (const double height : {8e-3, 1e-3}) {
        const double down = (height + 0.2e-3) / 0.2;
        const auto   records =
            run(session, HandPath({{0, {0, 0, height}}, {down, {0, 0, -0.2e-3}}, {0.2, {0, 0, -0.2e-3}}}));
        int pressed = 0, guessed = 0;
        for (const TickRecord& s : records) {
            if (s.normal == glm::dvec3(0) || glm::dot(s.proxy - s.hip, s.normal) <= 0 || s.time < 0.012) continue;
            ++pressed;
            guessed += first(s);
            EXPECT_GT(glm::dot(s.force, s.normal), 0) << s.time << " s: the governor waits for 10 ms";
            EXPECT_EQ(s.faults & static_cast<std::uint32_t>(SessionFlag::noPatch), 0U) << s.time;
        }
        EXPECT_GT(pressed, 100) << "otherwise this shows nothing";
        EXPECT_EQ(guessed > 0, height < 2e-3) << "from 8 mm a table comes in time";
        EXPECT_LT(guessed, 40) << "two periods";
    }
}

/// What answers until the first table is an estimate, not the plate.
TEST(Taps, TheHomogeneousLawOfAPlaceIsNearToItsPlate)
{
    const SceneSession session(readScene(PALPATE_SCENES "/palm_wart.json"));
    const Deformation  deformation(session.object, session.scene);
    for (double x = 0; x <= 20e-3; x += 2e-3) {
        const auto   guess = *deformation.firstLaw()->at({x, 0.3e-3, 0});
        const double felt =
            feltStiffness(ForceLaw::series, std::exp(guess.lnContactStiffness), std::exp(guess.lnCompliance));
        const double truth = restingStiffness(session, {x, 0.3e-3, 0});
        std::printf("  %2.0f mm: %.0f N/m for %.0f\n", x * 1e3, felt, truth);
        EXPECT_NEAR(felt / truth, 1, x > 12e-3 ? 0.03 : 0.15) << x;
    }
    EXPECT_FALSE(deformation.firstLaw()->at({0, 0, 20e-3}).has_value()) << "far from every point";
    EXPECT_FALSE(deformation.firstLaw()->at({std::nan(""), 0, 0}).has_value());
}

} // namespace
} // namespace palp
