// The whole loop in virtual time on the drivers behind lines: tank, governor, driver, emulator or stand-in, arm. Mass
// and damping of these arms are assumed, where their makers publish none; that of a Touch is published as 45 g.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>

#include <dlfcn.h>
#include <glm/geometric.hpp>

#include "device/haply/emulated_haply.h"
#include "device/haply/haply_record.h"
#include "device/hid/hid_bridge.h"
#include "device/simulated_arm.h"
#include "device/vendor/force_dimension.h"
#include "device/vendor/open_haptics.h"
#include "engine/force/energy_tank.h"
#include "engine/force/governor.h"
#include "tests/device/fake_bridge.h"
#include "tests/device/fake_sdk/fake_sdk.h"
#include "tests/support/errors.h"

namespace palp {
namespace {

constexpr double kTick = 1e-3; // [s]

SimulatedArmSettings armOf(double mass, double damping)
{
    SimulatedArmSettings arm;
    arm.mass          = mass;
    arm.damping       = damping;
    arm.encoderStep   = 0;
    arm.delayTicks    = 0; // the driver takes a force into the next exchange: that is the tick of delay
    arm.halfWorkspace = 0.07;
    return arm;
}

/// A driver and what it drives.
struct Rig {
    explicit Rig(const SimulatedArmSettings& settings) : arm(settings) {}
    virtual ~Rig() = default;

    /// Moves the arm on to a time [s] with the force that acts.
    virtual void moveTo(double time) = 0;

    SimulatedArm                  arm;
    std::unique_ptr<HapticDevice> device;
};

struct HaplyRig : Rig {
    HaplyRig()
        : Rig(armOf(0.3, 2)), service({}, [this](const glm::dvec3& force, double dt) {
              arm.step(force, dt);
              return arm.position();
          })
    {
        device = makeHaply(service.opener(), {}, {.pace = LinePace::caller});
    }
    ~HaplyRig() override { device->close(); } // before the service ends
    void moveTo(double time) override { service.moveTo(time); }

    EmulatedHaply service;
};

/// A stand-in of a maker's library: the test moves the arm between exchanges.
struct SdkRig : Rig {
    SdkRig(const char* variable, const char* library, const SimulatedArmSettings& settings,
           std::unique_ptr<DeviceLine> line, const HapticDeviceInfo& info, double metre, const glm::ivec3& axes,
           int every = 1)
        : Rig(settings), metre_(metre), axes_(axes), every_(every)
    {
        setenv(variable, PALPATE_FAKE_SDK, 1);
        sdk_ = reinterpret_cast<FakeSdk* (*)()>(dlsym(dlopen(library, RTLD_NOW | RTLD_LOCAL), "fakeSdk"))();
        for (int axis = 0; axis < 3; ++axis) sdk_->position[axis] = sdk_->velocity[axis] = sdk_->force[axis] = 0;
        sdk_->isPresent = sdk_->isReady = true;
        sdk_->isSame = sdk_->isOutOfNumbers = false;
        sdk_->error = sdk_->status = 0;
        device = std::make_unique<LineDevice>(std::move(line), info, LineSettings{.pace = LinePace::caller});
    }
    void moveTo(double time) override
    {
        glm::dvec3 force{};
        for (int axis = 0; axis < 3; ++axis) force[axes_[axis]] = sdk_->force[axis];
        arm.step(force, time - time_);
        time_        = time;
        sdk_->isSame = ticks_++ % every_ != 0;
        if (sdk_->isSame) return;
        for (int axis = 0; axis < 3; ++axis) {
            sdk_->position[axis] = arm.position()[axes_[axis]] / metre_;
            sdk_->velocity[axis] = arm.velocity()[axes_[axis]] / metre_;
        }
    }

private:
    FakeSdk*   sdk_ = nullptr;
    double     metre_;
    double     time_ = 0; // [s]
    glm::ivec3 axes_;     // which of ours each of theirs is
    int        every_;    // ticks from one new sample to the next; the same comes again between them
    int        ticks_ = 0;
};

/// An arm behind the bridge's report, as samples/bridge_peer.py: its numbers, whole micrometres and millinewtons.
struct BridgeRig : Rig {
    BridgeRig() : Rig(armOf(0.3, 2)), hid(system.plug(ours())), firmware(hid)
    {
        firmware.answer.maximumForce     = 6;
        firmware.answer.maximumStiffness = 800;
        firmware.answer.maximumDamping   = 3;
        firmware.tick(kTick); // the report that open() waits for
        device = std::make_unique<HidBridgeDevice>(system, ours(),
                                                   HidBridgeSettings{.openWait = 0.05, .pace = HidPace::caller});
    }
    ~BridgeRig() override { device.reset(); } // before what it uses
    void moveTo(double time) override
    {
        arm.step(firmware.force(), time - time_);
        time_                    = time;
        firmware.answer.position = arm.position();
        firmware.answer.velocity = arm.state().velocity;
        firmware.tick(kTick);
    }

    FakeHidSystem  system;
    FakeHidDevice& hid;
    FakeBridge     firmware;

private:
    double time_ = 0; // [s]
};

struct Kind {
    const char* name;
    std::unique_ptr<Rig> (*make)();
};

const Kind kKinds[] = {
    {"Haply", []() -> std::unique_ptr<Rig> { return std::make_unique<HaplyRig>(); }},
    {"Omega",
     []() -> std::unique_ptr<Rig> {
         return std::make_unique<SdkRig>("FORCEDIM_SDK", PALPATE_FAKE_SDK "/libdrd.so.3", armOf(0.3, 2),
                                         makeForceDimensionLine(), forceDimensionInfo(33), 1, glm::ivec3(2, 0, 1));
     }},
    {"OmegaAt250Hz",
     []() -> std::unique_ptr<Rig> {
         return std::make_unique<SdkRig>("FORCEDIM_SDK", PALPATE_FAKE_SDK "/libdrd.so.3", armOf(0.3, 2),
                                         makeForceDimensionLine(), forceDimensionInfo(33), 1, glm::ivec3(2, 0, 1), 4);
     }},
    {"Bridge", []() -> std::unique_ptr<Rig> { return std::make_unique<BridgeRig>(); }},
    {"Touch", []() -> std::unique_ptr<Rig> {
         return std::make_unique<SdkRig>("OPENHAPTICS", PALPATE_FAKE_SDK "/libHD.so", armOf(0.045, 1),
                                         makeOpenHapticsLine(), openHapticsInfo("Touch"), 1e-3, glm::ivec3(0, 1, 2));
     }}};

/// A wall through the origin, whose outside is above, at the cap of the device.
struct Loop {
    std::unique_ptr<Rig> rig;
    ForceGovernor        governor;
    EnergyTank           tank{};
    GovernorOutput       out{};
    HapticState          state{};
    bool                 twoSided = false;
    std::uint64_t        sequence = 0;
    double               answered = 0, period = kTick; // [s] as the servo measures it
    double               now = 0;                      // [s]

    explicit Loop(const Kind& kind) : rig(kind.make())
    {
        rig->device->open();
        const HapticDeviceInfo& info = rig->device->info();
        GovernorSettings        settings;
        settings.mass             = info.mass;
        settings.ownDamping       = info.ownDamping;
        settings.statedStiffness  = std::min(settings.statedStiffness, info.maximumStiffness); // as the servo
        settings.maximumStiffness = std::min(1000.0, info.maximumStiffness);                   // of a scene
        settings.maximumForce     = std::min(settings.maximumForce, info.maximumForce);
        governor                  = ForceGovernor(settings);
    }
    void run(
        double seconds, const std::function<void()>& each = [] {})
    {
        for (const double end = now + seconds - kTick / 2; now < end; now += kTick) {
            rig->moveTo(now);
            state = rig->device->read(now);
            tick();
            rig->device->render(governor.force());
            each();
        }
    }
    void tick()
    {
        GovernorInput in;
        in.position    = state.position;
        in.velocity    = state.velocity;
        in.homed       = state.homed && state.fault == DeviceFault::none;
        in.inBox       = state.inBox;
        in.dt          = kTick;
        in.answerAge   = state.age;
        in.sinceAnswer = now - state.time;
        if (state.sequence > sequence) {
            period   = (state.time - answered) / double(state.sequence - sequence);
            sequence = state.sequence;
            answered = state.time;
        }
        in.exchangePeriod  = period;
        const double depth = twoSided ? -in.position.y : std::max(0.0, -in.position.y);
        const auto   paid  = tank.step({.stiffness    = governor.stiffnessCap(),
                                        .depth        = std::abs(depth),
                                        .normalSpeed  = in.velocity.y,
                                        .dt           = kTick,
                                        .spareDamping = governor.spareDamping()});
        in.force           = {0, paid.stiffness * depth, 0};
        in.stiffness       = paid.stiffness;
        in.admittedEnergy  = paid.used;
        in.storedEnergy    = paid.stored;
        out                = governor.step(in);
    }
};

class LineLoop : public ::testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(On, LineLoop, ::testing::ValuesIn(kKinds), [](const auto& which) { return which.param.name; });

TEST_P(LineLoop, ReleasedOnATwoSidedSpringAtTheCapTheArmSettles)
{
    Loop loop(GetParam());
    loop.twoSided = true;
    loop.run(2); // engages at rest
    loop.rig->arm.holdBy({.stiffness = 2000, .damping = 20, .target = {0, 1e-3, 0}});
    loop.run(0.3);
    loop.rig->arm.holdBy({});
    double released = 0, left = 0; // [m]
    loop.run(0.2, [&] { released = std::max(released, std::abs(loop.rig->arm.position().y)); });
    loop.run(3);
    loop.run(1, [&] { left = worse(left, loop.rig->arm.position().y); });
    std::printf("  %s: cap %.0f N/m, lag %.2f ms, released at %.2f mm, left %.4f mm\n", GetParam().name,
                loop.governor.stiffnessCap(), loop.governor.lag() * 1e3, released * 1e3, left * 1e3);
    EXPECT_EQ(loop.out.gain, 1);
    EXPECT_EQ(loop.out.fault, GovernorFault::none);
    EXPECT_EQ(loop.state.fault, DeviceFault::none);
    EXPECT_GT(released, 0.3e-3) << "or the test says nothing";
    EXPECT_LT(left, 0.05e-3) << "as on a Falcon, without its counts";
}

TEST_P(LineLoop, APressedWallAtTheCapIsAtRestHalfASecondLater)
{
    for (const double damping : {0.0, 2.0}) { // [N s/m] of the hand: none at all, relaxed
        Loop          loop(GetParam());
        SimulatedHand hand{.stiffness = 150, .damping = damping};
        loop.rig->arm.holdBy(hand);
        loop.run(2);
        EXPECT_EQ(loop.out.gain, 1);
        const double cap = loop.governor.stiffnessCap(), most = 0.6 * loop.rig->device->info().maximumForce;
        const double deep = std::min(2e-3 * (1 + cap / hand.stiffness), most * (1 / cap + 1 / hand.stiffness));
        const double from = loop.now;
        double       low = 1, high = -1;
        loop.run(5, [&] {
            const double s = std::min(1.0, (loop.now - from) / 0.5);
            hand.target.y  = -deep * s * s * s * (10 - 15 * s + 6 * s * s);
            loop.rig->arm.holdBy(hand);
            if (loop.now - from < 1) return;
            low  = std::min(low, loop.rig->arm.position().y);
            high = std::max(high, loop.rig->arm.position().y);
        });
        std::printf("  %s, hand %.0f N s/m: %.2f N, swing %.3f mm\n", GetParam().name, damping,
                    glm::length(loop.out.force), (high - low) * 1e3);
        EXPECT_EQ(loop.out.fault, GovernorFault::none);
        EXPECT_GT(glm::length(loop.out.force), 0.5);
        EXPECT_LT(high - low, 0.2e-3) << "as on a Falcon";
    }
}

} // namespace
} // namespace palp
