#include "engine/tools/gui/touch_faults.h"

#include <cstring>

#include <gtest/gtest.h>

#include "engine/session/servo.h"

namespace palp {
namespace {

TEST(TouchFaults, EveryFaultOfTheGovernorHasAReasonAndARemedy)
{
    for (int n = 1; std::strcmp(name(GovernorFault(n)), "unknown") != 0; ++n) {
        const FaultAdvice advice = adviceOn(GovernorFault(n));
        EXPECT_GT(std::strlen(advice.reason), 0U) << name(GovernorFault(n));
        EXPECT_GT(std::strlen(advice.remedy), 0U) << name(GovernorFault(n));
        for (int other = 1; other < n; ++other)
            EXPECT_STRNE(advice.reason, adviceOn(GovernorFault(other)).reason) << name(GovernorFault(n));
    }
    EXPECT_STREQ(adviceOn(GovernorFault::none).reason, "");
}

TEST(TouchFaults, NotesAreOfTheBitsThatAreSet)
{
    TickRecord record;
    EXPECT_TRUE(notesOn(record).empty());
    record.faults = static_cast<std::uint32_t>(SessionFlag::beyondTheory) |
                    static_cast<std::uint32_t>(SessionFlag::governed) | // shown as the force, not as a fault
                    static_cast<std::uint32_t>(GovernorFault::tooFast);

    ASSERT_EQ(notesOn(record).size(), 1U);
    EXPECT_NE(notesOn(record).front().find("half the thickness"), std::string::npos);
    EXPECT_EQ(governorFault(record), GovernorFault::tooFast);
}

/// A fault has its own badge; every other reason for no force is a note.
TEST(TouchFaults, WhyNoForceFlowsIsANote)
{
    TickRecord record;
    record.actions = static_cast<std::uint32_t>(GovernorAction::outsideBox);
    ASSERT_EQ(notesOn(record).size(), 1U);
    EXPECT_EQ(notesOn(record).front(), "no force: the grip is out of its workspace");
    record.device = static_cast<std::uint32_t>(DeviceFault::ownWatchdog);
    ASSERT_EQ(notesOn(record, "a motor stalls").size(), 1U);
    EXPECT_EQ(notesOn(record, "a motor stalls").front(), "no force: the device reports own-watchdog (a motor stalls)");
    record.device  = 0;
    record.actions = static_cast<std::uint32_t>(GovernorAction::waiting);
    EXPECT_EQ(notesOn(record).size(), 1U);
    record.faults = static_cast<std::uint32_t>(SessionFlag::oldTable);
    EXPECT_EQ(notesOn(record).size(), 1U) << "said once";
}

} // namespace
} // namespace palp
