// Tests of what is told about forces: the reason in words, and the device's light.
#include "engine/session/force_state.h"

#include <gtest/gtest.h>

#include <vector>

#include "engine/session/gripped_falcon.h"
#include "engine/session/servo.h"
#include "engine/session/session_summary.h"
#include "tests/session/sheet_session.h"

namespace palp {
namespace {

std::uint32_t bit(GovernorAction action)
{
    return static_cast<std::uint32_t>(action);
}

struct Told {
    ForceState    state;
    std::uint32_t actions;
    std::uint32_t faults;
    DeviceFault   device;
    const char*   words;
    DeviceLight   light;
};

/// Each state with those that are less grave below it: the gravest is told.
TEST(ForceState, TheGravestReasonIsTold)
{
    using enum ForceState;
    using enum DeviceLight;
    const auto              tooFast = static_cast<std::uint32_t>(GovernorFault::tooFast);
    const auto              old     = static_cast<std::uint32_t>(SessionFlag::oldTable);
    std::uint32_t           did     = bit(GovernorAction::clamped) | bit(GovernorAction::slewed);
    const std::vector<Told> all{
        {flows, did, 0, DeviceFault::none, "", green},
        {comesOn, did |= bit(GovernorAction::engaging), 0, DeviceFault::none, "the force comes on", green},
        {waits, did |= bit(GovernorAction::waiting), 0, DeviceFault::none, "hold it still", blue},
        {plateSilent, did, old, DeviceFault::none, "the plate does not answer", blue},
        {outOfBox, did |= bit(GovernorAction::outsideBox), old, DeviceFault::none, "out of its workspace", blue},
        {clutched, did |= bit(GovernorAction::clutched), old, DeviceFault::none, "the clutch is held", blue},
        {notHomed, did |= bit(GovernorAction::notHomed), old, DeviceFault::none, "home the device", red},
        {programStops, did |= bit(GovernorAction::lettingGo), old, DeviceFault::none, "the program stops", blue},
        {deviceFaulty, did, old, DeviceFault::silent, "reports silent", blue},
        {stopped, did, old | tooFast, DeviceFault::silent, "too-fast; hold down the device's first button", blue},
        {deviceLost, did, old | tooFast, DeviceFault::linkLost,
         "lost: link-lost (the link to it broke), the session ends", blue}};
    for (const Told& told : all) {
        TickRecord record;
        record.actions = told.actions;
        record.faults  = told.faults;
        record.device  = static_cast<std::uint32_t>(told.device);
        EXPECT_EQ(forceState(record), told.state) << name(told.state);
        EXPECT_EQ(lightOf(forceState(record)), told.light) << name(told.state);
        const std::string words = describeForces(record);
        EXPECT_NE(words.find(told.words), std::string::npos) << words;
        EXPECT_EQ(words.empty(), told.state == flows) << words;
    }
    EXPECT_EQ(all.size(), namesOf(ForceState{}).size()) << "every state is here";
}

/// The live line says what the summary does: the fault, and what the driver knows about it; else what it means.
TEST(ForceState, AFaultIsSaidInTheDriversWordsAndElseByWhatItMeans)
{
    TickRecord record;
    for (const auto& fault : namesOf(DeviceFault{})) {
        record.device = static_cast<std::uint32_t>(fault.value);
        EXPECT_EQ(meaningOf(fault.value).empty(), fault.value == DeviceFault::none) << fault.name;
        if (fault.value == DeviceFault::none) continue;
        EXPECT_NE(describeForces(record).find(meaningOf(fault.value)), std::string::npos) << fault.name;
    }
    record.device = static_cast<std::uint32_t>(DeviceFault::ownWatchdog);
    EXPECT_EQ(describeForces(record, "a motor of the Haply stalls"),
              "no force: the device reports own-watchdog (a motor of the Haply stalls)");
    EXPECT_EQ(describeForces(record), "no force: the device reports own-watchdog (it stopped by itself)");
}

TEST(ForceState, ASummaryNamesTheFaultThatEndedTheSession)
{
    SessionSummary summary;
    TickRecord     record;
    for (const DeviceFault fault : {DeviceFault::garbled, DeviceFault::silent, DeviceFault::linkLost}) {
        record.device = static_cast<std::uint32_t>(fault);
        summary.add(record);
    }
    EXPECT_EQ(summary.deviceFault, DeviceFault::linkLost) << "not the first";
}

TEST(ForceState, ASummarySaysWhyThereWasNoForce)
{
    TickRecord pressing;
    pressing.normal  = {0, 0, 1};
    pressing.hip     = {0, 0, -1e-3};
    pressing.faults  = static_cast<std::uint32_t>(SessionFlag::governed);
    pressing.actions = bit(GovernorAction::outsideBox);
    SessionSummary summary;
    summary.add(pressing);
    EXPECT_EQ(summary.whyForceless(), "the grip was out of the device's workspace");
    pressing.actions = bit(GovernorAction::notHomed);
    summary.add(pressing);
    EXPECT_EQ(summary.whyForceless(), "the device was not homed");
    pressing.device = static_cast<std::uint32_t>(DeviceFault::silent);
    summary.add(pressing);
    EXPECT_EQ(summary.whyForceless(), "the device reported silent");
}

TEST(ForceState, ASummaryTellsForcesThatCameOnFromWholeOnes)
{
    TickRecord pressing;
    pressing.normal  = {0, 0, 1};
    pressing.hip     = {0, 0, -1e-3};
    pressing.force   = {0, 0, 0.3};
    pressing.actions = bit(GovernorAction::engaging);
    SessionSummary summary;
    summary.add(pressing);
    EXPECT_EQ(summary.comingOn, 1U);
    EXPECT_EQ(summary.mostForce, 0.3);
    EXPECT_EQ(summary.mostWholeForce, 0) << "none was whole";
    pressing.actions = 0;
    pressing.force   = {0, 0, 0.2};
    summary.add(pressing);
    TickRecord away; // before the surface forces may come on as they like
    away.actions = bit(GovernorAction::engaging);
    summary.add(away);
    EXPECT_EQ(summary.comingOn, 1U);
    EXPECT_EQ(summary.mostForce, 0.3);
    EXPECT_EQ(summary.mostWholeForce, 0.2);
}

/// Down to the wire of an emulated Falcon: blue while the governor waits, green once forces may flow, blue after
/// the end.
TEST(ForceState, TheLightOfAFalconFollowsTheGovernor)
{
    const SheetSession session(sheetScene(kWart));
    const HandPath     path({{0, {0, 0, 6e-3}}, {2, {0, 0, 6e-3}}});
    const GrippingHand hand{path, {.stiffness = 4000, .damping = 20}, deviceFrame({0, 0, 6e-3}, {0, 0, 1})};
    auto falcon = std::make_unique<GrippedFalcon>(GrippingHand{path, hand.grip, hand.frame}, GrippedFalcon::ready(),
                                                  FalconDeviceSettings{});
    falcon->open();
    Deformation deformation(session.object, session.scene);
    int         blue = 0, green = 0, wrong = 0;
    const auto  light    = [&] { return falcon->emulator().falcon().command().lights; };
    DeviceLight expected = DeviceLight::blue;
    static_cast<void>(runVirtual({session.scene, session.object, deformation.solver(), *falcon, hand.frame}, 2,
                                 [&](const TickRecord& record) {
                                     // The packet on the wire is that of the tick before.
                                     wrong += light() != std::uint8_t(expected);
                                     expected = lightOf(forceState(record));
                                     ++(expected == DeviceLight::green ? green : blue);
                                 }));
    EXPECT_LE(wrong, 1) << "the first packet";
    EXPECT_GT(green, 1900);
    EXPECT_GE(blue, 10) << "calm ticks";
    EXPECT_EQ(light(), std::uint8_t(DeviceLight::blue)) << "the session is over";
}

} // namespace
} // namespace palp
