#include "engine/tools/study/hunt_score.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/session/servo.h"
#include "engine/tools/study/hunt_picture.h"
#include "tests/session/sheet_session.h"
#include "tests/support/temporary_folder.h"

namespace palp::study {
namespace {

const glm::dvec3 kFirst{0.01, 0, 0}, kSecond{-0.01, 0, 0};

/// A flat sheet with two nodules of 6 and 3 mm; the fingertip has 2 mm.
Scene scene()
{
    return parseScene(R"({"cloud": "sample:sheet", "points": 40000, "stiffness": {"law": "constant", "value": 3e5},
        "footprint_radius": "2 mm", "hunt": {"nodules": [{"at": [0.01, 0, 0], "radius": "6 mm", "modulus": "3 MPa"},
        {"at": [-0.01, 0, 0], "radius": "3 mm", "modulus": "1 MPa"}], "ground": "30 mm", "too_hard": "1.5 N"}})",
                      "a test", ".", {.toolKeys = &huntKeys()});
}

/// A made-up session on that sheet.
class Played {
public:
    Played() : scorer_(scene(), loadCloud(scene()).cloud) {}

    void touch(const glm::dvec3& place, double force = 0.5, std::uint32_t buttons = 0)
    {
        add(place, force, buttons, {0, 0, 1});
    }
    void air(std::uint32_t buttons = 0) { add({0, 0, 0.01}, 0, buttons, {}); }
    void declare(const glm::dvec3& place, int ticks = ForceHalf::kPressTicks)
    {
        for (int n = 0; n < ticks; ++n) touch(place, 0.5, 2);
        touch(place);
    }
    /// Along a circle, from one angle to another [rad].
    void arc(const glm::dvec3& middle, double radius, double from, double to, double force = 0.5)
    {
        for (int n = 0; n <= 2000; ++n) {
            const double a = from + (to - from) * n / 2000;
            touch(middle + radius * glm::dvec3(std::cos(a), std::sin(a), 0), force);
        }
    }
    void again() { time_ = 0; }
    void fault(std::uint32_t bits) { faults_ = bits; }

    [[nodiscard]] HuntScore score() const { return scorer_.score(); }

private:
    void add(const glm::dvec3& place, double force, std::uint32_t buttons, const glm::dvec3& normal)
    {
        TickRecord s;
        Hand       hand;
        hand.buttons = buttons;
        s.time       = time_;
        s.proxy      = place;
        s.force      = {0, 0, force};
        s.normal     = normal;
        s.device     = hand.bits();
        s.faults     = faults_;
        scorer_.add(s);
        time_ += 1e-3;
    }

    HuntScorer    scorer_;
    double        time_   = 0; ///< [s]
    std::uint32_t faults_ = 0;
};

constexpr double kTurn = 2 * std::numbers::pi;

TEST(HuntScore, AWholeCircleTracesAllOfAnEdgeAndAHalfCircleHalf)
{
    Played played;
    played.arc(kFirst, 6e-3, 1e-3, kTurn - 1e-3); // not on the border of two sectors
    played.arc(kSecond, 3e-3, 1e-3, kTurn / 2 - 1e-3);

    EXPECT_EQ(played.score().nodules[0].edge, 1);
    EXPECT_EQ(played.score().nodules[1].edge, 0.5);
}

TEST(HuntScore, BesideTheEdgeOrTooSoftlyNothingIsTraced)
{
    Played played;
    played.arc(kFirst, 6e-3 - 1.6e-3, 0, kTurn); // the band is a quarter of 6 mm to either side
    played.arc(kFirst, 6e-3 + 1.6e-3, 0, kTurn);
    played.arc(kFirst, 6e-3, 0, kTurn, 0.19); // press_force is 0.2 N
    EXPECT_EQ(played.score().nodules[0].edge, 0);

    played.arc(kFirst, 6e-3 + 1.4e-3, 1e-3, kTurn / 4 - 1e-3, 0.21);
    EXPECT_EQ(played.score().nodules[0].edge, 0.25);
}

TEST(HuntScore, ADeclarationFindsWhatTheFingertipTouchesAndSaysHowFarOff)
{
    Played played;
    for (int n = 0; n < 100; ++n) played.touch({0, 0.02, 0});
    played.declare(kFirst + glm::dvec3(0, 3e-3, 0));
    played.declare(kFirst + glm::dvec3(0, -1e-3, 0));   // again: neither better nor a false alarm
    played.declare(kSecond + glm::dvec3(0, 5.1e-3, 0)); // 3 mm and a footprint of 2

    const HuntScore score = played.score();
    EXPECT_TRUE(score.nodules[0].found);
    EXPECT_NEAR(score.nodules[0].distance, 3e-3, 1e-15) << "rounding";
    EXPECT_NEAR(score.nodules[0].time, 0.1, 1e-9) << "a hundred sums of 1 ms";
    EXPECT_FALSE(score.nodules[1].found);
    ASSERT_EQ(score.declarations.size(), 3u);
    EXPECT_TRUE(score.declarations[1].again);
    EXPECT_EQ(score.declarations[2].nodule, Declaration::kNone);
    EXPECT_NEAR(score.declarations[2].distance, 5.1e-3, 1e-15) << "rounding";
    EXPECT_EQ(score.found, 1u);
    EXPECT_EQ(score.falseAlarms, 1u);
    EXPECT_DOUBLE_EQ(score.mark, 2.0 / (2 + 1 + 1));

    played.declare(kSecond + glm::dvec3(0, 4.9e-3, 0));
    EXPECT_TRUE(played.score().nodules[1].found);
}

TEST(HuntScore, AnInstantsPressAFaultAndTheAirDeclareNothing)
{
    Played played;
    played.declare(kFirst, ForceHalf::kPressTicks - 1);
    for (int n = 0; n < 100; ++n) played.air(2);
    played.touch(kFirst); // lets the button go
    played.fault(8);      // the governor has stopped: the button is its operator's
    played.declare(kFirst);

    EXPECT_EQ(played.score().declarations.size(), 0u);
    EXPECT_EQ(played.score().inAir, 1u);
}

TEST(HuntScore, ALongPressDeclaresOnce)
{
    Played played;
    played.declare(kFirst, 500);

    EXPECT_EQ(played.score().declarations.size(), 1u);
}

TEST(HuntScore, ForcesAreThoseOfASineInClosedForm)
{
    Played           played;
    constexpr int    kTicks = 2000; // of one arch F = 2 sin(pi t / T), T = 2 s
    constexpr double kPeak = 2, kTime = kTicks * 1e-3;
    for (int n = 0; n <= kTicks; ++n) played.touch({0, 0.02, 0}, kPeak * std::sin(std::numbers::pi * n / kTicks));

    const HuntScore  score = played.score();
    constexpr double kSum  = 1e-6; // relative: the sum over 2000 equal steps is off by (pi/2000)^2/12
    const double     mean  = kPeak * 2 / std::numbers::pi;
    EXPECT_EQ(score.peakForce, kPeak);
    EXPECT_NEAR(score.meanForce, mean, kSum * mean);
    EXPECT_NEAR(score.impulse, mean * kTime, kSum * mean * kTime);
    // Above 1.5 of 2 N from asin(3/4) on: a share 1 - 2 asin(3/4)/pi, to a tick at either end.
    EXPECT_NEAR(score.tooHard, 1 - 2 * std::asin(0.75) / std::numbers::pi, 1.5 / kTicks);
    EXPECT_NEAR(score.contact, kTime, 1e-9);
}

TEST(HuntScore, CoverageIsTheShareOfTheGroundsArea)
{
    Played played;
    for (double x = -30e-3; x <= 30e-3; x += 1e-4) played.touch({x, 0, 0});

    // A strip 4 mm wide across a disc of 30 mm, seen by random points: some 380 of 5000, +- 3 sigma = 1.1 % of the
    // disc.
    const double strip = 4e-3 * 60e-3 / (std::numbers::pi * 30e-3 * 30e-3);
    EXPECT_NEAR(played.score().coverage, strip, 0.011);
}

TEST(HuntScore, ASecondSessionGoesOnWhereTheFirstEnded)
{
    Played played;
    for (int n = 0; n < 1001; ++n) played.touch({0, 0.02, 0});
    played.again();
    played.declare(kFirst);

    EXPECT_NEAR(played.score().nodules[0].time, 1.0, 1e-9) << "sums of 1 ms";
    EXPECT_NEAR(played.score().contact, 1.0 + 20e-3, 1.5e-3) << "the step from session to session takes no time";
}

/// A scripted hand that presses its button, through the whole of a session, to the score and the picture.
TEST(Hunt, AScriptedHandIsScoredEndToEnd)
{
    const std::filesystem::path folder = std::filesystem::path(PALPATE_SAMPLES) / "scenes";
    const Scene                 scene  = readScene(folder / "nodule_hunt.json", {.toolKeys = &huntKeys()});
    const SoftObject            object = loadObject(scene).object;
    const HandPath              path   = readHand(folder / "nodule_hunt_hand.csv");
    ScriptedHand                hand(path);
    Deformation                 deformation(object, scene);
    HuntScorer                  scorer(scene, object.cloud());

    runVirtual({scene, object, deformation.solver(), hand, {}}, path.duration(),
               [&](const TickRecord& record) { scorer.add(record); });

    const HuntScore score = scorer.score();
    EXPECT_EQ(score.found, 3u);
    EXPECT_EQ(score.falseAlarms, 1u);
    EXPECT_FALSE(score.nodules[3].found);
    EXPECT_EQ(score.nodules[0].edge, 1) << "the file goes all around it";
    EXPECT_GE(score.nodules[1].edge, 0.5) << "half around it, and through its edge to the middle and away";
    EXPECT_LE(score.nodules[1].edge, 0.75);
    EXPECT_EQ(score.nodules[3].edge, 0) << "it was never near";
    EXPECT_LT(score.nodules[0].distance, 2e-3) << "declared 1.1 mm beside the middle, the contact lags by friction";
    EXPECT_GT(score.peakForce, 1);
    const std::string svg =
        huntSvg(score, object.cloud(), scene.place.value(), {0, 0, 1}, hiddenIn(scene)->hunt.ground);
    EXPECT_NE(svg.find("Nodules found: 3 of 4"), std::string::npos);
    EXPECT_NE(svg.find("nodule missed (1)"), std::string::npos);
    EXPECT_NE(svg.find("nothing there (1)"), std::string::npos);
    EXPECT_NE(svg.find("stroke-dasharray"), std::string::npos) << "missed ones are dashed, not only of another colour";
}

TEST(Hunt, ASceneWithoutOneCannotBeScored)
{
    const Scene scene = sheetScene(kWart);
    EXPECT_NE(
        refusalOf([&] { static_cast<void>(HuntScorer(scene, loadCloud(scene).cloud)); }).find("nothing is hidden"),
        std::string::npos);
}

} // namespace
} // namespace palp::study
