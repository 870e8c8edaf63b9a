#include "engine/session/hand_path.h"
#include "engine/session/scene_place.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "engine/cloud/samples.h"
#include "engine/core/npy.h"
#include "engine/session/scripted_hand.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

HandPath parsed(const std::string& text)
{
    std::istringstream in(text);
    return parseHand(in, "hand.csv");
}

std::string refusal(const std::string& text)
{
    return refusalOf([&] { static_cast<void>(parsed(text)); });
}

TEST(HandPath, ReadsNumbersBetweenAnythingUsualWithOrWithoutAHeader)
{
    for (const char* text :
         {"0,1e-3,2e-3,3e-3\n0.5,2e-3,2e-3,3e-3\n", "0 1e-3 2e-3 3e-3\n\n0.5\t2e-3  2e-3 3e-3",
          "time,x,y,z\n0;1e-3;2e-3;3e-3\n0.5;2e-3;2e-3;3e-3\n",
          "\xEF\xBB\xBFtime,x,y,z\n0,1e-3,2e-3,3e-3\n0.5,2e-3,2e-3,3e-3\n",
          "# a comment\nt,hip_x,hip_y,hip_z,proxy_x\r\n0,1e-3,2e-3,3e-3,9\r\n0.5,2e-3,2e-3,3e-3,9\r\n"}) {
        const HandPath hand = parsed(text);

        EXPECT_EQ(hand.waypoints().size(), 2u) << text;
        EXPECT_EQ(hand.duration(), 0.5);
        EXPECT_DOUBLE_EQ(hand.position(0.25).x, 1.5e-3);
        EXPECT_DOUBLE_EQ(hand.fastest(), 2e-3);
    }
}

TEST(HandPath, AHeaderMayStateUnitsOfTimeAndLength)
{
    for (const char* header :
         {"time[ms],x[mm],y[cm],z[m]", "time [ms], x (mm), y [ cm ], z, buttons", "t[ms];x[mm];y[cm];z"}) {
        const bool     more = std::string(header).find("buttons") != std::string::npos;
        const HandPath hand =
            parsed(std::string(header) + (more ? "\n0,1,2,3,0\n500,2,2,3,1\n" : "\n0,1,2,3\n500,2,2,3\n"));

        EXPECT_EQ(hand.duration(), 0.5) << header;
        EXPECT_NEAR(hand.position(0).x, 1e-3, 1e-15);
        EXPECT_NEAR(hand.position(0).y, 2e-2, 1e-15);
        EXPECT_EQ(hand.position(0).z, 3);
        EXPECT_EQ(hand.buttons(0.5), more ? 1U : 0U);
    }
    EXPECT_TRUE(
        holds(refusal("time[min],x,y,z\n0,0,0,0\n"), {"line 1: column \"time\"", "unknown unit \"min\"", "s, ms"}));
    EXPECT_TRUE(holds(refusal("time,x[s],y,z\n0,0,0,0\n"), {"column \"x\"", "m, mm, cm"}));
    for (const char* unclosed : {"time,x [mm,y,z\n", "# time,x [mm,y,z\n"})
        EXPECT_TRUE(holds(refusal(unclosed + std::string("0,0,0,0\n1,0,0,0\n")),
                          {"line 1: column \"x\": expected a bracket that ends", "found \"[mm\""}))
            << unclosed;
    EXPECT_EQ(parsed("time,x,y,z,force [N,buttons\n0,0,0,0,9,1\n1,0,0,0,9,1\n").buttons(0), 1U)
        << "a unit that nobody reads";
}

TEST(HandPath, AHeaderInAComment)
{
    const HandPath hand = parsed("# of today\n# time [ms],hip_x [mm],hip_y,hip_z,buttons\n0,1,2,3,0\n500,2,2,3,1\n");
    EXPECT_EQ(hand.duration(), 0.5);
    EXPECT_NEAR(hand.position(0).x, 1e-3, 1e-15);
    EXPECT_EQ(hand.buttons(0.5), 1U);

    for (const char* said : {"# time x y z in the lab\n", "# the x, y, z\n", "#\n", "# t [ms] x y z\ntime x y z\n"})
        EXPECT_EQ(parsed(said + std::string("0,1,2,3\n500,2,2,3\n")).duration(), 500) << said;
}

/// The table of a session has the buttons in the upper half of `device`; a column of that name elsewhere is any text.
TEST(HandPath, AnExportedTableHasItsButtons)
{
    const HandPath hand = parsed("time,hip_x,hip_y,hip_z,missed,device\n0,1,2,3,0,768\n0.5,1,2,3,0,131840\n");
    EXPECT_EQ(hand.buttons(0.2), 0U);
    EXPECT_EQ(hand.buttons(0.6), 2U);
    EXPECT_EQ(parsed("time,x,y,z,device\n0,1,2,3,falcon\n0.5,1,2,3,131840\n").buttons(0.6), 0U);
    EXPECT_NE(refusal("time,hip_x,hip_y,hip_z,missed,device\n0,1,2,3,0,-1\n").find("column device"), std::string::npos);
}

TEST(HandPath, FingerprintsTellHandsApart)
{
    const std::string rows = "0,0,0,0\n1,0,0,";
    EXPECT_EQ(fingerprint(parsed(rows + "0.1")), fingerprint(parsed("t x y z\n" + rows + "1e-1\n")))
        << "the same numbers";
    EXPECT_NE(fingerprint(parsed(rows + "0.1")), fingerprint(parsed(rows + "0.2")));
    EXPECT_NE(fingerprint(parsed("t,x,y,z,buttons\n0,0,0,0,0\n1,0,0,0,0\n")),
              fingerprint(parsed("t,x,y,z,buttons\n0,0,0,0,0\n1,0,0,0,1\n")));
}

TEST(HandPath, AtTheTimeOfAWaypointItIsThatWaypointBitForBitAndBeyondTheEndsItRests)
{
    std::vector<HandPose> waypoints;
    for (int i = 0; i < 1000; ++i) {
        const double t = 0.1 + i * 1e-3;
        waypoints.push_back({t, {std::sin(t) / 3, std::cos(t) / 7, t / 11}});
    }
    const HandPath hand(waypoints);

    for (const HandPose& waypoint : waypoints)
        EXPECT_EQ(hand.position(waypoint.time), waypoint.position) << waypoint.time;
    EXPECT_EQ(hand.position(-1), waypoints.front().position);
    EXPECT_EQ(hand.position(99), waypoints.back().position);
    EXPECT_EQ(hand.position(std::nan("")), waypoints.front().position);
}

TEST(HandPath, AColumnOfButtonsIsPressedFromItsWaypointOn)
{
    const HandPath hand = parsed("time,x,y,z,force,buttons\n0,0,0,0,9,0\n1,0,0,0,9,2\n2,0,0,0,9,0\n");

    EXPECT_EQ(hand.buttons(-1), 0u);
    EXPECT_EQ(hand.buttons(0.999), 0u);
    EXPECT_EQ(hand.buttons(1), 2u);
    EXPECT_EQ(hand.buttons(1.999), 2u);
    EXPECT_EQ(hand.buttons(3), 0u);
    ScriptedHand device(hand);
    EXPECT_EQ(device.exchange({}, 0.5).buttons, 0u);
    EXPECT_EQ(device.exchange({}, 1.5).buttons, 2u);
    for (const char* wrong : {"-1", "65536", "left", "1.5"})
        EXPECT_NE(refusalOf([&] {
                      static_cast<void>(parsed(std::string("t,x,y,z,buttons\n0,0,0,0,0\n1,0,0,0,") + wrong + "\n"));
                  }).find("line 3: expected buttons"),
                  std::string::npos)
            << wrong;
}

TEST(HandPath, IsContinuousAndNeverFasterThanItSays)
{
    const HandPath hand = parsed("0,0,0,0\n0.1,0.01,0,0\n0.3,0.01,0.05,0\n0.31,0.01,0.05,0.002\n");

    glm::dvec3 last = hand.position(-0.01);
    for (double t = -0.01; t < 0.35; t += 1e-5) {
        const glm::dvec3 here = hand.position(t);
        ASSERT_LE(glm::length(here - last), hand.fastest() * 1e-5 * (1 + 1e-6)) << t;
        last = here;
    }
}

TEST(HandPath, WhatNoHandCanDoIsRefusedWithItsLine)
{
    const std::string good = "t,x,y,z\n0,0,0,0\n";

    EXPECT_TRUE(holds(refusal(good + "1,0,nan,0\n"), {"hand.csv: line 3", "NaN"}));
    EXPECT_TRUE(holds(refusal(good + "1,inf,0,0\n"), {"line 3", "infinity"}));
    EXPECT_TRUE(holds(refusal(good + "nan,0,0,0\n"), {"line 3", "NaN"}));
    EXPECT_TRUE(holds(refusal(good + "1,0,0,0\n0.5,0,0,0\n"), {"line 4", "after 1 s", "found 0.5 s", "must rise"}));
    EXPECT_TRUE(holds(refusal(good + "0,0,0,0\n"), {"line 3", "must rise"}));
    EXPECT_TRUE(holds(refusal(good + "1,0,0\n"), {"line 3", "four columns", "found 3"}));
    EXPECT_TRUE(holds(refusal("0;0,1;0;0\n1;0,2;0;0\n"),
                      {"line 1: expected 4 columns, found 5", "decimals have a point", "header line"}));
    EXPECT_TRUE(holds(refusal("t,x,y,z,force\n0,0,0,0\n"), {"line 2: expected 5 columns, found 4"}));
    EXPECT_TRUE(holds(refusal(good + "1,0,zero,0\n"), {"line 3", "column 3", "zero"}));
    EXPECT_TRUE(holds(refusal(good + "1,0,0,0\nend\n"), {"line 4"}));
    EXPECT_TRUE(holds(refusal("x,y,z,time\n0,0,0,0\n"), {"line 1", "\"x\"", "time, x, y, z"}));
    EXPECT_TRUE(holds(refusal("time,z,y,x\n0,0,0,0\n"), {"line 1", "time, x, y, z", "\"z\" in the place of x"}));
    EXPECT_TRUE(holds(refusal("t,hip_x [mm],hip_z [mm],hip_y\n0,0,0,0\n"), {"line 1", "in the place of y"}));
    EXPECT_TRUE(holds(refusal(good + "0.001,5,0,0\n"), {"line 3", "5000 m/s", "metres"}));
    EXPECT_TRUE(holds(refusal(good + "1,0,\x1b[2J,0\n"), {"found \"?[2J\""})) << "no commands for a terminal";
    EXPECT_TRUE(holds(refusal(good), {"hand.csv", "two waypoints", "found 1"}));
    EXPECT_TRUE(holds(refusal(""), {"found 0"}));
    EXPECT_TRUE(holds(refusal(good + std::string(100'000, '1')), {"hand.csv", "longer than 65536 bytes"}));
    EXPECT_TRUE(holds(refusal(good + "86401,0,0,0\n"), {"hand.csv", "86400 s", "are the times seconds"}));
    EXPECT_TRUE(holds(refusal(good + "1e300,0,0,0\n"), {"hand.csv", "86400 s"}));
    EXPECT_TRUE(holds(refusal(good + "1,1e308,0,0\n"), {"line 3", "m/s"})) << "beyond what doubles can square";
}

TEST(HandPath, ReadsHowTheGripIsTurnedAndTurnsItTheShortestWay)
{
    const std::string header = "time,x,y,z,orientation_x,orientation_y,orientation_z,orientation_w\n";
    const HandPath    hand   = parsed(header + "0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0.70711,0.70711\n");

    EXPECT_TRUE(hand.turns());
    EXPECT_NEAR(glm::angle(hand.orientation(0.5)), std::numbers::pi / 4, 1e-5) << "half of a right angle";
    EXPECT_NEAR(glm::length(hand.orientation(2)), 1, 1e-12) << "five decimal places are made a unit quaternion";
    EXPECT_FALSE(parsed("time,x,y,z\n0,0,0,0\n1,0,0,0\n").turns());
    EXPECT_TRUE(holds(refusal(header + "0,0,0,0,0,0,0,0.5\n1,0,0,0,0,0,0,1\n"), {"line 2", "length 1", "0.5"}));
    EXPECT_TRUE(holds(refusal(header + "0,0,0,0,0,0,0,nan\n1,0,0,0,0,0,0,1\n"), {"line 2", "length 1"}));
    EXPECT_TRUE(holds(refusal(header + "0,0,0,0,0,0,up,1\n"), {"line 2", "column 7", "up"}));
    EXPECT_TRUE(holds(refusal("time,x,y,z,orientation_x\n"), {"line 1", "orientation_x", "found 1"}));
}

TEST(HandPath, ReadsAnArrayOfNumpyAndRefusesWhatIsWrongInIt)
{
    const TemporaryFolder folder;
    NodeField             rows(3, 5);
    for (int i = 0; i < 3; ++i) rows(i, 0) = i * 0.1;
    rows(2, 3) = 0.01;
    writeNpy(folder / "hand.npy", rows);
    EXPECT_EQ(readHand(folder / "hand.npy").position(0.2).z, 0.01);

    rows(2, 0) = 0.05;
    writeNpy(folder / "back.npy", rows);
    rows(2, 0) = std::nan("");
    writeNpy(folder / "nan.npy", rows);
    writeNpy(folder / "narrow.npy", NodeField(3, 3));
    const auto read = [&](const char* name) { return refusalOf([&] { static_cast<void>(readHand(folder / name)); }); };
    EXPECT_TRUE(holds(read("back.npy"), {"back.npy: row 2", "must rise"}));
    EXPECT_TRUE(holds(read("nan.npy"), {"nan.npy", "[2, 0]", "NaN"}));
    EXPECT_TRUE(holds(read("narrow.npy"), {"four columns", "3"}));
    EXPECT_TRUE(holds(refusalOf([] { static_cast<void>(readHand("/dev/zero")); }), {"longer than"})) << "endless";
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readHand(folder.path())); }), {"is a folder"}));
    EXPECT_TRUE(holds(read("none.csv"), {"none.csv", "No such file"}));
}

const HandPlace kPlace{{0.1, -0.2, 0.3}, glm::normalize(glm::dvec3(1, 2, 3))};

HandScript script(HandMotion motion)
{
    return {.motion = motion, .speed = 0.05, .depth = 2e-3, .radius = 8e-3, .height = 5e-3, .duration = 3};
}

TEST(GeneratedHand, NeverExceedsItsSpeedAndHasNoJumpInVelocity)
{
    for (const HandMotion motion : {HandMotion::press, HandMotion::circle, HandMotion::scan}) {
        const HandPath hand = makeHand(script(motion), kPlace);

        EXPECT_LE(hand.fastest(), 0.05 * (1 + 1e-9)) << name(motion);
        EXPECT_GT(hand.fastest(), 0.049) << name(motion);
        EXPECT_DOUBLE_EQ(hand.duration(), 3);
        const auto& s = hand.waypoints();
        for (std::size_t i = 1; i + 1 < s.size(); ++i) {
            const glm::dvec3 change = s[i + 1].position - 2.0 * s[i].position + s[i - 1].position;
            // The sharpest turn: from fall to rest, speed pi^2 / (4 * 7 mm) * 2 speed, 0.9 m/s2; a jump would be 50.
            ASSERT_LT(glm::length(change) / 1e-6, 2.0) << name(motion) << " at " << s[i].time;
        }
    }
}

TEST(GeneratedHand, StartsAboveThePlaceGoesToItsDepthAndDoesWhatItIsCalled)
{
    const auto   up      = [](const glm::dvec3& p) { return glm::dot(p - kPlace.point, kPlace.outward); };
    const auto   beside  = [&](const glm::dvec3& p) { return glm::length(p - kPlace.point - up(p) * kPlace.outward); };
    const double descent = std::numbers::pi * 7e-3 / (2 * 0.05);
    for (const HandMotion motion : {HandMotion::press, HandMotion::circle, HandMotion::scan}) {
        const HandPath hand = makeHand(script(motion), kPlace);
        EXPECT_NEAR(up(hand.position(0)), 5e-3, 1e-12) << name(motion);
        EXPECT_NEAR(up(hand.position(descent)), -2e-3, 1e-6) << name(motion);
    }
    const HandPath press = makeHand(script(HandMotion::press), kPlace);
    EXPECT_NEAR(up(press.position(2 * descent)), 5e-3, 1e-6) << "up again";
    EXPECT_LT(beside(press.position(1.234)), 1e-12);
    const HandPath circle = makeHand(script(HandMotion::circle), kPlace);
    const HandPath scan   = makeHand(script(HandMotion::scan), kPlace);
    double         least = 1, most = 0;
    for (double t = descent; t < 3; t += 1e-3) {
        EXPECT_NEAR(beside(circle.position(t)), 8e-3, 1e-7) << "chords of a millisecond";
        EXPECT_NEAR(up(circle.position(t)), -2e-3, 1e-6);
        EXPECT_NEAR(up(scan.position(t)), -2e-3, 1e-6);
        least = std::min(least, beside(scan.position(t)));
        most  = std::max(most, beside(scan.position(t)));
    }
    EXPECT_LT(least, 0.05e-3) << "across the place";
    EXPECT_NEAR(most, 8e-3, 1e-6);
}

TEST(GeneratedHand, GoesOnForDaysInTheMemoryOfOnePass)
{
    constexpr double kDescent = std::numbers::pi * 7e-3 / (2 * 0.05); // [s]
    for (const HandMotion motion : {HandMotion::press, HandMotion::circle, HandMotion::scan}) {
        HandScript days     = script(motion);
        days.duration       = 3 * 86400;
        const HandPath hand = makeHand(days, kPlace);
        const HandPath pass = makeHand(script(motion), kPlace);
        EXPECT_LT(hand.waypoints().size(), 3000u);
        EXPECT_LE(hand.fastest(), 0.05 * (1 + 1e-9));

        const double cycle = motion == HandMotion::press ? 2 * kDescent : 2 * std::numbers::pi * 8e-3 / 0.05; // [s]
        for (const double t : {0.1, 1.7, 4000.3, 86399.999, 259199.5}) {
            const double within = t < 2 ? t : 1 + std::fmod(t - 1, cycle); // `pass` rests after three seconds
            EXPECT_LT(glm::distance(hand.position(t), pass.position(within)), 2e-7)
                << "a chord: 0.9 m/s2 (1 ms)^2 / 8, " << name(motion) << " at " << t;
        }
    }
}

TEST(GeneratedHand, IsRepeatedAsItIsHoweverFastOrSlow)
{
    const auto refused = [](HandScript s) { return refusalOf([&] { static_cast<void>(makeHand(s, kPlace)); }); };
    for (const HandMotion motion : {HandMotion::press, HandMotion::circle, HandMotion::scan})
        for (const double speed : {1e-4, 0.05, 3.0, 30.0, 100.0})
            for (const double radius : {1e-300, 1e-6, 8e-3}) {
                HandScript fast = script(motion), days = fast;
                fast.speed = days.speed = speed;
                fast.radius = days.radius = radius;
                days.duration             = 86400;
                if (!refused(fast).empty()) continue; // faster than a hand
                ASSERT_EQ(refused(days), "");
                const HandPath hand    = makeHand(days, kPlace);
                double         deepest = 1;
                for (int n = 0; n < 2000; ++n) { // in contact, or pressing again and again, for as long as it lasts
                    const glm::dvec3 p = hand.position(80000 + 1.37e-3 * n);
                    ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
                    deepest = std::min(deepest, glm::dot(p - kPlace.point, kPlace.outward));
                }
                const bool falls = motion == HandMotion::press && speed < 1e-2; // for minutes
                EXPECT_LT(deepest, falls ? 5.1e-3 : 0.0) << name(motion) << " at " << speed << " m/s, " << radius;
            }
}

TEST(GeneratedHand, TheSameScriptGivesTheSameBits)
{
    const HandPath one = makeHand(script(HandMotion::circle), kPlace),
                   two = makeHand(script(HandMotion::circle), kPlace);

    for (std::size_t i = 0; i < one.waypoints().size(); ++i)
        EXPECT_EQ(one.waypoints()[i].position, two.waypoints()[i].position);
}

TEST(GeneratedHand, SenselessScriptsAreRefused)
{
    const auto refused = [](HandScript s) { return refusalOf([&] { static_cast<void>(makeHand(s, kPlace)); }); };

    EXPECT_TRUE(holds(refused({.speed = 0}), {"speed", "positive"}));
    EXPECT_TRUE(holds(refused({.speed = std::nan("")}), {"speed"}));
    EXPECT_TRUE(holds(refused({.motion = HandMotion::circle, .radius = -1}), {"radius", "-1"}));
    EXPECT_TRUE(holds(refused({.depth = -1, .height = 0.5}), {"height + depth"}));
    EXPECT_TRUE(holds(refused({.speed = 1e-9, .duration = 1e9}), {"10000 s", "greater speed"}));
    EXPECT_EQ(valueNamed<HandMotion>("scan"), HandMotion::scan);
    EXPECT_EQ(valueNamed<HandMotion>("wave"), std::nullopt);
}

TEST(GeneratedHand, DrapedOverASphereKeepsItsDepth)
{
    const SpatialLaw constant{.kind = SpatialLaw::Kind::constant, .from = 1e6};
    const SoftObject object(makeSample(sampleNamed("hemisphere"), 40'000, 3, constant));
    const auto       heightAt = [](double x, double y) { return std::sqrt(50e-3 * 50e-3 - x * x - y * y); };
    for (const glm::dvec2 at : {glm::dvec2(0, 0), glm::dvec2(-12e-3, 9e-3)}) {
        const HandPlace place{{at, heightAt(at.x, at.y)}, {0, 0, 1}};
        HandScript      s   = script(HandMotion::scan);
        s.radius            = at.x == 0 ? 20e-3 : 10e-3;
        const HandPath flat = makeHand(s, place), hand = draped(flat, place, object);

        for (double t = 0.5; t < 3; t += 0.01) {
            const glm::dvec3 p = hand.position(t);
            // The mean over a radius R of 3 x 0.9 mm lies R^2/8 of the curvature below the surface, 20 um at this
            // slope.
            EXPECT_NEAR(p.z, heightAt(p.x, p.y) - 2e-3, 0.15e-3) << "without draping it would be 4 mm off, at " << p.x;
        }
        EXPECT_LT(hand.fastest(), 2 * flat.fastest());
    }
}

TEST(GeneratedHand, DrapedItIsRepeatedWithoutAJump)
{
    const SpatialLaw constant{.kind = SpatialLaw::Kind::constant, .from = 1e6};
    // Of a dozen seeds the one whose heights hang most on the way there: without the closing the circle jumps by 0.12
    // mm.
    const SoftObject object(makeSample(sampleNamed("hemisphere"), 4'000, 12, constant));
    const HandPlace  top{{0, 0, 50e-3}, {0, 0, 1}};
    for (const HandMotion motion : {HandMotion::press, HandMotion::circle, HandMotion::scan}) {
        const HandScript s{.motion = motion, .radius = 35e-3, .duration = 86400};
        const HandPath   hand = draped(makeHand(s, top), top, object);
        ASSERT_TRUE(hand.repeatsFrom());
        const double seam = hand.duration();
        EXPECT_LT(glm::distance(hand.position(seam), hand.position(std::nextafter(seam, 1e9))), 1e-7) << name(motion);
        for (double t = seam - 0.1; t < seam + 0.1; t += 1e-3)
            ASSERT_LT(glm::distance(hand.position(t), hand.position(t + 1e-3)), 1.01e-3 * hand.fastest())
                << name(motion);
    }
}

TEST(GeneratedHand, DrapedOverAThinBodyItKeepsToTheTouchedFace)
{
    // Two sheets, 0.5 mm between points: the other face lies within the radius of the mean height.
    for (const double gap : {0.5e-3, 1e-3, 1.5e-3}) {
        std::mt19937_64                  random(3);
        std::uniform_real_distribution<> place(-15e-3, 15e-3);
        std::vector<glm::dvec3>          points;
        for (int n = 0; n < 7200; ++n) {
            const double x = place(random);
            points.emplace_back(x, place(random), n % 2 == 0 ? 0 : -gap);
        }
        const std::vector<double> stiffness(points.size(), 1e6);
        const SoftObject          object(PointCloud(std::move(points), stiffness, StiffnessKind::modulus));
        const HandPlace           top{{0, 0, 0}, {0, 0, 1}};
        HandScript                s = script(HandMotion::scan);
        s.radius                    = 8e-3;
        const HandPath hand         = draped(makeHand(s, top), top, object);
        for (double t = 0.5; t < 3; t += 0.01)
            ASSERT_NEAR(hand.position(t).z, -2e-3, 1e-6) << "pressed deeper by half the gap of " << gap;
    }
}

TEST(GeneratedHand, DrapedBeyondABorderItKeepsTheLastHeight)
{
    const SoftObject object(makeSample(sampleNamed("sheet"), 20'000, 3));
    const HandPlace  edge{{70e-3, 0, 0}, {0, 0, 1}};
    const HandPath   hand = draped(makeHand(script(HandMotion::scan), edge), edge, object);

    for (double t = 0.5; t < 3; t += 0.01) EXPECT_NEAR(hand.position(t).z, -2e-3, 1e-6);
}

/// A square of 41 x 41 points, 100 mm wide, with a height for each.
template <class Height>
PointCloud square(Height height)
{
    std::vector<glm::dvec3> points;
    for (int i = 0; i <= 40; ++i)
        for (int j = 0; j <= 40; ++j) {
            const glm::dvec2 at(2.5e-3 * i, 2.5e-3 * j);
            points.emplace_back(at, height(at));
        }
    return {points, std::vector<double>(points.size(), 1e5), StiffnessKind::modulus};
}

TEST(GeneratedHand, AFlatCloudIsTouchedInItsMiddleAndACurvedOneAtItsTop)
{
    const auto       placeOn = [](const PointCloud& cloud) { return placeOf(Scene(), cloud); };
    std::mt19937     random(7);
    const auto       noise = [&] { return std::uniform_real_distribution<double>(-0.4e-3, 0.4e-3)(random); };
    const glm::dvec3 middle(50e-3, 50e-3, 0);

    EXPECT_EQ(placeOn(square([](const glm::dvec2&) { return 0.0; })), middle);
    EXPECT_LT(glm::length(placeOn(square([&](const glm::dvec2&) { return noise(); })) - middle), 1e-3);
    const auto box = [](const glm::dvec2& at) { return at.x > 2e-3 && at.x < 98e-3 ? 0.0 : -20e-3; };
    EXPECT_EQ(placeOn(square(box)), middle) << "a flat top";
    const auto ridge = [](const glm::dvec2& at) { return -std::pow(at.x - 30e-3, 2) / 0.1; };
    EXPECT_LT(glm::length(placeOn(square(ridge)) - glm::dvec3(30e-3, 50e-3, 0)), 1e-9) << "and not an end of it";
    const glm::dvec2 top(30e-3, 60e-3);
    const auto       dome = [&](const glm::dvec2& at) { return -glm::dot(at - top, at - top) / 0.1; };
    EXPECT_LT(glm::length(placeOn(square(dome)) - glm::dvec3(top, 0)), 1e-9);
    const auto slope = [](const glm::dvec2& at) { return at.x + at.y; };
    EXPECT_EQ(placeOn(square(slope)).x, 0.1) << "the highest corner, as a slope has nothing flat";
}

TEST(GeneratedHand, StraysInTheAirAreNotTouched)
{
    const PointCloud        flat = square([](const glm::dvec2&) { return 0.0; });
    std::vector<glm::dvec3> points(flat.positions().begin(), flat.positions().end());
    for (const glm::dvec3& stray : {glm::dvec3(0.02, 0.03, 0.03), {0.06, 0.03, 0.02}, {0.05, 0.09, 0.012}})
        points.push_back(stray);
    const auto placeAmong = [](const std::vector<glm::dvec3>& all) {
        return placeOf(Scene(), PointCloud(all, std::vector<double>(all.size(), 1e5), StiffnessKind::modulus));
    };
    EXPECT_EQ(placeAmong(points), glm::dvec3(50e-3, 50e-3, 0)) << "a hand was sent to the highest stray";
    points.push_back({0.5, 0.05, -0.01});
    EXPECT_EQ(placeAmong(points), glm::dvec3(50e-3, 50e-3, 0)) << "one far beside it made the sheet none";
}

TEST(GeneratedHand, ThePlaceOfASceneIsOnItsCloudOnTheHandsSide)
{
    const Scene scene = parseScene(R"({"cloud": "sample:ellipsoid", "points": 5000})", "s.json", ".");

    const HandPlace place = handPlace(scene, loadObject(scene).object);

    EXPECT_LT(glm::length(place.point - scene.place.value()), 3e-3);
    EXPECT_GT(place.outward.z, 0.9);
    EXPECT_NEAR(glm::length(place.outward), 1, 1e-12);
}

} // namespace
} // namespace palp
