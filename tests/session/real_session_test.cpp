#include "engine/session/real_session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/session/scripted_hand.h"
#include "tests/session/sheet_session.h"
#include "tests/support/allocations.h"
#include "tests/support/locks.h"
#include "tests/support/sanitized.h"

namespace palp {
namespace {

/// The machine of a test has other things to do: only what must hold on any is asked.
class RealSessions : public ::testing::TestWithParam<SessionThreads> {
protected:
    SessionSummary run(const SheetSession& session, const PatchSolver& solver, const RealSessionSettings& settings)
    {
        ScriptedHand device(session.hand);
        return runReal({session.scene, session.object, solver, device, {}}, settings, warning_);
    }
    std::string warning_; ///< of run()
};

INSTANTIATE_TEST_SUITE_P(Both, RealSessions, ::testing::Values(SessionThreads::servo, SessionThreads::paper),
                         [](const auto& param) { return std::string(name(param.param)); });

TEST_P(RealSessions, TheThreadsServeAHandAndEnd)
{
    const SheetSession  session(sheetScene(kWart));
    Deformation         deformation(session.object, session.scene);
    std::uint64_t       seen = 0, patches = 0;
    RealSessionSettings settings;
    bool                finite = true, afterTheStart = true;
    settings.threads    = GetParam();
    settings.seconds    = 0.6;
    settings.viewPeriod = 0.02;
    std::optional<std::chrono::steady_clock::time_point> start;
    settings.onStart = [&](std::chrono::steady_clock::time_point at) {
        EXPECT_FALSE(start) << "once";
        EXPECT_EQ(seen, 0U);
        start = at;
    };
    settings.onTick = [&](const TickRecord& s) {
        ++seen;
        const std::chrono::duration<double> since = std::chrono::steady_clock::now() - *start;
        afterTheStart = afterTheStart && since.count() >= s.time && since.count() < s.time + 0.5; // a busy machine
        finite        = finite && std::isfinite(glm::length(s.force));
    };
    std::string warned = "nothing was seen";
    settings.onView    = [&](const SessionView& view) {
        warned = view.warning;
        if (!view.patch) return;
        ++patches;
        EXPECT_EQ(view.patch->points.size(), view.patch->pointResponse.size()) << "whole, while the next one is made";
        EXPECT_GT(view.patch->compliance, 0);
        EXPECT_GT(view.solveTime, 0);
    };
    const SessionSummary summary = run(session, deformation.solver(), settings);
    EXPECT_EQ(warned, warning_) << "of real-time rights; empty where they are given";
    EXPECT_EQ(summary.ticks, seen);
    EXPECT_GT(summary.ticks, 20U);
    EXPECT_LE(summary.ticks, 601U);
    EXPECT_TRUE(finite);
    EXPECT_TRUE(afterTheStart) << "a tick's time is that since the start";
    EXPECT_GT(summary.patches, 0U);
    EXPECT_GT(patches, 0U);
    EXPECT_EQ(summary.failedPatches, 0U) << summary.why;
}

TEST_P(RealSessions, StartAndStopAThousandTimes)
{
    const SheetSession  session(sheetScene(kWart));
    Deformation         deformation(session.object, session.scene);
    RealSessionSettings settings;
    settings.threads    = GetParam();
    std::uint64_t ticks = 0, seen = 0;
    settings.onTick      = [&](const TickRecord&) { ++seen; };
    constexpr int kTimes = kSanitized ? 250 : 1000;
    for (int n = 0; n < kTimes; ++n) {
        settings.seconds             = n % 2 ? 1e-3 : 3e-3;
        const SessionSummary summary = run(session, deformation.solver(), settings);
        ASSERT_LE(summary.ticks, 4U) << n << ": a first tick that came late has the next ones follow sooner";
        ASSERT_EQ(summary.fault, GovernorFault::none) << n;
        ticks += summary.ticks;
    }
    EXPECT_EQ(ticks, seen);
    EXPECT_GT(ticks, kTimes / 2U) << "some sessions of 1 ms may see no tick on a busy machine, of 3 ms hardly one";
}

TEST_P(RealSessions, AnInterruptEndsIt)
{
    const SheetSession  session(sheetScene(kWart));
    Deformation         deformation(session.object, session.scene);
    std::atomic<bool>   stop = false;
    RealSessionSettings settings;
    settings.threads    = GetParam();
    settings.seconds    = 3600;
    settings.stop       = &stop;
    settings.viewPeriod = 0.01;
    settings.onView     = [&](const SessionView& view) { stop = view.record.time > 0.05; };
    EXPECT_LT(run(session, deformation.solver(), settings).ticks, 3600000U);
}

TEST_P(RealSessions, WhoLooksOnMayThrow)
{
    const SheetSession  session(sheetScene(kWart));
    Deformation         deformation(session.object, session.scene);
    RealSessionSettings settings;
    settings.threads    = GetParam();
    settings.seconds    = 3600;
    settings.viewPeriod = 0.01;
    settings.onView     = [](const SessionView&) { throw std::runtime_error("seen enough"); };
    EXPECT_THROW(run(session, deformation.solver(), settings), std::runtime_error);
}

TEST_P(RealSessions, ADeformationThatThrowsFailsAPatchAndTheTouchGoesOn)
{
    const SheetSession  session(sheetScene(kWart), HandMotion::press);
    Deformation         deformation(session.object, session.scene);
    RealSessionSettings settings;
    settings.threads   = GetParam();
    settings.seconds   = 0.6;
    int        count   = 0;
    const auto summary = run(
        session,
        [&](const Touch& touch, double lead) {
            if (++count % 2 == 1) throw std::runtime_error("lost");
            return deformation.solve(touch, lead);
        },
        settings);
    EXPECT_GT(summary.failedPatches, 0U);
    EXPECT_GT(summary.patches, 0U) << "it goes on";
    EXPECT_EQ(summary.why, "lost");
}

TEST_P(RealSessions, WhoTakesRecordsMustNotThrowAndEndsTheSessionIfItDoes)
{
    const SheetSession  session(sheetScene(kWart));
    Deformation         deformation(session.object, session.scene);
    RealSessionSettings settings;
    settings.threads = GetParam();
    settings.seconds = 3600;
    settings.onTick  = [](const TickRecord&) { throw std::runtime_error("no"); };
    EXPECT_THROW(run(session, deformation.solver(), settings), std::runtime_error);
}

/// Two seconds without a word from the deformation. A machine that holds the servo up for a tenth of a second makes the
/// governor stop the force, as it should; then all of it is repeated, twice at most: a servo that waits for the
/// deformation does so each time.
TEST_P(RealSessions, AStalledDeformationLosesItsForceAndGetsItBackOnceTheHandWasLifted)
{
    for (int attempt = 0;; ++attempt) {
        const SheetSession  session(sheetScene(kWart));
        const HandPath      rests({{0, {0, 0, 2e-3}},
                                   {0.1, {0, 0, -1.5e-3}},
                                   {4.6, {0, 0, -1.5e-3}},
                                   {4.7, {0, 0, 2e-3}},
                                   {4.8, {0, 0, 2e-3}},
                                   {4.9, {0, 0, -1.5e-3}},
                                   {20, {0, 0, -1.5e-3}}});
        ScriptedHand        device(rests);
        Deformation         deformation(session.object, session.scene);
        RealSessionSettings settings;
        std::atomic<double> stalled = HUGE_VAL; // [s] after the start
        const auto          start   = std::chrono::steady_clock::now();
        const auto          since   = [start] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        };
        const PatchSolver stalls = [&](const Touch& touch, double lead) {
            if (since() > 2 && stalled == HUGE_VAL) {
                stalled = since();
                std::this_thread::sleep_for(std::chrono::seconds(2));
            }
            return deformation.solve(touch, lead);
        };
        constexpr double kBusy  = 0.15; // [s] by which the servo and its table may be late on a busy machine
        bool             finite = true, flagged = false;
        double           before = 0, without = 0, again = 0; // [N] most before, while it is dead, when it is back
        settings.threads = GetParam();
        settings.seconds = 7;
        settings.onTick  = [&](const TickRecord& s) {
            const double force = glm::length(s.force);
            finite             = finite && std::isfinite(force);
            flagged            = flagged || (s.faults & static_cast<std::uint32_t>(SessionFlag::oldTable)) != 0;
            if (s.time < 2) before = std::max(before, force);
            const double dead = since() - stalled;
            if (dead > 0.25 + 0.02 + kBusy && dead < 1.9) without = std::max(without, force);
            if (s.time > 6.7) again = std::max(again, force);
        };
        std::string          warning;
        const SessionSummary summary = runReal({session.scene, session.object, stalls, device, {}}, settings, warning);
        if (summary.fault == GovernorFault::loopStalled && attempt < 2) continue;
        EXPECT_TRUE(finite);
        EXPECT_TRUE(flagged);
        EXPECT_GT(before, 0.3) << "the hand feels the sheet [N]";
        EXPECT_EQ(without, 0);
        EXPECT_GT(again, 0.3);
        EXPECT_GT(summary.oldTable, 1000U);
        EXPECT_EQ(summary.fault, GovernorFault::none);
        return;
    }
}

TEST_P(RealSessions, AForceLeavesInTheTickThatComputesIt)
{
    class Listening : public ScriptedHand {
    public:
        using ScriptedHand::ScriptedHand;
        void   render(const GovernedForce& force) noexcept override { newest = glm::length(force.newtons()); }
        double newest = 0; // [N]
    };
    const SheetSession  session(sheetScene(kWart), HandMotion::press);
    Listening           device(session.hand);
    Deformation         deformation(session.object, session.scene);
    RealSessionSettings settings;
    settings.threads = GetParam();
    settings.seconds = 2;
    double most = 0, apart = 0;
    settings.onTick = [&](const TickRecord& s) {
        apart = std::max(apart, std::abs(device.newest - glm::length(s.force)));
        most  = std::max(most, device.newest);
    };
    std::string warning;
    runReal({session.scene, session.object, deformation.solver(), device, {}}, settings, warning);
    EXPECT_EQ(apart, 0);
    EXPECT_GT(most, 0.01) << "or it says nothing";
}

TEST(Servo, TheCountersCount)
{
    std::mutex mutex;
    const auto locks = locksOfThisThread(), allocations = allocationsOfThisThread();
    {
        const std::lock_guard lock(mutex);
        ::operator delete(::operator new(1)); // not an expression with new: compilers leave out pairs of those
    }
    EXPECT_EQ(locksOfThisThread() - locks, locksAreCounted() ? 1U : 0U);
    EXPECT_EQ(allocationsOfThisThread() - allocations, 1U);
}

/// In a session with its threads: what the servo's thread allocates and locks from its first tick to its last.
TEST_P(RealSessions, TheServoAllocatesAndLocksNothing)
{
    const SheetSession  session(sheetScene(kWart));
    Deformation         deformation(session.object, session.scene);
    RealSessionSettings settings;
    std::size_t         locks = 0, allocations = 0, ticks = 0, firstLocks = 0, firstAllocations = 0;
    settings.threads = GetParam();
    settings.seconds = 1;
    settings.onTick  = [&](const TickRecord&) {
        if (++ticks == 2) { // Embree prepares something per thread in the first query
            firstLocks       = locksOfThisThread();
            firstAllocations = allocationsOfThisThread();
        }
        locks       = locksOfThisThread() - firstLocks;
        allocations = allocationsOfThisThread() - firstAllocations;
    };
    EXPECT_GT(run(session, deformation.solver(), settings).contactTicks, 0U);
    EXPECT_GT(ticks, 20U);
    EXPECT_EQ(locks, 0U);
    EXPECT_EQ(allocations, 0U);
}

} // namespace
} // namespace palp
