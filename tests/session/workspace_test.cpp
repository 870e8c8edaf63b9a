// A workspace that is scaled, and the clutch: sessions in virtual time on emulated devices.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <glm/geometric.hpp>

#include "engine/session/clutch.h"
#include "engine/session/gripped_haply.h"
#include "engine/session/recorded_session.h"
#include "engine/session/replay_device.h"
#include "engine/session/session_hand.h"
#include "tests/session/gripped_session.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

constexpr double kScale = 3; // [1] as of a workspace of 40 mm before an object of 120 mm

Scene scaled(const char* stiffness, double scale = kScale)
{
    Scene scene          = sheetScene(stiffness);
    scene.workspaceScale = scale;
    return scene;
}

class ScaledSessions : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(On, ScaledSessions, ::testing::Values("haply-emulator", "arm", "falcon-emulator"),
                         [](const auto& which) {
                             std::string name = which.param;
                             std::erase(name, '-');
                             return name;
                         });

/// A spring of K in the scene is one of 3 K at the device. The wall is stiffer than anything: what binds is the cap of
/// the device, and the arm comes to rest there.
TEST_P(ScaledSessions, APressedWallComesToRestAtTheCapOfTheDevice)
{
    EXPECT_GT(restAtTheCap(GetParam(), 9e-3, kScale), 0);
}

/// Let go of on a spring at the cap that pulls from both sides, which no surface does, the arm settles: the servo's
/// whole second half, at a scale, on an arm like a Falcon's. A spring three times as stiff at the device would swing
/// for ever.
TEST(ScaledServo, AReleasedArmOnATwoSidedSpringAtTheCapSettles)
{
    ArmDevice   arm;
    DeviceFrame frame;
    frame.scale = kScale;
    arm.open();
    ForceHalf                  half(scaled(kStiff), arm.info());
    PatchUpdate                stiff; // one entry that is stiffer than any cap
    std::array<PatchUpdate, 2> published;
    stiff.table.compliance[0].value       = std::log(1e-6);
    stiff.table.contactStiffness[0].value = std::log(1e6);
    double     before = 0, released = 0, left = 0, stiffest = 0; // [m] of the device, [N/m]
    TickRecord record;
    for (int n = 0; n < 7000; ++n) {
        const double time = n * 1e-3;
        if (n % 16 == 0) {
            PatchUpdate& next   = published[std::size_t(n / 16 % 2)]; // the other one is in use
            next                = stiff;
            next.table.sequence = std::uint64_t(n + 1);
            next.table.time     = time;
        }
        if (n < 2000) arm.holdBy({.stiffness = 2000, .damping = 20});
        if (n == 2000) arm.holdBy({.stiffness = 2000, .damping = 20, .target = {0, 1e-3, 0}});
        if (n == 2300) arm.holdBy({});
        const Hand   hand = frame.handOf(arm.read(time));
        ProxyContact held;
        held.touch = {std::uint64_t(n + 1), time, true, {}, {0, 1, 0}, {}};
        held.pull  = {0, -hand.position.y, 0};
        record     = half.tick({time, 1e-3}, hand, held, &published[std::size_t(n / 16 % 2)]);
        arm.render(frame.toDevice(half.governor().force()));
        const double away = std::abs(arm.arm().position().y);
        stiffest          = std::max(stiffest, record.stiffness * kScale);
        if (n >= 2000 && n < 2300) before = away;
        if (n >= 2300 && n < 2500) released = std::max(released, away);
        if (n >= 6000) left = std::max(left, away);
    }
    std::printf("  %.0f N/m at the device, released at %.2f mm, left %.4f mm\n", stiffest, before * 1e3, left * 1e3);
    EXPECT_EQ(record.faults & 0xFFU, 0U);
    EXPECT_GT(stiffest, 0.9 * half.governor().stiffnessCap()) << "the cap binds";
    EXPECT_GT(released, 0.3e-3) << "or the test says nothing";
    EXPECT_LT(left, 2 * 48e-6) << "two of its encoder's steps";
}

/// Let go of while it is pressed into that wall, the arm springs out and settles: the hand leaves the grip at its
/// deepest.
TEST(ScaledHaply, AReleasedArmSettles)
{
    const HandPath path = pressing(9e-3);
    GrippingHand   hand{path, {.stiffness = 500, .damping = 2}, deviceFrame({0, 0, 6e-3}, {0, 0, 1})};
    hand.frame.scale = kScale;
    GrippedHaply haply(hand);
    haply.open();
    SheetSession session(scaled(kStiff));
    Deformation  deformation(session.object, session.scene);
    double       before = 0, fastest = 0, late = 0; // [N], [m/s] of the device
    const auto   summary = runVirtual({session.scene, session.object, deformation.solver(), haply, hand.frame}, 8,
                                      [&](const TickRecord& r) {
                                        const double speed = glm::length(r.hipVelocity) / kScale;
                                        if (r.time < 4) before = glm::length(r.force);
                                        if (r.time >= 4) haply.letGo();
                                        if (r.time >= 4) fastest = std::max(fastest, speed);
                                        if (r.time >= 7) late = std::max(late, speed);
                                    });
    std::printf("  released at %.2f N: at most %.3f m/s, %.5f m/s at the end\n", before, fastest, late);
    EXPECT_EQ(summary.fault, GovernorFault::none);
    EXPECT_GT(before, 0.5) << "or nothing was released";
    EXPECT_GT(fastest, 1e-3);
    EXPECT_LT(fastest, 1.2) << "the governor's most";
    EXPECT_LT(late, 1e-4) << "at rest: its damping of 2 N s/m stops 0.3 kg in 0.15 s";
}

/// What the device is given is what the scene has: the same force where the hand has gone a third of the way.
TEST(ScaledSession, ForcesAreNotScaled)
{
    const SheetSession session(scaled(kWart, 1)), same(scaled(kWart));
    Deformation        deformation(session.object, session.scene);
    GovernedForce      given;
    struct Device : ScriptedHand {
        Device(const HandPath& path, GovernedForce& to) : ScriptedHand(path), given(to) {}
        HapticState read(double now) noexcept override
        {
            HapticState state = ScriptedHand::read(now);
            state.position    = state.position / kScale;
            state.velocity    = state.velocity / kScale;
            return state;
        }
        void           render(const GovernedForce& force) noexcept override { given = force; }
        GovernedForce& given;
    };
    Device      device(same.hand, given);
    DeviceFrame frame;
    frame.scale = kScale;
    double most = 0;
    (void)runVirtual(
        {same.scene, same.object, deformation.solver(), device, frame}, 1.5, [&](const TickRecord& record) {
            EXPECT_EQ(given.newtons(), record.force) << "at " << record.time; // rendered before the tick is told
            most = std::max(most, glm::length(record.force));
            EXPECT_NEAR(record.hip.x, same.hand.position(record.time).x, 1e-15) << "rounding of a third";
        });
    EXPECT_GT(most, 0.2);
}

/// A replay computes with the hand in the scene: the same bits come out, scale and clutch included.
TEST(ScaledSession, AReplayGivesTheSameBits)
{
    // Places that no short number says, along all axes, so that what is carried back and forth is rounded.
    const HandPath  path({{0, {5.1e-3, 1.3e-3, 6.7e-3}},
                          {2, {5.1e-3, 1.3e-3, 6.7e-3}},
                          {2.3, {5.3e-3, -0.7e-3, -3.1e-3}},
                          {2.6, {5.3e-3, -0.7e-3, -3.1e-3}, 2},
                          {2.9, {8.3e-3, 2.9e-3, 6.1e-3}, 0},
                          {6, {8.3e-3, 2.9e-3, 6.1e-3}}});
    GrippedSession  rig("haply-emulator", scaled(kWart), path, {.stiffness = 2000, .damping = 5}, 2);
    RecordedSession live, replayed;
    (void)rig.run(4, [&](const TickRecord& record) { live.records.push_back(record); });
    live.columns = replayed.columns = ~std::uint64_t(0);
    std::size_t clutched            = 0;
    for (const TickRecord& record : live.records)
        clutched += (record.actions & static_cast<std::uint32_t>(GovernorAction::clutched)) != 0;
    EXPECT_NEAR(double(clutched), 300, 30) << "the clutch is held for 0.3 s, and the wire is a few ticks late";

    Deformation  deformation(rig.session.object, rig.session.scene);
    ReplayDevice device(live.records, rig.hand.frame.inScene(rig.device->info()));
    (void)runVirtual({rig.session.scene, rig.session.object, deformation.solver(), device, {}}, 4,
                     [&](const TickRecord& record) { replayed.records.push_back(record); });
    const auto difference = compareSessions(live, replayed);
    EXPECT_FALSE(difference.has_value()) << describe(*difference, live, replayed);
}

/// Held in contact the tool stays, the force goes, and afterwards the hand works elsewhere.
TEST(ClutchedSession, TheToolStaysWithoutAForceAndGoesOnFromThere)
{
    const HandPath path({{0, {0, 0, 6e-3}},
                         {2, {0, 0, 6e-3}},
                         {2.3, {0, 0, -2e-3}},
                         {3, {0, 0, -2e-3}, 2},
                         {3.5, {-9e-3, 0, -2e-3}, 2},
                         {4, {-9e-3, 0, -2e-3}, 0},
                         {4.5, {-9e-3, 0, 8e-3}},
                         {9, {-9e-3, 0, 8e-3}}});
    GrippedSession rig("arm", sheetScene(kWart), path, {.stiffness = 2000, .damping = 5}, 2);
    double         felt = 0, moved = 0, left = 0, carried = 0; // [N], [m], [N], [m]
    glm::dvec3     held{}, end{};
    const auto     summary = rig.run(6, [&](const TickRecord& r) {
        Hand hand;
        hand.setBits(r.device);
        EXPECT_EQ(hand.buttons & 2U, 0U) << "the clutch's button means nothing else";
        if (r.time < 3) felt = glm::length(r.force), held = r.hip;
        if (hand.clutched) moved = std::max(moved, glm::distance(r.hip, held));
        if (r.time > 3.02) left = std::max(left, glm::length(r.force));
        if (r.time > 4 && r.time < 4.05) carried = std::max(carried, glm::distance(r.hip, held));
        end = r.hip;
    });
    EXPECT_EQ(summary.fault, GovernorFault::none);
    EXPECT_GT(felt, 0.2);
    EXPECT_LT(moved, 1e-12) << "rounding";
    EXPECT_EQ(left, 0) << "gone after 20 ms, and the hand was never calm off the object for long enough to engage";
    EXPECT_LT(carried, 1e-3) << "no jump";
    EXPECT_GT(end.x, -2e-3) << "the way back to the middle, 9 mm, is no way of the tool";
    EXPECT_GT(end.z, 4e-3) << "the way up afterwards is";
}

TEST(Clutch, HoldsTheToolAndKeepsTheOffset)
{
    Clutch      clutch(4);
    HapticState state;
    state.homed    = true;
    state.fault    = DeviceFault::none;
    state.position = {1, 0, 0};
    EXPECT_EQ(clutch.step(state, false).position, glm::dvec3(1, 0, 0));
    state.buttons   = 5;
    state.position  = {3, 0, 0};
    state.velocity  = {1, 1, 1};
    HapticState out = clutch.step(state, false);
    EXPECT_TRUE(clutch.isHeld());
    EXPECT_EQ(out.position, glm::dvec3(1, 0, 0));
    EXPECT_EQ(out.velocity, glm::dvec3(0)) << "or the governor took the hand's for the tool's";
    EXPECT_EQ(out.buttons, 1U);
    state.buttons  = 1;
    state.position = {4, 0, 0};
    out            = clutch.step(state, false);
    EXPECT_FALSE(clutch.isHeld());
    EXPECT_EQ(out.position, glm::dvec3(2, 0, 0));
    EXPECT_EQ(out.velocity, glm::dvec3(1, 1, 1));
    state.position = {9, 0, 0};
    EXPECT_EQ(clutch.step(state, true).position, glm::dvec3(2, 0, 0)) << "asked for by a key";
    Clutch none;
    state.buttons = ~0U;
    EXPECT_EQ(none.step(state, false).buttons, ~0U);
    EXPECT_FALSE(none.isHeld());
}

TEST(Clutch, HeldFromTheStartTheToolIsWhereTheDeviceIs)
{
    Clutch      clutch(1);
    HapticState state;
    state.buttons  = 1;
    state.position = {1, 2, 3};
    EXPECT_EQ(clutch.step(state, false).position, state.position);
    EXPECT_TRUE(clutch.isHeld());
    state.position = {4, 5, 6};
    EXPECT_EQ(clutch.step(state, false).position, state.position) << "nobody knows yet where the device is";
    state.homed = true;
    state.fault = DeviceFault::none;
    EXPECT_EQ(clutch.step(state, false).position, state.position);
    state.position = {7, 8, 9};
    EXPECT_EQ(clutch.step(state, false).position, glm::dvec3(4, 5, 6));
    state.buttons  = 0;
    state.fault    = DeviceFault::silent;
    state.position = {0, 0, 0};
    EXPECT_EQ(clutch.step(state, false).position, glm::dvec3(4, 5, 6)) << "a place that nobody knows moves no tool";
    EXPECT_FALSE(clutch.isHeld());
    state.fault    = DeviceFault::none;
    state.position = {7.5, 8, 9};
    EXPECT_EQ(clutch.step(state, false).position, glm::dvec3(4.5, 5, 6));
}

/// What a user is told before the hand touches.
TEST(HandNotes, SayTheScaleTheClutchAndWhatIsNotRendered)
{
    Scene scene              = scaled(kWart);
    scene.clutchButton       = 2;
    const SoftObject  object = loadObject(scene).object;
    const SessionHand hand   = openHand({.hand = "haply-emulator"}, scene, object);
    std::string       all;
    for (const std::string& note : hand.notes) all += note + "\n";
    EXPECT_TRUE(holds(all, {"1 mm of the device is 3.00 mm of the scene", "forces are not scaled", "267 N/m",
                            "button 2 is the clutch", "torques and the force of a grip stay zero"}))
        << all;
    EXPECT_EQ(hand.frame.scale, kScale);
    EXPECT_EQ(hand.frame.clutch, 2U);
    EXPECT_TRUE(openHand({.hand = "scan"}, sheetScene(kWart), object).notes.empty()) << "nothing to be said";
}

/// The path of a hand may be as wide as the scaled workspace, and no wider.
TEST(ScaledSession, TheWorkspaceReachesThreeTimesAsFar)
{
    const HandPath path({{0, {0, 0, 0}}, {10, {0.15, 0, 0}}});
    GrippingHand   hand{path, {.stiffness = 300}, deviceFrame({0, 0, 0}, {0, 0, 1})};
    EXPECT_THROW(hand.demandWithin(0.06), Error);
    hand.frame.scale = kScale;
    EXPECT_NO_THROW(hand.demandWithin(0.06));
    EXPECT_NEAR(hand.at(10).target.x, 0.05, 1e-12) << "rounding";
}

} // namespace
} // namespace palp
