#include "engine/cloud/stiffness_painting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/cloud/samples.h"
#include "engine/core/contract.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

constexpr double kNan      = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Random places of a square sheet of the given side and mean spacing, at a height [m].
std::vector<glm::dvec3> sheet(double side, double spacing, double height, unsigned seed = 1)
{
    std::mt19937_64                  random(seed);
    std::uniform_real_distribution<> along(-side / 2, side / 2);
    std::vector<glm::dvec3>          places(std::size_t(side * side / (spacing * spacing)));
    for (glm::dvec3& p : places) p = {along(random), along(random), height};
    return places;
}

/// An object and its painting.
struct Painted {
    SoftObject        object;
    StiffnessPainting painting;

    Painted(std::vector<glm::dvec3> places, std::vector<double> stiffness, StiffnessKind kind = StiffnessKind::modulus,
            std::size_t history = StiffnessPainting::kHistoryBytes)
        : object(PointCloud(std::move(places), std::move(stiffness), kind)), painting(object, history)
    {
    }
    explicit Painted(std::vector<glm::dvec3> places, double stiffness = 1e5,
                     StiffnessKind kind    = StiffnessKind::modulus,
                     std::size_t   history = StiffnessPainting::kHistoryBytes)
        : Painted(places, std::vector<double>(places.size(), stiffness), kind, history)
    {
    }

    [[nodiscard]] std::vector<double> now() const { return {painting.stiffness().begin(), painting.stiffness().end()}; }
};

std::vector<double> roughStiffness(std::size_t count, unsigned seed = 7)
{
    std::mt19937_64                  random(seed);
    std::uniform_real_distribution<> exponent(4, 7);
    std::vector<double>              values(count);
    for (double& v : values) v = std::pow(10, exponent(random));
    return values;
}

TEST(StiffnessPainting, ADabGoesTowardsTheValueInLogarithmsByItsProfile)
{
    for (const StiffnessKind kind : {StiffnessKind::modulus, StiffnessKind::rigidity}) {
        Painted     p(sheet(40e-3, 0.5e-3, 0), 1e5, kind);
        const Brush brush{{1e-3, 2e-3, 0}, 8e-3, 0.6};

        p.painting.paint(brush, 1e7);

        for (std::size_t i = 0; i < p.object.size(); ++i) {
            const double t        = glm::length(p.object.positions()[i] - brush.centre) / brush.radius;
            const double coverage = t < 1 ? 0.6 * std::pow(1 - t * t, 2) : 0;
            EXPECT_NEAR(std::log10(p.painting.stiffness()[i]), 5 + 2 * coverage, 1e-12) << "some roundings of a double";
        }
        EXPECT_TRUE(p.painting.changed());
        EXPECT_EQ(p.painting.cloud().kind(), kind);
        EXPECT_EQ(p.painting.cloud().stiffness()[0], p.painting.stiffness()[0]);
    }
}

TEST(StiffnessPainting, FullStrengthGivesTheVeryValueInTheMiddle)
{
    Painted p(sheet(20e-3, 0.5e-3, 0), roughStiffness(1600));
    for (const double value : {0.1, 1.0 / 3, 2e6, 5e-324, 1e308}) {
        p.painting.paint({p.object.positions()[77], 3e-3, 1}, value);

        EXPECT_EQ(p.painting.stiffness()[77], value);
    }
}

TEST(StiffnessPainting, DabsOfOneStrokeDoNotPileUpButStrokesDo)
{
    const auto  places = sheet(20e-3, 0.5e-3, 0);
    Painted     once(places), often(places), strokes(places);
    const Brush brush{{0, 0, 0}, 5e-3, 0.5};
    Brush       weaker = brush;
    weaker.strength    = 0.2;

    once.painting.paint(brush, 1e7);
    often.painting.beginStroke();
    for (int k = 0; k < 20; ++k) often.painting.paint(brush, 1e7);
    often.painting.paint(weaker, 1e7);
    often.painting.endStroke();
    for (int k = 0; k < 3; ++k) strokes.painting.paint(brush, 1e7);

    EXPECT_EQ(often.now(), once.now());
    const auto largest = [](const std::vector<double>& values) {
        return *std::max_element(values.begin(), values.end());
    };
    EXPECT_LT(largest(once.now()), 1.001e6) << "half of the way from 1e5 to 1e7, in logarithms";
    EXPECT_GT(largest(strokes.now()), 5e6) << "seven eighths";
}

TEST(StiffnessPainting, AStrokeIsTheSameWhicheverWayItGoes)
{
    const auto              places = sheet(30e-3, 0.5e-3, 0);
    Painted                 there(places), back(places);
    std::vector<glm::dvec3> dabs = {{-5e-3, 0, 0}, {-3e-3, 1e-3, 0}, {0, 2e-3, 0}, {4e-3, 2e-3, 0}};
    const auto              draw = [&](Painted& p) {
        p.painting.beginStroke();
        for (const glm::dvec3& dab : dabs) p.painting.paint({dab, 4e-3, 0.8}, 3e6);
        p.painting.endStroke();
    };

    draw(there);
    std::reverse(dabs.begin(), dabs.end());
    draw(back);

    EXPECT_EQ(there.now(), back.now());
}

TEST(StiffnessPainting, TheOtherSideOfAThinSheetIsNotPainted)
{
    auto       places = sheet(30e-3, 0.3e-3, 0, 1);
    const auto below  = sheet(30e-3, 0.3e-3, -1e-3, 2);
    const auto upper  = places.size();
    places.insert(places.end(), below.begin(), below.end());
    for (const bool smooth : {false, true})
        for (const glm::dvec3& centre :
             {glm::dvec3(0, 0, 0.1e-3), glm::dvec3(13e-3, -14e-3, 0), glm::dvec3(0, 15e-3, 0)}) {
            Painted     p(places, roughStiffness(places.size()));
            const Brush brush{centre, 6e-3, 1};

            const auto touched = smooth ? p.painting.smooth(brush) : p.painting.paint(brush, 2e6);

            std::size_t inBall = 0, changedAbove = 0, changedBelow = 0;
            for (std::size_t i = 0; i < places.size(); ++i) {
                const bool changed = p.painting.stiffness()[i] != p.object.cloud().stiffness()[i];
                inBall += glm::length(places[i] - centre) < brush.radius ? i < upper : 0;
                (i < upper ? changedAbove : changedBelow) += changed;
            }
            EXPECT_EQ(changedBelow, 0u);
            EXPECT_EQ(changedAbove, inBall) << "every point of the upper side";
            EXPECT_EQ(touched.size(), inBall);
        }
}

TEST(StiffnessPainting, APieceThatDoesNotHangTogetherWithTheMiddleIsNotPainted)
{
    auto places = sheet(10e-3, 0.4e-3, 0, 1); // its right border at 5 mm
    for (glm::dvec3 p : sheet(10e-3, 0.4e-3, 0, 2)) places.push_back(p + glm::dvec3(12.5e-3, 0, 0)); // from 7.5 mm on
    Painted p(places);

    p.painting.paint({{4e-3, 0, 0}, 6e-3, 1}, 1e6);

    for (std::size_t i = 0; i < places.size(); ++i)
        if (places[i].x > 6e-3) {
            EXPECT_EQ(p.painting.stiffness()[i], 1e5);
        }
}

TEST(StiffnessPainting, WhereTheDensityStepsBothSidesArePainted)
{
    auto places = sheet(20e-3, 1e-3, 0, 1);
    std::erase_if(places, [](const glm::dvec3& p) { return p.x > 0; });
    for (const glm::dvec3& p : sheet(20e-3, 0.1e-3, 0, 2))
        if (p.x > 0) places.push_back(p);
    Painted p(places);

    for (const double x : {-2e-3, 2e-3}) {
        const auto  touched = p.painting.paint({{x, 0, 0}, 6e-3, 1}, 1e6);
        std::size_t inBall  = 0;
        for (const glm::dvec3& place : places) inBall += glm::length(place - glm::dvec3(x, 0, 0)) <= 6e-3;
        EXPECT_GE(double(touched.size()), 0.999 * double(inBall)) << "two lone points beside the step are 2.5e-4";
        EXPECT_LE(touched.size(), inBall);
    }
}

TEST(StiffnessPainting, SmoothingGoesTowardsTheMeanOfLogarithmsAndLeavesEqualsAlone)
{
    const auto          places = sheet(30e-3, 0.4e-3, 0);
    std::vector<double> step(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) step[i] = places[i].x < 0 ? 1e4 : 1e6;
    Painted p(places, step), even(places, 0.1);

    p.painting.smooth({{0, 0, 0}, 10e-3, 1});
    even.painting.smooth({{0, 0, 0}, 10e-3, 1});

    EXPECT_FALSE(even.painting.changed()) << "to the bit";
    double sum  = 0;
    int    near = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double v = p.painting.stiffness()[i];
        EXPECT_GE(v, 1e4);
        EXPECT_LE(v, 1e6);
        if (std::abs(places[i].x) > 2.1e-3) {
            EXPECT_EQ(v, step[i]) << "an eighth of the radius, or four spacings of about 0.4 mm";
        }
        if (glm::length(places[i]) < 2e-3 && std::abs(places[i].x) < 0.2e-3) {
            sum += std::log10(v);
            ++near;
        }
    }
    ASSERT_GT(near, 5);
    EXPECT_NEAR(sum / near, 5, 0.35)
        << "halfway beside the step; 30 random points on either side are uneven by a tenth "
           "or two";
}

TEST(StiffnessPainting, SmoothingIsTheStatedMean)
{
    const auto   places = sheet(16e-3, 0.5e-3, 0);
    Painted      p(places, roughStiffness(places.size()));
    const Brush  brush{places[10], 40e-3, 1}; // all points; an eighth is more than four spacings, which hold therefore
    const double radius = 4 * p.object.survey().spacing(10);

    p.painting.smooth(brush);

    double sum = 0, weights = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double d = glm::length(places[i] - places[10]), w = std::max(0.0, 1 - d * d / (radius * radius));
        sum += w * std::log(p.object.cloud().stiffness()[i]);
        weights += w;
    }
    EXPECT_NEAR(std::log(p.painting.stiffness()[10]), sum / weights, 1e-12) << "the order of fifty sums";
}

TEST(StiffnessPainting, AStrokeSmoothsWhatWasThereWhenItBegan)
{
    const auto places = sheet(20e-3, 0.5e-3, 0);
    Painted    once(places, roughStiffness(places.size())), twice(places, roughStiffness(places.size()));
    once.painting.smooth({{0, 0, 0}, 8e-3, 1});
    Brush weaker{{0, 0, 0}, 8e-3, 0.5};

    twice.painting.beginStroke();
    twice.painting.smooth(weaker);
    twice.painting.smooth({{0, 0, 0}, 8e-3, 1});
    twice.painting.endStroke();

    EXPECT_EQ(twice.now(), once.now());
}

/// Strokes of both sorts at random places.
void strokeAtRandom(StiffnessPainting& painting, std::mt19937_64& random, std::span<const glm::dvec3> places)
{
    std::uniform_real_distribution<> unit(0, 1);
    painting.beginStroke();
    for (int dab = 0; dab < 3; ++dab) {
        const Brush brush{places[random() % places.size()], 1e-3 + 4e-3 * unit(random), unit(random)};
        if (random() % 2)
            painting.paint(brush, std::pow(10, 12 * unit(random) - 3));
        else
            painting.smooth(brush);
    }
    painting.endStroke();
}

TEST(StiffnessPainting, UndoAndRedoAreExactToTheBit)
{
    const auto                       places = sheet(20e-3, 0.5e-3, 0);
    Painted                          p(places, roughStiffness(places.size()));
    std::mt19937_64                  random(3);
    std::vector<std::vector<double>> states{p.now()};
    for (int k = 0; k < 20; ++k) {
        strokeAtRandom(p.painting, random, places);
        states.push_back(p.now());
        ASSERT_NE(states[states.size() - 2], states.back());
    }

    for (int round = 0; round < 2; ++round) {
        for (std::size_t k = 20; k > 0; --k) {
            EXPECT_TRUE(p.painting.canUndo());
            EXPECT_FALSE(p.painting.undo().empty());
            ASSERT_EQ(p.now(), states[k - 1]);
        }
        EXPECT_FALSE(p.painting.canUndo());
        EXPECT_TRUE(p.painting.undo().empty());
        EXPECT_FALSE(p.painting.changed());
        for (std::size_t k = 1; k <= 20; ++k) {
            EXPECT_TRUE(p.painting.canRedo());
            EXPECT_FALSE(p.painting.redo().empty());
            ASSERT_EQ(p.now(), states[k]);
        }
        EXPECT_FALSE(p.painting.canRedo());
        EXPECT_TRUE(p.painting.redo().empty());
        EXPECT_TRUE(p.painting.changed());
    }
}

TEST(StiffnessPainting, AStrokeAfterUndoForgetsWhatWasTakenBackAndOneThatChangesNothingIsNoStep)
{
    Painted     p(sheet(20e-3, 0.5e-3, 0));
    const Brush brush{{0, 0, 0}, 3e-3, 1};
    p.painting.paint(brush, 2e5);
    p.painting.undo();
    p.painting.paint(brush, 1e5); // what it is
    EXPECT_TRUE(p.painting.canRedo());
    EXPECT_FALSE(p.painting.canUndo());
    p.painting.paint({{0, 0, 1}, 3e-3, 1}, 3e5); // nothing is there
    EXPECT_TRUE(p.painting.canRedo());

    p.painting.paint(brush, 3e5);

    EXPECT_FALSE(p.painting.canRedo());
    EXPECT_TRUE(p.painting.canUndo());
    p.painting.undo();
    EXPECT_FALSE(p.painting.changed());
}

TEST(StiffnessPainting, UndoEndsAStrokeThatGoesOn)
{
    Painted p(sheet(20e-3, 0.5e-3, 0));
    p.painting.beginStroke();
    p.painting.paint({{0, 0, 0}, 3e-3, 1}, 2e5);
    p.painting.paint({{1e-3, 0, 0}, 3e-3, 1}, 2e5);
    EXPECT_TRUE(p.painting.canUndo());

    p.painting.undo();

    EXPECT_FALSE(p.painting.changed());
    EXPECT_TRUE(p.painting.canRedo());
}

TEST(StiffnessPainting, TheHistoryKeepsToItsBoundButNeverForgetsTheLastStroke)
{
    const auto            places = sheet(20e-3, 0.5e-3, 0);
    constexpr std::size_t kMost  = 20'000; // [bytes]
    Painted               p(places, 1e5, StiffnessKind::modulus, kMost), tiny(places, 1e5, StiffnessKind::modulus, 1);
    std::mt19937_64       random(5);
    for (int k = 0; k < 200; ++k) {
        strokeAtRandom(p.painting, random, places);
        EXPECT_LE(p.painting.historyBytes(), kMost);
    }
    const std::size_t held = p.painting.historyBytes();
    int               back = 0;
    while (!p.painting.undo().empty()) ++back;
    EXPECT_GT(back, 3);
    EXPECT_LT(back, 200);
    EXPECT_EQ(p.painting.historyBytes(), held) << "what was taken back is still held";

    for (const double value : {2e5, 3e5}) tiny.painting.paint({{0, 0, 0}, 5e-3, 1}, value);
    EXPECT_GT(tiny.painting.historyBytes(), 12 * 200u);
    EXPECT_FALSE(tiny.painting.undo().empty());
    EXPECT_EQ(*std::max_element(tiny.painting.stiffness().begin(), tiny.painting.stiffness().end()) > 1.9e5, true);
    EXPECT_TRUE(tiny.painting.undo().empty());
}

TEST(StiffnessPainting, EveryValueStaysPositiveAndFinite)
{
    const auto          places = sheet(20e-3, 0.5e-3, 0);
    std::vector<double> extremes(places.size());
    for (std::size_t i = 0; i < extremes.size(); ++i) extremes[i] = i % 2 ? 5e-324 : 1.7e308;
    Painted p(places, extremes);
    for (const double value : {5e-324, 1.7976931348623157e308, 1.0, 2.2e-308})
        for (const double strength : {1e-300, 0.3, 0.999999999, 1.0}) {
            p.painting.paint({{0, 0, 0}, 8e-3, strength}, value);
            p.painting.smooth({{1e-3, 0, 0}, 8e-3, strength});
        }

    EXPECT_NO_THROW(static_cast<void>(p.painting.cloud())) << "a cloud checks every value";
}

TEST(StiffnessPainting, ABrushOrAValueThatIsNoneIsRefusedByName)
{
    Painted     p(sheet(10e-3, 0.5e-3, 0), 1e5, StiffnessKind::rigidity);
    const Brush good{{0, 0, 0}, 3e-3, 1};
    const auto  refusal = [&](const Brush& brush, double value = 1) {
        const std::string smoothing = refusalOf([&] { p.painting.smooth(brush); });
        const std::string painting  = refusalOf([&] { p.painting.paint(brush, value); });
        EXPECT_TRUE(value != 1 || smoothing == painting);
        return painting;
    };

    EXPECT_TRUE(holds(refusal({{0, kNan, 0}, 3e-3, 1}), {"finite centre", "nan"}));
    EXPECT_TRUE(holds(refusal({{0, 0, -kInfinity}, 3e-3, 1}), {"finite centre", "-inf"}));
    for (const double radius : {0.0, -1e-3, kNan, kInfinity})
        EXPECT_TRUE(holds(refusal({{0, 0, 0}, radius, 1}), {"finite radius above zero [m]"}));
    for (const double strength : {-0.1, 1.1, kNan})
        EXPECT_TRUE(holds(refusal({{0, 0, 0}, 3e-3, strength}), {"strength from 0 to 1"}));
    for (const double value : {0.0, -1.0, kNan, kInfinity})
        EXPECT_TRUE(holds(refusal(good, value), {"finite stiffness above zero [N_m]"}));
    EXPECT_FALSE(p.painting.changed());
    EXPECT_FALSE(p.painting.canUndo());
    EXPECT_THROW(Painted({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), Error) << "three points are no surface";
}

TEST(StiffnessPainting, ChangedComparesWithTheFirstCloud)
{
    Painted     p(sheet(10e-3, 0.5e-3, 0));
    const Brush dot{p.object.positions()[3], 0.01e-3, 1}; // one point
    p.painting.paint(dot, 2e5);
    EXPECT_TRUE(p.painting.changed());
    p.painting.paint(dot, 1e5);
    EXPECT_FALSE(p.painting.changed()) << "painted back";
}

TEST(DabsAlong, AreCloseEnoughAndLieOnTheObject)
{
    const SoftObject      ball(makeSample(sampleNamed("hemisphere"), 40'000, 1));
    const NeighbourIndex& index = ball.index();
    const glm::dvec3      a     = ball.positions()[0],
                     b          = ball.positions()[index.nearest(a + glm::dvec3(0.02, 0.01, 0), 1)[0].point];
    const std::vector path{a, b};
    constexpr double  kRadius = 4e-3; // [m]

    const auto dabs = dabsAlong(path, kRadius, ball);

    ASSERT_GT(dabs.size(), 15u);
    EXPECT_EQ(dabs.front(), a);
    EXPECT_EQ(dabs.back(), b);
    for (std::size_t k = 0; k < dabs.size(); ++k) {
        EXPECT_EQ(index.nearest(dabs[k], 1)[0].distance, 0) << "on the object";
        if (k > 0) {
            EXPECT_LT(glm::length(dabs[k] - dabs[k - 1]), kRadius / 8 + 2 * index.spacing());
        }
    }
    EXPECT_EQ(dabsAlong(std::vector{a}, kRadius, ball), std::vector{a});
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(dabsAlong(path, 1e-7, ball)); }),
                      {"at most 1e+05 dabs", "larger radius"}));
}

} // namespace
} // namespace palp
