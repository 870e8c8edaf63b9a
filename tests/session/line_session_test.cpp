// Sessions in virtual time on emulated devices behind the drivers of real ones, each with the mass, the damping, the
// rate and the delay that its emulator has.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>

#include "engine/session/gripped_haply.h"
#include "engine/session/replay_device.h"
#include "tests/session/gripped_session.h"

namespace palp {
namespace {

struct Kind {
    const char* name; ///< as --hand has it
    double      cap;  ///< [N/m] that the device states
};

class LineSessions : public ::testing::TestWithParam<Kind> {};

INSTANTIATE_TEST_SUITE_P(On, LineSessions, ::testing::Values(Kind{"haply-emulator", 800}), [](const auto& which) {
    std::string name = which.param.name;
    std::erase(name, '-');
    return name;
});

TEST_P(LineSessions, AnArmThatIsPressedIntoAStiffWallComesToRestAtTheCap)
{
    EXPECT_EQ(restAtTheCap(GetParam().name, 3e-3), GetParam().cap) << "as the device states";
}

/// Ten seconds of touch over a wart: no fault, nothing that is not finite, the force in steps that the governor allows.
TEST_P(LineSessions, AHandThatExploresAWartMeetsNoFault)
{
    std::vector<HandPose> way;
    for (double t = 0; t <= 10; t += 5e-3)
        way.push_back({t,
                       {15e-3 * std::sin(1.1 * t), 9e-3 * std::sin(0.7 * t),
                        t < 2 ? 6e-3 : -2e-3 + 5e-3 * std::cos(2 * 3.14159 * 0.37 * (t - 2))}});
    GrippedSession s(GetParam().name, sheetScene(kWart), HandPath(std::move(way)), {.stiffness = 2000, .damping = 5});
    bool           finite = true;
    double         most = 0, step = 0; // [N]
    glm::dvec3     last{};
    const auto     summary = s.run(10, [&](const TickRecord& record) {
        finite = finite && std::isfinite(glm::length(record.force) + glm::length(record.hip));
        most   = std::max(most, glm::length(record.force));
        step   = std::max(step, glm::length(record.force - last));
        last   = record.force;
    });
    EXPECT_TRUE(finite);
    EXPECT_EQ(summary.fault, GovernorFault::none);
    EXPECT_EQ(summary.deviceFault, DeviceFault::none);
    EXPECT_GT(2 * summary.contactTicks, summary.ticks);
    EXPECT_GT(most, 1.0);
    EXPECT_LE(step, 1 + 1e-9) << "the governor's slew [N]";
}

/// The wire of a Haply carries the governor's force, turned into the service's frame and back.
TEST(HaplySession, TheForceAtTheCursorIsTheGovernors)
{
    const HandPath path = pressing(3e-3);
    GrippingHand   hand{path, {.stiffness = 500, .damping = 2}, deviceFrame({0, 0, 6e-3}, {0, 0, 1})};
    GrippedHaply   haply(hand);
    haply.open();
    SheetSession session(sheetScene(kWart));
    Deformation  deformation(session.object, session.scene);
    glm::dvec3   sent{};
    double       worst = 0, most = 0; // [N]
    (void)runVirtual({session.scene, session.object, deformation.solver(), haply, hand.frame}, 4,
                     [&](const TickRecord& record) {
                         const glm::dvec3 felt = hand.frame.sceneFromDevice * haply.emulator().force();
                         worst                 = std::max(worst, glm::length(felt - sent));
                         most                  = std::max(most, glm::length(sent));
                         sent                  = record.force;
                     });
    EXPECT_GT(most, 0.5);
    EXPECT_LT(worst, 1e-4) << "four decimal places, in three directions";
}

/// How the grip is turned and what it presses goes over the wire into a recording, and back out of it.
TEST(HaplySession, TheGripsTurnAndButtonsAreRecordedAndReplayed)
{
    const glm::dquat tilt = glm::angleAxis(0.6, glm::normalize(glm::dvec3(1, 2, -1)));
    const HandPath path({{0, {5e-3, 0, 6e-3}, 0, tilt}, {1, {5e-3, 0, 6e-3}, 8, tilt}, {9, {5e-3, 0, 6e-3}, 8, tilt}});
    GrippingHand   hand{path, {.stiffness = 500, .damping = 2}, deviceFrame({0, 0, 6e-3}, {0, 0, 1})};
    GrippedHaply   haply(hand);
    haply.open();
    SheetSession            session(sheetScene(kWart));
    Deformation             deformation(session.object, session.scene);
    std::vector<TickRecord> records;
    const auto              note = [&](const TickRecord& record) { records.push_back(record); };
    (void)runVirtual({session.scene, session.object, deformation.solver(), haply, hand.frame}, 1.5, note);
    EXPECT_NEAR(std::abs(glm::dot(records.back().orientation, tilt)), 1, 1e-12) << "rounding of decimal text";
    EXPECT_EQ(records.back().device >> 16U, 8U);
    EXPECT_EQ(records[500].device >> 16U, 0U);

    ReplayDevice replay(records, haply.info());
    EXPECT_TRUE(replay.info().rotates);
    HapticState state;
    for (std::size_t n = 0; n < records.size(); ++n) state = replay.read(records[n].time);
    EXPECT_EQ(state.orientation, records.back().orientation);
    EXPECT_EQ(state.buttons, 8U);
}

} // namespace
} // namespace palp
