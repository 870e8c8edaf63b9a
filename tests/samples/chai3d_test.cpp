// The adaptors of samples/chai3d, against a stand-in of CHAI3D's device class.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <thread>

#include <glm/geometric.hpp>

#include "device/arm_device.h"
#include "samples/chai3d/chai3d_palpate_device.h"
#include "samples/chai3d/palpate_chai3d_device.h"
#include "tests/device/governed.h"

namespace palp {
namespace {

constexpr double kTick = 1e-3; // [s]

/// One of CHAI3D's devices with registers instead of an arm.
class Theirs : public chai3d::cGenericHapticDevice {
public:
    Theirs()
    {
        m_specifications.m_modelName          = "stub";
        m_specifications.m_maxLinearForce     = 8;
        m_specifications.m_maxLinearStiffness = 3000;
        m_specifications.m_workspaceRadius    = 0.04;
        m_specifications.m_actuatedPosition = m_specifications.m_sensedRotation = true;
    }
    bool open() override { return ++opened, opens; }
    bool close() override { return ++closed, true; }
    bool calibrate(bool) override { return ++calibrated, calibrates; }
    bool getPosition(chai3d::cVector3d& to) override { return to = place, works.load(); }
    bool getLinearVelocity(chai3d::cVector3d& to) override { return to = speed, works.load(); }
    bool getRotation(chai3d::cMatrix3d& to) override { return to = turn, works.load(); }
    bool getUserSwitches(unsigned int& to) override { return to = 5, works.load(); }
    bool setForceAndTorqueAndGripperForce(const chai3d::cVector3d& f, const chai3d::cVector3d& t, double g) override
    {
        force = f;
        torque += std::abs(t.x()) + std::abs(t.y()) + std::abs(t.z()) + std::abs(g);
        return works;
    }

    chai3d::cVector3d place{0.003, 0.001, 0.002}, speed{0.3, 0.1, 0.2}, force{};
    chai3d::cMatrix3d turn{};
    double            torque = 0;
    int               opened = 0, closed = 0, calibrated = 0;
    bool              opens = true, calibrates = true;
    std::atomic<bool> works{true};
};

struct AsOurs : ::testing::Test {
    std::shared_ptr<Theirs>       theirs = std::make_shared<Theirs>();
    std::unique_ptr<HapticDevice> device =
        makeChai3dDevice(theirs, Chai3dCalibration::mayMove, {.pace = LinePace::caller});
    double now = 0; // [s]

    HapticState ticks(int count, const GovernedForce& force = {})
    {
        HapticState state;
        for (int n = 0; n < count; ++n) state = device->exchange(force, now += kTick);
        return state;
    }
};

TEST_F(AsOurs, ItsStateComesInOurFrameAndItsTableIsBelieved)
{
    theirs->turn       = {};
    theirs->turn(0, 0) = theirs->turn(1, 1) = 0; // a quarter turn about their z, which points up
    theirs->turn(0, 1)                      = -1;
    theirs->turn(1, 0)                      = 1;
    device->open();
    const HapticState state = ticks(3);
    EXPECT_EQ(state.fault, DeviceFault::none);
    EXPECT_EQ(state.position, glm::dvec3(0.001, 0.002, 0.003)) << "right, up, to the user";
    EXPECT_EQ(state.velocity, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_EQ(state.buttons, 5U);
    EXPECT_NEAR(glm::length(state.orientation * glm::dvec3(0, 0, 1) - glm::dvec3(1, 0, 0)), 0, 1e-12)
        << "what points to the user (their x) then points right (their y); rounding";
    EXPECT_EQ(device->info().model, "stub");
    EXPECT_EQ(device->info().workspaceRadius, 0.04);
    EXPECT_EQ(device->info().maximumForce, 8);
    EXPECT_EQ(device->info().maximumStiffness, 3000);
    EXPECT_EQ(device->info().ownDamping, 0) << "not in their table: none is credited";
    EXPECT_TRUE(device->info().rotates);
}

TEST_F(AsOurs, AForceIsTurnedIntoTheirFrameAndZeroAtTheEnd)
{
    device->open();
    ticks(3);
    ticks(50, governed({1, 2, 3}));
    EXPECT_NEAR(theirs->force.y(), 1, 1e-9) << "right; rounding of the governor's ramp";
    EXPECT_NEAR(theirs->force.z(), 2, 1e-9) << "up";
    EXPECT_NEAR(theirs->force.x(), 3, 1e-9) << "to the user";
    EXPECT_EQ(theirs->torque, 0) << "neither a torque nor a grip's force";
    device->close();
    device->close();
    EXPECT_EQ(theirs->force.x(), 0);
    EXPECT_EQ(theirs->force.y(), 0);
    EXPECT_EQ(theirs->force.z(), 0);
    EXPECT_EQ(theirs->closed, 1);
}

TEST_F(AsOurs, ErrorsAreZeroForceThenALostLink)
{
    device->open();
    ticks(3);
    ticks(50, governed({0, 2, 0}));
    EXPECT_GT(theirs->force.z(), 1);
    theirs->works = false;
    ticks(15, governed({0, 2, 0}));
    EXPECT_EQ(theirs->force.z(), 0) << "no sample for ten exchanges";
    EXPECT_EQ(ticks(10, governed({0, 2, 0})).fault, DeviceFault::linkLost);
    EXPECT_STRNE(device->faultWords(), "");
}

TEST_F(AsOurs, NumbersThatAreNoneAreNoSamples)
{
    device->open();
    const glm::dvec3 before = ticks(3).position;
    theirs->place           = {std::nan(""), 0, 0};
    const HapticState state = ticks(30, governed({0, 2, 0}));
    EXPECT_EQ(state.fault, DeviceFault::garbled);
    EXPECT_EQ(state.position, before);
    EXPECT_EQ(theirs->force.z(), 0);
    theirs->place = {1e308, 0, 0};
    EXPECT_NE(ticks(30, governed({0, 2, 0})).fault, DeviceFault::none);
    EXPECT_EQ(theirs->force.z(), 0);
}

TEST_F(AsOurs, WhatCannotBeOpenedIsSaid)
{
    theirs->opens = false;
    EXPECT_THROW(device->open(), Error);
    theirs->opens      = true;
    theirs->calibrates = false;
    EXPECT_THROW(device->open(), Error);
    EXPECT_EQ(theirs->closed, 1) << "what was opened is closed";
    theirs->calibrates = true;
    EXPECT_NO_THROW(device->open());
    EXPECT_THROW(makeChai3dDevice(nullptr, Chai3dCalibration::isDone)->open(), Error);
}

TEST_F(AsOurs, TheArmMovesByItselfOnlyWhereTheCallerSaysSo)
{
    device->open();
    EXPECT_EQ(theirs->calibrated, 1);
    device->close();
    const auto still = makeChai3dDevice(theirs, Chai3dCalibration::isDone, {.pace = LinePace::caller});
    still->open();
    EXPECT_EQ(theirs->calibrated, 1);
    EXPECT_TRUE((still->read(0.001), still->read(0.002).homed));
}

/// Our device as one of theirs, in virtual time.
class Ours : public Chai3dDevice {
public:
    using Chai3dDevice::Chai3dDevice;
    double clock = 0; // [s]

protected:
    double tickTime(double until) override { return clock = std::max(clock, until); }
};

/// An arm with a button, which can go away.
struct Arm : ArmDevice {
    HapticState read(double now) noexcept override
    {
        HapticState state = ArmDevice::read(now);
        state.buttons     = isPressed ? 1 : 0;
        if (isGone) state.fault = DeviceFault::unplugged;
        return state;
    }
    bool isPressed = false, isGone = false;
};

struct AsTheirs : ::testing::Test {
    AsTheirs()
    {
        auto made = std::make_unique<Arm>();
        arm       = made.get();
        device    = std::make_unique<Ours>(std::move(made));
    }
    Arm*                  arm = nullptr; ///< of the device
    std::unique_ptr<Ours> device;

    /// Runs a haptic loop of CHAI3D's kind.
    template <class Law>
    void loop(double seconds, Law law)
    {
        for (const double end = device->clock + seconds; device->clock < end;) {
            chai3d::cVector3d place;
            EXPECT_TRUE(device->getPosition(place));
            EXPECT_TRUE(device->setForceAndTorqueAndGripperForce(law(place), {}, 0));
        }
    }
    static chai3d::cVector3d nothing(const chai3d::cVector3d&) { return {}; }
};

TEST_F(AsTheirs, AForceEngagesAndIsHeldToTheGovernorsLimits)
{
    EXPECT_FALSE(device->setForceAndTorqueAndGripperForce({0, 0, 5}, {}, 0)) << "it is closed";
    ASSERT_TRUE(device->open());
    arm->holdBy({.stiffness = 2000, .damping = 20});
    chai3d::cVector3d felt;
    loop(0.5, [](const auto&) { return chai3d::cVector3d(0, 0, 50); });
    device->getForce(felt);
    EXPECT_EQ(felt.z(), 0) << "a program that begins with a force waits";
    loop(2, nothing);
    double last = 0, step = 0, most = 0; // [N]
    loop(1, [&](const auto&) {
        device->getForce(felt);
        step = std::max(step, std::abs(felt.z() - last));
        most = std::max(most, last = felt.z());
        return chai3d::cVector3d(0, 0, 50);
    });
    EXPECT_NEAR(most, 6, 1e-9) << "clamped";
    EXPECT_LE(step, 1 + 1e-9) << "1 N/ms";
}

TEST_F(AsTheirs, AWallAtTheStatedStiffnessIsStableAndOneThatIsStifferIsDamped)
{
    for (const double factor : {1.0, 3.0}) {
        auto made = std::make_unique<Arm>();
        arm       = made.get();
        device    = std::make_unique<Ours>(std::move(made));
        ASSERT_TRUE(device->open());
        const double  stiffness = factor * device->getSpecifications().m_maxLinearStiffness;
        SimulatedHand hand{.stiffness = 150, .damping = 0};
        arm->holdBy(hand);
        loop(2, nothing);
        const auto wall = [&](const chai3d::cVector3d& p) {
            return chai3d::cVector3d(0, 0, std::max(0.0, -stiffness * p.z()));
        };
        const double began = device->clock;
        double       low = 1, high = -1; // [m]
        loop(4, [&](const auto& p) {
            hand.target.y = -14e-3 * std::min(1.0, (device->clock - began) / 0.5);
            arm->holdBy(hand);
            if (device->clock - began > 3) low = std::min(low, p.z()), high = std::max(high, p.z());
            return wall(p);
        });
        EXPECT_EQ(device->governor().fault(), GovernorFault::none);
        EXPECT_LT(high - low, factor == 1 ? 0.2e-3 : 1e-3) << "as on a Falcon; beyond the cap by step 4 alone";
    }
}

TEST_F(AsTheirs, WhatIsNotFiniteIsZeroUntilTheButtonIsHeld)
{
    ASSERT_TRUE(device->open());
    arm->holdBy({.stiffness = 2000, .damping = 20});
    loop(2, nothing);
    loop(0.1, [](const auto&) { return chai3d::cVector3d(0, 0, 3); });
    loop(0.03, [](const auto&) { return chai3d::cVector3d(0, 0, std::nan("")); });
    chai3d::cVector3d felt;
    device->getForce(felt);
    EXPECT_EQ(felt.z(), 0);
    EXPECT_EQ(device->governor().fault(), GovernorFault::forceNotFinite);
    arm->isPressed = true;
    loop(0.015, nothing);
    EXPECT_EQ(device->governor().fault(), GovernorFault::forceNotFinite) << "a short press may be a corrupt packet";
    loop(0.01, nothing);
    EXPECT_EQ(device->governor().fault(), GovernorFault::none);
    bool isDown = false;
    EXPECT_TRUE(device->getUserSwitch(0, isDown) && isDown);
    EXPECT_TRUE(device->getUserSwitch(1, isDown) && !isDown);
    EXPECT_TRUE(device->getUserSwitch(99, isDown) && !isDown);
    EXPECT_TRUE(device->close());
    EXPECT_FALSE(device->close());
    ASSERT_TRUE(device->open());
    EXPECT_EQ(device->governor().fault(), GovernorFault::none) << "opened anew";
}

TEST_F(AsTheirs, ItsTurnComesInTheirFrame)
{
    chai3d::cMatrix3d turn;
    toChai3d(glm::angleAxis(std::acos(0.0), glm::dvec3(0, 1, 0)), turn); // about our y, their z
    EXPECT_NEAR(turn(1, 0), 1, 1e-12) << "their x goes to their y; rounding";
    EXPECT_NEAR(turn(2, 2), 1, 1e-12);
    EXPECT_NEAR(std::abs(glm::dot(fromChai3d(turn), glm::angleAxis(std::acos(0.0), glm::dvec3(0, 1, 0)))), 1, 1e-12);
    turn(0, 0) = std::nan("");
    EXPECT_EQ(fromChai3d(turn), glm::dquat(1, 0, 0, 0)) << "no turn";
}

TEST_F(AsTheirs, ADeviceThatIsUnpluggedIsNoSuccess)
{
    ASSERT_TRUE(device->open());
    loop(2, nothing);
    loop(0.1, [](const auto&) { return chai3d::cVector3d(0, 0, 3); });
    arm->isGone = true;
    chai3d::cVector3d place;
    for (int n = 0; n < 20; ++n) EXPECT_FALSE(device->setForceAndTorqueAndGripperForce({0, 0, 3}, {}, 0));
    EXPECT_FALSE(device->getPosition(place));
    EXPECT_EQ(device->governor().force().newtons(), glm::dvec3(0));
}

TEST_F(AsTheirs, ForcesCanBeSwitchedOff)
{
    ASSERT_TRUE(device->open());
    arm->holdBy({.stiffness = 2000, .damping = 20});
    loop(2, nothing);
    EXPECT_TRUE(device->enableForces(false));
    loop(0.5, [](const auto&) { return chai3d::cVector3d(0, 0, 3); });
    chai3d::cVector3d felt;
    device->getForce(felt);
    EXPECT_EQ(felt.z(), 0);
    EXPECT_TRUE(device->enableForces(true));
    loop(0.5, [](const auto&) { return chai3d::cVector3d(0, 0, 3); });
    device->getForce(felt);
    EXPECT_NEAR(felt.z(), 3, 1e-9);
}

} // namespace
} // namespace palp
