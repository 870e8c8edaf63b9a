// The driver of Haply's devices over real sockets: its thread, and the guardian when the program comes to grief.
#include <gtest/gtest.h>

#include <csignal>
#include <mutex>
#include <random>

#include "device/haply/haply_record.h"
#include "engine/core/real_time.h"
#include "tests/device/governed.h"
#include "tests/device/guardian_of.h"
#include "tests/device/haply_server.h"
#include "tests/device/zero_in_time.h"
#include "tests/support/allocations.h"
#include "tests/support/locks.h"

namespace palp {
namespace {

constexpr double kBusy = 50e-3; // [s] that a thread may have to wait for a processor, as it outranks nobody here
constexpr double kHold = 1e6;   // [s] a service that renders a force for ever: what acts is on this side

/// A service on a thread of its own.
class HaplySockets : public testing::Test {
protected:
    HaplySockets()
        : thread_([this](const std::stop_token& stop) {
              while (!stop.stop_requested()) {
                  {
                      const std::lock_guard lock(mutex_);
                      server_.serve(steadyTime() + 0.3e-3);
                  }
                  std::this_thread::sleep_for(std::chrono::microseconds(100)); // so that the test gets the lock
              }
          })
    {
    }
    /// Looks at the service while it rests.
    template <class Look>
    auto with(const Look& look)
    {
        const std::lock_guard lock(mutex_);
        return look(server_.service);
    }
    glm::dvec3 force()
    {
        return with([](const EmulatedHaply& service) { return service.force(); });
    }
    /// Ticks until it is so; false after 10 s, for a busy machine. There a late tick lowers the force, so that tests
    /// wait for a third of it.
    template <class So>
    bool until(LineDevice& device, const GovernedForce& push, const So& so)
    {
        for (const double end = steadyTime() + 10; steadyTime() < end;) {
            state = device.exchange(push, steadyTime());
            if (so()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return false;
    }

    HaplyServer  server_{{.hold = kHold}};
    HapticState  state;
    std::mutex   mutex_;
    std::jthread thread_;
};

TEST_F(HaplySockets, AThreadConversesAndClosingLeavesZeroForce)
{
    const auto device = makeHaply(server_.opener(), {}, {.asksForRealTime = false});
    device->open();
    const GovernedForce push = governed({1, 0, 0});
    EXPECT_TRUE(until(*device, push,
                      [&] { return state.fault == DeviceFault::none && force().x > 0.3 && state.sequence > 10; }));
    EXPECT_LE(state.age, kBusy);
    device->close();
    for (const double end = steadyTime() + 5; force().x != 0 && steadyTime() < end;)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(force(), glm::dvec3(0));
}

TEST_F(HaplySockets, AnExchangeOfTheServoNeitherLocksNorAllocates)
{
    const auto device = makeHaply(server_.opener(), {}, {.asksForRealTime = false});
    device->open();
    const GovernedForce push  = governed({1, 0, 0});
    const std::size_t   locks = locksOfThisThread(), allocations = allocationsOfThisThread();
    for (int n = 0; n < 100000; ++n) device->exchange(push, n * 1e-3);
    EXPECT_EQ(locksOfThisThread(), locks);
    EXPECT_EQ(allocationsOfThisThread(), allocations);
    static_cast<void>(force());
    EXPECT_EQ(locksOfThisThread() > locks, locksAreCounted()) << "a lock would show";
}

TEST_F(HaplySockets, TheForceFallsByItselfWhenNobodyCalls)
{
    const auto device = makeHaply(server_.opener(), {}, {.asksForRealTime = false});
    device->open();
    ASSERT_TRUE(until(*device, governed({1, 0, 0}), [&] { return force().x > 0.3; }));
    const double left = steadyTime();
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_EQ(force(), glm::dvec3(0));
    EXPECT_LE(with([](const EmulatedHaply& service) { return service.lastForce(); }), left + 30e-3 + kBusy);
    state = device->exchange(governed({1, 0, 0}), steadyTime());
    EXPECT_EQ(state.fault, DeviceFault::hostTooSlow);
}

TEST_F(HaplySockets, AServiceThatEndsIsALostLinkInWords)
{
    const auto device = makeHaply(server_.opener(), {}, {.asksForRealTime = false});
    device->open();
    ASSERT_TRUE(until(*device, {}, [&] { return state.fault == DeviceFault::none && state.sequence > 5; }));
    with([](EmulatedHaply& service) { return service.cause(HaplyTrouble::cut), 0; });
    EXPECT_TRUE(until(*device, {}, [&] { return state.fault == DeviceFault::linkLost; }));
    EXPECT_NE(std::string(device->faultWords()).find("still running?"), std::string::npos);
}

TEST(HaplyConnections, APortAtWhichNobodyListensIsSaidAtOnce)
{
    HaplyOpener nobody;
    {
        const HaplyServer server;
        nobody = server.opener();
    }
    const double began  = steadyTime();
    const auto   device = makeHaply(nobody, {}, {.asksForRealTime = false});
    EXPECT_THROW(device->open(), Error);
    EXPECT_LT(steadyTime() - began, 1);
}

/// A child process drives the service, which this process serves.
class HaplyGuardian : public testing::Test {
protected:
    static constexpr int    kInstants = 40;
    static constexpr double kZeroBy   = 30e-3; // [s] 25 ms of silence, a packet, and what the guardian may have to wait

    HaplyGuardian() { static_cast<void>(askForRealTime()); } // whoever measures must not be late
    ~HaplyGuardian() override { end(); }

    void start()
    {
        child_ = fork();
        if (child_ != 0) return;
        prctl(PR_SET_PDEATHSIG, SIGKILL); // a test that is ended leaves nothing behind
        try {
            const auto device = makeHaply(server.opener(), {}, {});
            device->open();
            for (Metronome metronome{std::chrono::milliseconds(1)};;) {
                metronome.wait();
                if (device->exchange(push_, steadyTime()).fault == DeviceFault::silenced) *silenced_ = true;
            }
        } catch (const std::exception& error) {
            std::fprintf(stderr, "child: %s\n", error.what());
        }
        _exit(3);
    }
    void end()
    {
        if (child_ <= 0) return;
        kill(child_, SIGKILL);
        waitpid(std::exchange(child_, -1), nullptr, 0);
    }
    [[nodiscard]] bool pushes() const { return server.service.force() != glm::dvec3(0); }

    bool waitForForce()
    {
        for (const double end = steadyTime() + 10; steadyTime() < end;) { // a busy machine makes the driver let go
            server.serve(end, [&] { return glm::length(server.service.force()) > 1.7; });
            server.serve(steadyTime() + wait_(random_));
            if (pushes()) return true;
        }
        return false;
    }
    /// Returns how long the service pushed from `failed` on [s], less what a busy machine kept this process from its
    /// processor.
    double zeroAfter(double failed)
    {
        double late = 0;
        for (double last = steadyTime(); pushes() && last < failed + 0.2;) {
            server.serve(last + 200e-6, [&] { return !pushes(); });
            const double now = steadyTime();
            late             = std::max(late, now - last - 1e-3);
            last             = now;
        }
        const double took = pushes() ? 1 : server.service.lastForce() - failed;
        most_             = std::max(most_, took);
        return took - std::max(0.0, late);
    }

    HaplyServer                            server{{.hold = kHold}};
    const GovernedForce                    push_ = governed({1, 1, 1});
    SharedMemory<std::atomic<bool>>        silenced_;
    pid_t                                  child_ = -1;
    ZeroInTime                             inTime_{kZeroBy};
    double                                 most_ = 0; // [s]
    std::mt19937                           random_{1};
    std::uniform_real_distribution<double> wait_{0, 5e-3}; // [s]
};

TEST_F(HaplyGuardian, AProgramThatIsKilledLeavesZeroForce)
{
    for (int n = 0; n < kInstants; ++n) {
        start();
        ASSERT_TRUE(waitForForce()) << n;
        const double killed = steadyTime();
        kill(child_, SIGKILL);
        ASSERT_TRUE(inTime_(zeroAfter(killed))) << n;
        server.serve(steadyTime() + 5e-3);
        ASSERT_FALSE(pushes()) << n << ": and so it stays";
        end();
    }
    std::printf("  zero after %.1f ms at most\n", 1e3 * most_);
}

TEST_F(HaplyGuardian, AProgramWhoseGuardianHasEndedPushesNoMore)
{
    start();
    ASSERT_TRUE(waitForForce());
    const pid_t guardian = guardianOf(child_);
    ASSERT_GT(guardian, 0);
    ASSERT_TRUE(waitForForce()) << "asking took longer than a driver waits for answers";
    const double killed = steadyTime();
    kill(guardian, SIGKILL);
    server.serve(killed + 1, [&] { return !pushes(); });
    std::printf("  zero %.1f ms after the guardian was killed\n", (steadyTime() - killed) * 1e3);
    EXPECT_FALSE(pushes());
    EXPECT_LT(steadyTime() - killed, 0.2) << "at the next exchange; a frozen one is missed after 0.25 s";
    server.serve(steadyTime() + 50e-3);
    EXPECT_FALSE(pushes()) << "and so it stays";
}

TEST_F(HaplyGuardian, AProgramThatIsStoppedLosesTheForceAndIsTold)
{
    start();
    for (int n = 0; n < kInstants; ++n) {
        ASSERT_TRUE(waitForForce()) << n;
        *silenced_           = false;
        const double stopped = steadyTime();
        kill(child_, SIGSTOP);
        ASSERT_TRUE(inTime_(zeroAfter(stopped))) << n;
        server.serve(steadyTime() + 5 * wait_(random_));
        ASSERT_FALSE(pushes()) << n << ": and so it stays";
        kill(child_, SIGCONT);
        server.serve(steadyTime() + 2, [&] { return silenced_->load(); });
        ASSERT_TRUE(silenced_->load()) << n << ": the governor was told, and engages anew";
    }
    std::printf("  zero after %.1f ms at most\n", 1e3 * most_);
}

} // namespace
} // namespace palp
