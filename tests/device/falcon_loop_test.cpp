// Tests of the conversation with a Falcon, in the emulator's virtual time, when its host, its link or its encoders
// fail.
#include "device/falcon/falcon_loop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <new>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "device/detail/held_force.h"
#include "device/falcon/falcon_driver.h"
#include "tests/device/falcon_bench.h"

namespace palp {
namespace {

constexpr double kCount = 55e-6; // [m] most that one count moves the grip, by the singular values of the Jacobian

/// A link that fails when it is told to, and keeps what is written from then on.
struct FailingLink final : FalconLink {
    std::unique_ptr<FalconLink> link;
    std::function<void()>&      fail; ///< empty: it works
    std::vector<FalconCommand>& written;

    FailingLink(std::unique_ptr<FalconLink> l, std::function<void()>& f, std::vector<FalconCommand>& w)
        : link(std::move(l)), fail(f), written(w)
    {
    }
    double      now() const noexcept override { return link->now(); }
    void        control(FtdiRequest request, std::uint16_t value) override { link->control(request, value); }
    std::size_t read(std::span<std::uint8_t> bytes, double timeout) override
    {
        if (fail) fail();
        return link->read(bytes, timeout);
    }
    void write(std::span<const std::uint8_t> bytes) override
    {
        if (fail) {
            FalconPacket packet;
            std::ranges::copy(bytes, packet.begin());
            written.push_back(decodeCommand(packet).value());
        }
        link->write(bytes);
        if (fail) fail();
    }
};

struct LoopBench {
    Ft232Emulator               emulator;
    std::function<void()>       fail;
    std::vector<FalconCommand>  written; ///< since it fails
    std::unique_ptr<FalconLoop> loop;

    explicit LoopBench(const FalconGeometry& geometry = {})
        : emulator([&] {
              Ft232EmulatorSettings settings = runningFalcon();
              settings.falcon.geometry       = geometry;
              settings.falcon.holdTime       = 1e6; // s: a firmware that never lets go
              return settings;
          }())
    {
        FalconLoopSettings settings;
        settings.geometry = geometry;
        auto started      = startFalcon([this] { return emulator.connect(); }, {});
        loop = std::make_unique<FalconLoop>(std::make_unique<FailingLink>(std::move(started.link), fail, written),
                                            settings);
    }

    /// \return the state after so many exchanges
    HapticState run(int exchanges, const FalconRequest& request)
    {
        for (int n = 0; n < exchanges; ++n) loop->exchange(request);
        return loop->state();
    }
    [[nodiscard]] int pushes() const
    {
        const auto motors = emulator.falcon().motors();
        return std::max({std::abs(motors[0]), std::abs(motors[1]), std::abs(motors[2])});
    }
};

TEST(HeldForce, IsHeldThenFallsToZero)
{
    EXPECT_EQ(heldShare(0), 1);
    EXPECT_EQ(heldShare(5e-3), 1);
    EXPECT_NEAR(heldShare(15e-3), 0.5, 1e-12);
    EXPECT_EQ(heldShare(25e-3), 0);
    EXPECT_EQ(heldShare(1e9), 0);
}

TEST(FalconLoop, APositionIsAsOldAsItsPacket)
{
    LoopBench    bench;
    const double before = bench.loop->now();
    const double age    = bench.run(1, {}).age;
    EXPECT_NEAR(age, bench.loop->now() - before, 1e-9) << "one packet, one answer";
    EXPECT_GT(age, 0.4e-3) << "two wires and two transfers";
}

TEST(FalconLoop, AServoThatStopsLeavesNoForceAfter25msAndAnExchange)
{
    LoopBench     bench;
    FalconRequest request{.force = {0, 0, 4}};
    bench.run(100, request);
    const int    full    = bench.pushes();
    const double stopped = bench.loop->now();
    ASSERT_GT(full, 100);

    while (bench.loop->now() - stopped < 0.1) {
        const double age = bench.loop->now() - stopped;
        request.share    = heldShare(age);
        bench.run(1, request);
        EXPECT_LE(bench.pushes(), full * heldShare(age) + 1) << "half a count of rounding each, after " << age << " s";
        if (age < 4e-3) {
            EXPECT_EQ(bench.pushes(), full) << "held";
        }
    }
    const double gone = bench.emulator.falcon().lastTorque() - stopped;

    std::printf("  motors at zero %.1f ms after the last request\n", gone * 1e3);
    EXPECT_LE(gone, 25e-3 + 1.2e-3) << "an exchange: the timer's 1 ms and the wires";
    request.share = 1;                       // it is back
    for (int last = 0, n = 0; n < 60; ++n) { // 0.5 ms each
        bench.run(1, request);
        EXPECT_LE(bench.pushes() - last, full * 0.06) << "1 ms of 20, and rounding";
        last = bench.pushes();
    }
    EXPECT_EQ(bench.pushes(), full);
}

TEST(FalconLoop, ForcesThatTheMotorsCannotMakeHaveTheirReasons)
{
    LoopBench plain;
    plain.run(50, {.force = {1, 0, 0}});
    ASSERT_GT(plain.pushes(), 0);
    EXPECT_EQ(plain.run(3, {.force = {1e308, 0, 0}}).fault, DeviceFault::badForce) << "finite, but no torque is";
    EXPECT_EQ(plain.pushes(), 0);
    EXPECT_EQ(plain.run(30, {.force = {1, 0, 0}}).fault, DeviceFault::none);
    EXPECT_GT(plain.pushes(), 0);

    FalconGeometry flat; // two legs nearly in line: they push alike
    flat.azimuths[2] = flat.azimuths[1] + 1e-3;
    LoopBench singular(flat);
    ASSERT_TRUE(singular.run(3, {}).inBox);
    EXPECT_EQ(singular.run(30, {.force = {1, 0, 0}}).fault, DeviceFault::kinematics);
    EXPECT_EQ(singular.pushes(), 0);
    EXPECT_EQ(singular.run(1, {}).fault, DeviceFault::none) << "where it is is known";
}

TEST(FalconLoop, ALinkThatBreaksGetsZeroPacketsAndIsLost)
{
    struct Case {
        const char*           name;
        std::function<void()> fail;
        DeviceFault           fault;
        std::size_t           packets; // tried at once
    };
    for (const auto& [name, fail, fault, packets] :
         {Case{"broken", [] { throw LinkLost("it took too long"); }, DeviceFault::linkLost, 3},
          Case{"no memory", [] { throw std::bad_alloc(); }, DeviceFault::linkLost, 3},
          Case{"gone", [] { throw LinkGone("it was unplugged"); }, DeviceFault::unplugged, 0}}) {
        LoopBench bench;
        bench.run(50, {.force = {1, 0, 0}});
        ASSERT_GT(bench.pushes(), 0);

        bench.fail              = fail;
        const HapticState state = bench.run(1, {.force = {1, 0, 0}});

        EXPECT_EQ(state.fault, fault) << name;
        EXPECT_FALSE(state.inBox) << name;
        EXPECT_TRUE(bench.loop->isLost()) << name;
        ASSERT_EQ(bench.written.size(), 1 + packets) << name;
        for (std::size_t n = 1; n < bench.written.size(); ++n)
            EXPECT_EQ(bench.written[n].motors, FalconCommand{}.motors) << name;
        bench.emulator.waitUntil(bench.emulator.now() + 2e-3);
        EXPECT_EQ(bench.pushes() == 0, packets > 0) << name << ": what hears has let go";
        EXPECT_EQ(bench.run(5, {.force = {1, 0, 0}}).fault, fault) << name << ": until it is opened anew";
        EXPECT_EQ(bench.written.size(), 1 + packets) << name << ": nothing more is tried";
    }
}

TEST(FalconJump, IsBelievedAfter20AnswersThatAgreeAndWithoutForceTillThen)
{
    glm::dvec3  place{-0.015, 0, 0};
    FalconBench bench(runningFalcon(), [&](const glm::dvec3&, double) { return place; });
    bench.force = governed({1, 0, 0});
    bench.run(0.1);
    ASSERT_TRUE(bench.pushes());
    const double jumped = bench.emulator.now();
    place.x             = 0.015;

    double believed = -1, pushed = -1; // [s] after the jump
    bench.run(0.1, [&] {
        const double since = bench.emulator.now() - jumped;
        const bool   isNew = bench.state.position.x > 0;
        if (isNew && believed < 0) believed = since;
        if (since > 8e-3 && !isNew) {
            EXPECT_EQ(bench.state.fault, DeviceFault::kinematics) << since;
            EXPECT_FALSE(bench.state.inBox) << since;
        }
        if (since > 4e-3 && bench.pushes() && pushed < 0) pushed = since;
    });

    std::printf("  a jump of 30 mm is believed after %.1f ms, force is on after %.1f ms\n", believed * 1e3,
                pushed * 1e3);
    EXPECT_GE(believed, 19e-3) << "20 answers at 1 kHz";
    EXPECT_LE(believed, 30e-3) << "three of them waited for in vain";
    EXPECT_GT(pushed, believed) << "zero from the second answer on";
    EXPECT_NEAR(bench.state.position.x, 0.015, kCount);
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
}

TEST(FalconJump, OldAnswersFor20msAreNeverBelieved)
{
    // 50 packets ago the hand was 15 mm away.
    double      clock = 0;
    FalconBench bench(runningFalcon(), [&](const glm::dvec3&, double dt) {
        clock += dt;
        return glm::dvec3(clock < 0.3 ? -0.03 : std::min(0.03, -0.03 + 0.3 * (clock - 0.3)), 0, 0);
    });
    bench.force = governed({1, 0, 0});
    bench.run(0.4 - bench.emulator.now());
    bench.emulator.cause({LinkTroubleKind::replay, 0.4, 0.42});

    bool   isFault = false;
    double last    = bench.state.position.x;
    bench.run(0.1, [&] {
        EXPECT_GE(bench.state.position.x, last - kCount) << "it moves on, or stays";
        EXPECT_LE(glm::length(bench.state.velocity), 0.3 * 16 / 15 + 2 * kCount / 1e-3) << "the hand's";
        last    = bench.state.position.x;
        isFault = isFault || bench.state.fault == DeviceFault::kinematics;
        if (const double now = bench.emulator.now(); now > 0.404 && now < 0.42) {
            EXPECT_FALSE(bench.pushes()) << now;
            EXPECT_TRUE(now < 0.408 || bench.state.fault == DeviceFault::kinematics) << now;
        }
    });

    EXPECT_TRUE(isFault);
    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_TRUE(bench.pushes());
    EXPECT_NEAR(bench.state.position.x, bench.emulator.falcon().position().x, kCount + 0.3 * 1.2e-3);
}

TEST(FalconJump, AnswersThatDisagreeAreNeverBelieved)
{
    glm::dvec3  place{};
    FalconBench bench(runningFalcon(), [&](const glm::dvec3&, double) { return place; });
    bench.force = governed({1, 0, 0});
    bench.run(0.1);

    int n = 0;
    bench.run(0.3, [&] {
        place.x = ++n / 5 % 2 ? 0.02 : -0.02;
        EXPECT_FALSE(n > 10 && (bench.pushes() || bench.state.inBox)) << n;
        EXPECT_NEAR(bench.state.position.x, 0, kCount) << n;
    });
    EXPECT_EQ(bench.state.fault, DeviceFault::kinematics);
    place = {};
    bench.run(0.1);

    EXPECT_EQ(bench.state.fault, DeviceFault::none);
    EXPECT_TRUE(bench.pushes());
}

} // namespace
} // namespace palp
