#include "engine/session/real_session.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <glm/geometric.hpp>

#include "engine/session/hand_device.h"
#include "tests/session/allocations.h"
#include "tests/session/locks.h"
#include "tests/session/sheet_session.h"

namespace palp {
namespace {

/// The machine of a test has other things to do: only what must hold on any is asked.
class RealSessions : public ::testing::TestWithParam<SessionThreads> {
protected:
    SessionSummary run(const SheetSession& session, const PatchSolver& solver, const RealSessionSettings& settings)
    {
        HandDevice  device(session.hand);
        std::string warning;
        return runReal({session.scene, session.cloud.cloud, session.index, solver, device, {}}, settings, warning);
    }
};

INSTANTIATE_TEST_SUITE_P(Both, RealSessions, ::testing::Values(SessionThreads::servo, SessionThreads::paper),
                         [](const auto& param) { return std::string(name(param.param)); });

TEST_P(RealSessions, TheThreadsServeAHandAndEnd)
{
    const SheetSession  session(sheetScene(kWart));
    Deformation         deformation(session.cloud.cloud, session.index, session.scene);
    std::uint64_t       seen = 0, patches = 0;
    RealSessionSettings settings;
    bool                finite = true;
    settings.threads           = GetParam();
    settings.seconds           = 0.6;
    settings.viewPeriod        = 0.02;
    settings.onSample          = [&](const SessionSample& s) {
        ++seen;
        finite = finite && std::isfinite(glm::length(s.force));
    };
    settings.onView = [&](const SessionView& view) {
        if (!view.patch) return;
        ++patches;
        EXPECT_EQ(view.patch->points.size(), view.patch->pointResponse.size()) << "whole, while the next one is made";
        EXPECT_GT(view.patch->compliance, 0);
        EXPECT_GT(view.solveTime, 0);
    };
    const SessionSummary summary = run(session, deformation.solver(), settings);
    EXPECT_EQ(summary.ticks, seen);
    EXPECT_GT(summary.ticks, 20U);
    EXPECT_LE(summary.ticks, 601U);
    EXPECT_TRUE(finite);
    EXPECT_GT(summary.patches, 0U);
    EXPECT_GT(patches, 0U);
    EXPECT_EQ(summary.failedPatches, 0U) << summary.why;
}

TEST_P(RealSessions, StartAndStopAThousandTimes)
{
    const SheetSession  session(sheetScene(kWart));
    Deformation         deformation(session.cloud.cloud, session.index, session.scene);
    RealSessionSettings settings;
    settings.threads    = GetParam();
    std::uint64_t ticks = 0;
    for (int n = 0; n < 500; ++n) { // of either kind
        settings.seconds = n % 2 ? 1e-3 : 3e-3;
        ticks += run(session, deformation.solver(), settings).ticks;
    }
    EXPECT_GT(ticks, 0U);
}

TEST_P(RealSessions, AnInterruptEndsIt)
{
    const SheetSession  session(sheetScene(kWart));
    Deformation         deformation(session.cloud.cloud, session.index, session.scene);
    std::atomic<bool>   stop = false;
    RealSessionSettings settings;
    settings.threads    = GetParam();
    settings.seconds    = 3600;
    settings.stop       = &stop;
    settings.viewPeriod = 0.01;
    settings.onView     = [&](const SessionView& view) { stop = view.sample.time > 0.05; };
    EXPECT_LT(run(session, deformation.solver(), settings).ticks, 3600000U);
}

TEST_P(RealSessions, WhoLooksOnMayThrow)
{
    const SheetSession  session(sheetScene(kWart));
    Deformation         deformation(session.cloud.cloud, session.index, session.scene);
    RealSessionSettings settings;
    settings.threads    = GetParam();
    settings.seconds    = 3600;
    settings.viewPeriod = 0.01;
    settings.onView     = [](const SessionView&) { throw std::runtime_error("seen enough"); };
    EXPECT_THROW(run(session, deformation.solver(), settings), std::runtime_error);
}

TEST_P(RealSessions, ADeformationThatThrowsLeavesTheTouchGoingOnAndIsReportedInTheEnd)
{
    const SheetSession  session(sheetScene(kWart), HandMotion::press);
    RealSessionSettings settings;
    std::uint64_t       ticks = 0;
    settings.threads          = GetParam();
    settings.seconds          = 0.4;
    settings.onSample         = [&](const SessionSample&) { ++ticks; };
    EXPECT_THROW(
        run(
            session, [](const Touch&, double) -> DeformationAnswer { throw std::runtime_error("lost"); }, settings),
        std::runtime_error);
    EXPECT_GT(ticks, 20U);
}

/// Five seconds without a word from the deformation.
TEST_P(RealSessions, AStalledDeformationLeavesAFiniteSmoothForceAndAFlag)
{
    const SheetSession  session(sheetScene(kWart), HandMotion::press, 10);
    Deformation         deformation(session.cloud.cloud, session.index, session.scene);
    RealSessionSettings settings;
    int                 solved = 0;
    const PatchSolver   stalls = [&](const Touch& touch, double period) {
        if (++solved == 3) std::this_thread::sleep_for(std::chrono::seconds(5));
        return deformation.solve(touch, period);
    };
    bool       finite = true, flagged = false;
    double     step = 0, most = 0, oldest = 0; // [N], [N], [s]
    glm::dvec3 last{};
    settings.threads  = GetParam();
    settings.seconds  = 5.5;
    settings.onSample = [&](const SessionSample& s) {
        finite  = finite && std::isfinite(glm::length(s.force));
        flagged = flagged || (s.faults & static_cast<std::uint32_t>(SessionFlag::stalePatch)) != 0;
        step    = std::max(step, glm::length(s.force - last));
        most    = std::max(most, glm::length(s.force));
        oldest  = std::max(oldest, s.patchAge);
        last    = s.force;
    };
    const SessionSummary summary = run(session, stalls, settings);
    EXPECT_TRUE(finite);
    EXPECT_TRUE(flagged);
    EXPECT_GT(oldest, 1.0) << "the stall was felt by the servo";
    EXPECT_GT(most, 0.1) << "the hand goes on feeling the sheet";
    EXPECT_LE(step, 4.0) << "1 N a tick; a late tick counts as 4 ms at most: GovernorSettings::longestTick";
    EXPECT_EQ(summary.fault, GovernorFault::none);
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
    Deformation         deformation(session.cloud.cloud, session.index, session.scene);
    RealSessionSettings settings;
    std::size_t         locks = 0, allocations = 0, ticks = 0, firstLocks = 0, firstAllocations = 0;
    settings.threads  = GetParam();
    settings.seconds  = 1;
    settings.onSample = [&](const SessionSample&) {
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
