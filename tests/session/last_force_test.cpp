#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include <glm/geometric.hpp>

#include "engine/session/real_session.h"
#include "engine/session/scripted_hand.h"
#include "tests/session/sheet_session.h"

// However a session ends, the last that its device hears is zero force.

namespace palp {
namespace {

/// A scripted hand that keeps what it is given.
class Listening : public ScriptedHand {
public:
    using ScriptedHand::ScriptedHand;

    void render(const GovernedForce& force) noexcept override
    {
        last = glm::length(force.newtons());
        if (last > 0) ++pushed;
    }

    double last   = 0; ///< [N]
    int    pushed = 0; ///< ticks with a force
};

constexpr double kPushes = 0.2; // [N] well below what the sheet answers in the end

class LastForce : public ::testing::Test {
protected:
    /// Presses at once and stays: a session that ends here ends under force.
    LastForce()
        : session_(sheetScene(kWart)), rests_({{0, {0, 0, 2e-3}}, {0.05, {0, 0, -1.5e-3}}, {20, {0, 0, -1.5e-3}}}),
          deformation_(session_.object, session_.scene), device_(rests_), solver_(deformation_.solver())
    {
    }

    SessionParts parts() { return {session_.scene, session_.object, solver_, device_, {}}; }

    void real(RealSessionSettings settings)
    {
        std::string warning;
        settings.viewPeriod = 0.01;
        runReal(parts(), settings, warning);
    }

    /// A session that waits for the force ends under it however busy the machine is.
    OnTick notesForce()
    {
        return [this](const TickRecord& s) {
            if (glm::length(s.force) > kPushes) pushing_ = true;
        };
    }

    void expectZeroAfterAForce() const
    {
        EXPECT_GT(device_.pushed, 0) << "otherwise this shows nothing";
        EXPECT_EQ(device_.last, 0);
    }

    SheetSession      session_;
    HandPath          rests_;
    Deformation       deformation_;
    Listening         device_;
    PatchSolver       solver_;
    std::atomic<bool> pushing_ = false, stop_ = false;
};

TEST_F(LastForce, IsZeroAtTheEndOfAVirtualSession)
{
    runVirtual(parts(), 1.5, {});
    expectZeroAfterAForce();
}

TEST_F(LastForce, IsZeroWhenAVirtualSessionIsStopped)
{
    runVirtual(
        parts(), 1000, [this](const TickRecord& s) { stop_ = glm::length(s.force) > kPushes; }, &stop_);
    expectZeroAfterAForce();
}

TEST_F(LastForce, IsZeroWhenTheSolverOfAVirtualSessionThrows)
{
    const PatchSolver solves = solver_;
    solver_                  = [&](const Touch& touch, double lead) {
        if (device_.pushed > 100) throw std::runtime_error("lost");
        return solves(touch, lead);
    };
    EXPECT_THROW(runVirtual(parts(), 1000, {}), std::runtime_error);
    expectZeroAfterAForce();
}

TEST_F(LastForce, IsZeroAtTheEndOfARealSession)
{
    real({.seconds = 2.5});
    expectZeroAfterAForce();
}

TEST_F(LastForce, IsZeroWhenARealSessionIsStopped)
{
    RealSessionSettings settings{.seconds = 30, .onTick = notesForce()};
    settings.stop   = &stop_;
    settings.onView = [this](const SessionView&) { stop_ = pushing_.load(); };
    const auto began = std::chrono::steady_clock::now();
    real(settings);
    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(30)) << "or it was not stopped";
    expectZeroAfterAForce();
}

TEST_F(LastForce, IsZeroWhenWhoLooksOnThrows)
{
    RealSessionSettings settings{.seconds = 30, .onTick = notesForce()};
    settings.onView = [this](const SessionView&) {
        if (pushing_) throw std::runtime_error("seen enough");
    };
    EXPECT_THROW(real(settings), std::runtime_error);
    expectZeroAfterAForce();
}

TEST_F(LastForce, IsZeroWhenWhoTakesRecordsThrows)
{
    const RealSessionSettings settings{.seconds = 1000, .onTick = [](const TickRecord& s) {
                                           if (glm::length(s.force) > kPushes) throw std::runtime_error("no");
                                       }};
    EXPECT_THROW(real(settings), std::runtime_error);
    expectZeroAfterAForce();
}

} // namespace
} // namespace palp
