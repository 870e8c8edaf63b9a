#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "device/haptic_device.h"
#include "engine/core/contract.h"
#include "engine/force/governor.h"
#include "samples/chai3d/frames.h"

// A device that Palpate drives as one of CHAI3D's, such as a Falcon without its maker's driver, or a Haply on Linux:
//
//     auto device = std::make_shared<palp::Chai3dDevice>(std::make_unique<...>(...));    // any HapticDevice
//     tool->setHapticDevice(device);
//
// A governor lies between: the forces of CHAI3D are held to 6 N and to what the device states, rise by 1 N/ms at most,
// come on within 1.5 s once the hand is calm, and are damped where they would drive the hand. After a fault of the
// governor the device's first button, held for 20 ms, starts it anew; governor() says what it was.
//
// CHAI3D does not say how stiff its contact is, so nothing can cap that: let no spring of the scene be stiffer than
// getSpecifications().m_maxLinearStiffness, which is the governor's cap for this device and loop.
namespace palp {

class Chai3dDevice : public chai3d::cGenericHapticDevice {
public:
    explicit Chai3dDevice(std::unique_ptr<HapticDevice> device) : device_(std::move(device)) { describe(); }
    ~Chai3dDevice() override { stop(); }

    bool open() override
    {
        try {
            device_->open();
        } catch (const Error& error) {
            error_ = error.what();
            return false;
        }
        describe();
        governor_     = ForceGovernor(settings());
        isOpen_       = true;
        m_deviceReady = true;
        isFresh_      = false;
        sequence_     = 0;
        period_       = 0;
        last_ = now_ = tickTime(0);
        read();
        return true;
    }
    bool close() override
    {
        const bool wasOpen = isOpen_;
        stop();
        return wasOpen;
    }
    bool calibrate(bool /*again*/ = false) override
    {
        if (isOpen_ && !state_.homed) device_->home();
        return isOpen_ && state_.homed;
    }

    bool getPosition(chai3d::cVector3d& position) override
    {
        read();
        position = toChai3d(state_.position);
        return isGood();
    }
    bool getLinearVelocity(chai3d::cVector3d& velocity) override
    {
        read();
        velocity = toChai3d(state_.velocity);
        return isGood();
    }
    bool getRotation(chai3d::cMatrix3d& rotation) override
    {
        read();
        toChai3d(state_.orientation, rotation);
        return isGood();
    }
    bool getAngularVelocity(chai3d::cVector3d& velocity) override
    {
        read();
        velocity = toChai3d(state_.angularVelocity);
        return isGood();
    }
    bool getGripperAngleRad(double& angle) override
    {
        read();
        angle = state_.gripperAngle;
        return isGood();
    }
    /// Returns the force that the governor let through.
    bool getForce(chai3d::cVector3d& force) override
    {
        force = toChai3d(force_);
        return isGood();
    }
    bool getUserSwitch(int index, bool& isDown) override
    {
        read();
        isDown = index >= 0 && index < 32 && (state_.buttons >> unsigned(index) & 1U) != 0;
        return isGood();
    }
    bool getUserSwitches(unsigned int& switches) override
    {
        read();
        switches = state_.buttons;
        return isGood();
    }
    /// Renders what the governor makes of the force. The next call that asks for the hand waits for the next
    /// millisecond. Torque and the force of a gripper are not rendered.
    bool setForceAndTorqueAndGripperForce(const chai3d::cVector3d& force, const chai3d::cVector3d& /*torque*/,
                                          double /*gripper*/) override
    {
        if (!isOpen_) return false;
        read();
        govern(isOn_ ? fromChai3d(force) : glm::dvec3(0));
        const bool isZero = governor_.force().newtons() == glm::dvec3(0);
        device_->light(std::uint8_t(isZero ? DeviceLight::blue : DeviceLight::green));
        device_->render(governor_.force());
        isFresh_ = false;
        return isGood();
    }
    /// Switches forces off, or on again; some versions of CHAI3D call it.
    virtual bool enableForces(bool isOn)
    {
        isOn_ = isOn;
        return isOpen_;
    }

    [[nodiscard]] const ForceGovernor& governor() const noexcept { return governor_; }
    [[nodiscard]] const HapticState&   state() const noexcept { return state_; }
    [[nodiscard]] const std::string&   error() const noexcept { return error_; } ///< why open() failed

protected:
    /// Waits until a time of the device's own clock [s], which begins at its first call, and returns the time.
    virtual double tickTime(double until)
    {
        const auto there = began_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(until));
        std::this_thread::sleep_until(there);
        return std::chrono::duration<double>(Clock::now() - began_).count();
    }

private:
    using Clock = std::chrono::steady_clock;

    static constexpr double kTick       = 1e-3; ///< [s]
    static constexpr int    kPressTicks = 20;   ///< of the first button, which resets a fault
    static constexpr double kCarried    = 0.98; ///< [1] of the arm's weight: carried whole, it might rise by itself

    [[nodiscard]] GovernorSettings settings() const
    {
        const HapticDeviceInfo& info = device_->info();
        const auto       lower = [](double most, double stated) { return stated > 0 ? std::min(most, stated) : most; };
        GovernorSettings limits;
        limits.maximumForce     = lower(limits.maximumForce, info.maximumForce);
        limits.motorForce       = lower(limits.motorForce, info.maximumForce);
        limits.maximumStiffness = lower(limits.maximumStiffness, info.maximumStiffness);
        limits.statedStiffness  = limits.maximumStiffness;
        limits.mass             = info.mass;
        limits.ownDamping       = info.ownDamping;
        limits.weight           = kCarried * info.weight;
        return limits;
    }

    void describe()
    {
        const HapticDeviceInfo& info          = device_->info();
        m_specifications                      = {};
        m_specifications.m_model              = chai3d::C_HAPTIC_DEVICE_CUSTOM;
        m_specifications.m_modelName          = info.model;
        m_specifications.m_manufacturerName   = "through Palpate";
        m_specifications.m_maxLinearForce     = settings().maximumForce;
        m_specifications.m_maxLinearDamping   = info.maximumDamping;
        m_specifications.m_workspaceRadius    = info.workspaceRadius;
        m_specifications.m_sensedPosition     = true;
        m_specifications.m_sensedRotation     = info.rotates;
        m_specifications.m_sensedGripper      = info.hasGripper;
        m_specifications.m_actuatedPosition   = info.maximumForce > 0;
        m_specifications.m_leftHand           = true;
        m_specifications.m_rightHand          = true;
        m_specifications.m_maxLinearStiffness = ForceGovernor(settings()).stiffnessCap();
    }

    /// Reads the device once a tick: all that is asked for in a tick is of one state.
    void read()
    {
        if (!isOpen_ || (isFresh_ && tickTime(0) < now_ + 2 * kTick)) return;
        now_     = tickTime(now_ + kTick);
        state_   = device_->read(now_);
        isFresh_ = true;
        if (state_.sequence == sequence_) return;
        if (sequence_ > 0 && state_.time > answered_)
            period_ = (state_.time - answered_) / double(state_.sequence - sequence_);
        sequence_ = state_.sequence;
        answered_ = state_.time;
    }

    void govern(const glm::dvec3& force)
    {
        const bool isPressed = state_.fault == DeviceFault::none && (state_.buttons & 1U) != 0;
        pressed_             = isPressed ? pressed_ + 1 : 0;
        if (pressed_ == kPressTicks) governor_.reset();
        GovernorInput in;
        in.force           = force;
        in.position        = state_.position;
        in.velocity        = state_.velocity;
        in.homed           = state_.homed && state_.fault == DeviceFault::none;
        in.inBox           = state_.inBox;
        in.dt              = now_ - std::exchange(last_, now_);
        in.missedExchanges = state_.missed;
        in.answerAge       = state_.age;
        in.sinceAnswer     = std::max(0.0, now_ - state_.time);
        in.exchangePeriod  = period_;
        force_             = governor_.step(in).force;
    }

    [[nodiscard]] bool isGood() const noexcept { return isOpen_ && !isFinal(state_.fault); }

    void stop() noexcept
    {
        if (!isOpen_) return;
        device_->render(GovernedForce());
        device_->close();
        isOpen_       = false;
        m_deviceReady = false;
        force_        = {};
    }

    std::unique_ptr<HapticDevice> device_;
    ForceGovernor                 governor_;
    HapticState                   state_;
    glm::dvec3                    force_{}; ///< [N] that the governor let through
    std::string                   error_;
    Clock::time_point             began_ = Clock::now();
    double                        now_ = 0, last_ = 0; ///< [s] of the state, of the last force
    double                        answered_ = 0;       ///< [s] when the newest answer came
    double                        period_   = 0;       ///< [s] from answer to answer; 0: unknown
    std::uint64_t                 sequence_ = 0;       ///< of the newest answer
    int                           pressed_  = 0;       ///< ticks that the first button has been down
    bool                          isOpen_ = false, isOn_ = true;
    bool                          isFresh_ = false; ///< the state is of this tick
};

} // namespace palp
