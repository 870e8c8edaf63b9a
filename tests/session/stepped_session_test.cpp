#include "engine/session/stepped_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "engine/session/recorded_session.h"
#include "engine/session/scene.h"
#include "engine/session/servo.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

/// Points of a caller's own, each with all that can be said of it.
LoadedCloud ownPoints()
{
    std::mt19937_64                        bits(1);
    std::uniform_real_distribution<double> random(-1, 1);
    std::vector<glm::dvec3>                positions;
    std::vector<glm::vec3>                 normals;
    std::vector<double>                    stiffness, stiffening, foundation;
    for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j) {
            const double up = 1e-4 * random(bits), lean = 0.3 * random(bits);
            positions.emplace_back(1e-3 * i, 1e-3 * j, up);
            normals.push_back(glm::vec3(glm::normalize(glm::dvec3(lean, 0.1, 1))));
            stiffness.push_back(3e5 * (1.5 + random(bits)));
            stiffening.push_back(400 * (1.5 + random(bits)));
            foundation.push_back(1e6 * (1.5 + random(bits)));
        }
    LoadedCloud own{.cloud   = PointCloud(std::move(positions), std::move(stiffness), StiffnessKind::modulus),
                    .report  = {},
                    .normals = std::move(normals)};
    own.stiffening = std::move(stiffening);
    own.foundation = std::move(foundation);
    return own;
}

Scene ownScene(const char* more = "")
{
    return parseScene(
        std::string(R"({"foundation": 1e6, "below": "own", "window": "20 mm", "cells": 16, "solver": "host",
        "footprint_radius": "2 mm")") +
            more + "}",
        "scene", ".", {.withoutCloud = true});
}

/// A recording of a caller's points is a folder that can be moved, and has all of what was said of them.
TEST(SteppedSession, ARecordingOfOwnPointsHasAllThatWasSaidOfThem)
{
    const TemporaryFolder folder;
    const auto            own    = std::make_shared<const LoadedCloud>(ownPoints());
    const Scene           scene  = ownScene();
    const SoftObject      object = objectOf(*own, scene).object;
    {
        SteppedSession session(object, scene, {}, own);
        session.record(folder.path() / "there", "a test");
        for (int n = 0; n < 20; ++n) session.step(1e-3 * n, {.position = {0, 0, 5e-3}});
        EXPECT_EQ(session.stopRecording().ticks, 20U);
    }
    std::filesystem::rename(folder.path() / "there", folder.path() / "moved");
    const Scene      read  = sceneOf(readSession((folder.path() / "moved").string()));
    const SoftObject again = loadObject(read).object;
    ASSERT_EQ(again.size(), object.size());
    EXPECT_TRUE(std::ranges::equal(again.stiffening(), object.stiffening()));
    EXPECT_TRUE(std::ranges::equal(again.foundationShape(), object.foundationShape()));
    EXPECT_TRUE(std::ranges::equal(again.cloud().stiffness(), object.cloud().stiffness()));
    for (std::uint32_t n = 0; n < object.size(); ++n) {
        EXPECT_EQ(again.positions()[n], object.positions()[n]) << n;
        EXPECT_EQ(again.survey().normal(n), object.survey().normal(n)) << n;
    }
}

/// While the clutch is held the tool stays; afterwards it goes on from there. A tracker that has lost the hand moves
/// nothing.
TEST(SteppedSession, TheScenesClutchHoldsTheTool)
{
    const auto     own   = std::make_shared<const LoadedCloud>(ownPoints());
    const Scene    scene = ownScene(R"(, "clutch_button": 2)");
    SteppedSession session(objectOf(*own, scene).object, scene, {}, own);
    double         time = 0;
    const auto     tick = [&](double height, std::uint32_t buttons) {
        Hand hand;
        hand.position = {0, 0, height};
        hand.buttons  = buttons;
        return session.step(time += 1e-3, hand);
    };
    EXPECT_EQ(tick(5e-3, 0).hip.z, 5e-3);
    for (int n = 0; n < 10; ++n) {
        const TickRecord held = tick(5e-3 + 1e-4 * n, 2);
        EXPECT_EQ(held.hip.z, 5e-3) << n;
        EXPECT_EQ(held.device >> 16U, 0U) << "the button means nothing else";
        EXPECT_NE(held.device & 1U << 11U, 0U);
    }
    EXPECT_NEAR(tick(5.9e-3, 0).hip.z, 5e-3, 1e-12);
    EXPECT_NEAR(tick(5.8e-3, 0).hip.z, 4.9e-3, 1e-12);
    Hand lost;
    lost.device = DeviceFault::silent;
    EXPECT_NEAR(session.step(time += 1e-3, lost).hip.z, 4.9e-3, 1e-12);
    EXPECT_NEAR(tick(5.8e-3, 2).hip.z, 4.9e-3, 1e-12);
    EXPECT_NEAR(tick(5.7e-3, 0).hip.z, 4.8e-3, 1e-12);
}

/// What a hand feels, and where, whose first ticks are a tracker's that has not found it yet.
class AbsentHand : public testing::Test {
protected:
    /// Goes to a place and stays there; returns the last tick.
    TickRecord go(SteppedSession& session, const glm::dvec3& to, double seconds)
    {
        const glm::dvec3 from = at_;
        TickRecord       last;
        for (double t = 0; t < seconds; t += 1e-3) {
            at_  = glm::mix(from, to, std::min(1.0, 2 * t / seconds));
            last = session.step(time_ += 1e-3, {.position = at_});
            std::this_thread::sleep_for(std::chrono::microseconds(200)); // for the plate's thread
        }
        return last;
    }

    /// Says for some ticks that there is no hand; returns the last one.
    TickRecord lose(SteppedSession& session, const glm::dvec3& said, int ticks)
    {
        Hand lost{.position = said};
        lost.device = DeviceFault::silent;
        TickRecord last;
        for (int n = 0; n < ticks; ++n) {
            last = session.step(time_ += 1e-3, lost);
            EXPECT_EQ(last.force, glm::dvec3(0));
        }
        return last;
    }

    glm::dvec3 at_{0, 0, 6e-3}; ///< [m]
    double     time_ = 0;       ///< [s]
};

TEST_F(AbsentHand, IsNowhereUntilItIsFound)
{
    const auto own = std::make_shared<const LoadedCloud>(ownPoints());
    enum class First { there, absent, nonsense, clutch };
    for (const First first : {First::there, First::absent, First::nonsense, First::clutch}) {
        const Scene    scene = ownScene(first == First::clutch ? R"(, "clutch_button": 2)" : "");
        SteppedSession session(objectOf(*own, scene).object, scene, {}, own);
        at_ = {0, 0, 6e-3};
        if (first == First::nonsense)
            session.step(time_ += 1e-3, {.position = glm::dvec3(std::nan(""))});
        else if (first != First::there) // below the sheet, where nobody's hand is
            lose(session, first == First::clutch ? at_ : glm::dvec3(0, 0, -5e-3), 5);
        go(session, at_, 0.5);
        const TickRecord pressed = go(session, {0, 0, -1e-3}, 0.6);
        EXPECT_GT(pressed.force.z, 0.05) << int(first);
        EXPECT_GT(pressed.normal.z, 0.5) << int(first) << ": the side from which it came";
    }
}

TEST_F(AbsentHand, ThatIsLostAndFoundIsOnTheSideWhereItWas)
{
    const auto     own   = std::make_shared<const LoadedCloud>(ownPoints());
    const Scene    scene = ownScene();
    SteppedSession session(objectOf(*own, scene).object, scene, {}, own);
    go(session, at_, 0.5);
    const TickRecord lost = lose(session, {0, 0, -20e-3}, 300);
    EXPECT_EQ(lost.hip, at_);
    EXPECT_EQ(lost.proxy, at_) << "the tool stays where the hand was last";
    at_ = {0, 0, 5e-4};
    go(session, {0, 0, 3e-3}, 0.6);
    const TickRecord pressed = go(session, {0, 0, -1e-3}, 0.6);
    EXPECT_GT(pressed.force.z, 0.05);
    EXPECT_GT(pressed.normal.z, 0.5);
}

/// A device that never tells its place leaves the tool where the hand has come from, on that side of the surface.
TEST(ContactHalf, AHandWithoutAPlaceIsWhereItHasComeFrom)
{
    const auto       own    = std::make_shared<const LoadedCloud>(ownPoints());
    const Scene      scene  = ownScene();
    const SoftObject object = objectOf(*own, scene).object;
    const glm::dvec3 from(0, 0, 6e-3);
    ContactHalf      contact(object, scene, from);
    Hand             hand{.position = {0, 0, -3e-3}};
    hand.device = DeviceFault::startingUp;
    for (int n = 0; n < 3; ++n) {
        const ProxyContact& held = contact.tick(1e-3 * n, hand, {});
        EXPECT_EQ(held.touch.point, from);
        EXPECT_TRUE(held.behind) << "no force, wherever it turns up";
        EXPECT_EQ(held.touch.sequence, 0U) << "nothing to solve";
    }
    hand.device             = DeviceFault::none;
    const ProxyContact held = contact.tick(3e-3, hand, {});
    EXPECT_TRUE(held.touch.touching);
    EXPECT_GT(held.touch.outward.z, 0.5) << "it hangs below the surface, which it has come from above";
}

/// A hand that its device goes on telling of is followed, though no force flows: round an edge it is on the other side.
TEST_F(AbsentHand, WhoseDeviceHasStoppedByItselfIsFollowed)
{
    const auto     own   = std::make_shared<const LoadedCloud>(ownPoints());
    const Scene    scene = ownScene();
    SteppedSession session(objectOf(*own, scene).object, scene, {}, own);
    go(session, at_, 0.5);
    for (const glm::dvec3& to : {glm::dvec3(60e-3, 0, 6e-3), {60e-3, 0, -20e-3}, {0, 0, -20e-3}})
        for (int n = 0; n < 200; ++n) {
            at_ = glm::mix(at_, to, 0.05);
            Hand stopped{.position = at_};
            stopped.device = DeviceFault::ownWatchdog;
            EXPECT_EQ(session.step(time_ += 1e-3, stopped).force, glm::dvec3(0));
        }
    const TickRecord there = go(session, at_, 0.5);
    EXPECT_EQ(there.normal, glm::dvec3(0)) << "in the air below";
    EXPECT_NEAR(there.proxy.z, at_.z, 1e-9);
}

/// The first button is the clutch: held down after a fault it resets that too, as every first button does.
TEST_F(AbsentHand, AClutchThatIsTheFirstButtonResetsAFault)
{
    const auto     own   = std::make_shared<const LoadedCloud>(ownPoints());
    const Scene    scene = ownScene(R"(, "clutch_button": 1)");
    SteppedSession session(objectOf(*own, scene).object, scene, {}, own);
    const auto     fault = [](const TickRecord& tick) { return static_cast<GovernorFault>(tick.faults & 0xFFU); };
    go(session, at_, 0.1);
    time_ += 0.5; // the host had stopped
    ASSERT_NE(fault(session.step(time_, {.position = at_})), GovernorFault::none);
    EXPECT_NE(fault(go(session, at_, 0.1)), GovernorFault::none);
    TickRecord held;
    for (int n = 0; n < 30; ++n) held = session.step(time_ += 1e-3, {.position = at_, .buttons = 1});
    EXPECT_EQ(fault(held), GovernorFault::none);
    EXPECT_EQ(held.force, glm::dvec3(0));
}

} // namespace
} // namespace palp
