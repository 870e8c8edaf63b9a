#pragma once
#include <memory>
#include <string>
#include <utility>

#include "device/line_device.h"
#include "engine/core/contract.h"
#include "samples/chai3d/frames.h"

// A device that CHAI3D drives as one of Palpate's:
//
//     chai3d::cHapticDeviceHandler handler;
//     chai3d::cGenericHapticDevicePtr theirs;
//     handler.getDevice(theirs, 0);
//     const auto device = palp::makeChai3dDevice(theirs, palp::Chai3dCalibration::mayMove); // hands off until it rests
//     device->open();                  // then as any HapticDevice, such as in SessionParts::device
//
// CHAI3D's calibrate() lets an omega, delta or sigma that was not reset find its stops: the arm moves by itself,
// unannounced. So open() calls it only where you say that it may, and have told whoever holds the grip. Without it
// CHAI3D does not say whether the arm knows where it is: reset it before.
// Its calls may block, so they are made on a thread of the driver's own. Forces reach it through the governor alone,
// and only while a servo renews them: LineDevice sees to that. Torques and the force of a gripper stay zero.
namespace palp {

/// Whether open() may let an arm find its stops by itself.
enum class Chai3dCalibration { isDone, mayMove };

/// The conversation with one of CHAI3D's devices.
class Chai3dLine : public DeviceLine {
public:
    Chai3dLine(chai3d::cGenericHapticDevicePtr device, Chai3dCalibration calibration)
        : device_(std::move(device)), calibration_(calibration)
    {
    }
    ~Chai3dLine() override { close(); }

    void open(HapticDeviceInfo& info) override
    {
        if (!device_) throw Error("CHAI3D: there is no device; ask cHapticDeviceHandler for one that is plugged in");
        if (!device_->open())
            throw Error("CHAI3D: " + info.model + " cannot be opened; is it plugged in, and used by no other program?");
        isOpen_                 = true;
        failed_                 = 0;
        const bool isCalibrated = calibration_ == Chai3dCalibration::isDone || device_->calibrate();
        if (isCalibrated && render({})) return;
        close();
        throw Error("CHAI3D: " + info.model + " cannot be calibrated, or takes no forces");
    }

    void exchange(const LineOrder& order, LineSample& sample) noexcept override
    {
        if (!isOpen_) return;
        const bool isGood = render(order.force) && readHand(sample);
        sample.homed      = true; // calibrate() has said so, or the user
        sample.news       = isGood ? LineNews::sample : LineNews::none;
        failed_           = isGood ? 0 : failed_ + 1;
        if (failed_ <= kMostFailures) return;
        sample.fault = DeviceFault::linkLost;
        sample.words = "CHAI3D's driver reports an error at each call; see the device's cable";
    }

    void close() noexcept override
    {
        if (!isOpen_) return;
        static_cast<void>(render({}));
        device_->close();
        isOpen_ = false;
    }

private:
    static constexpr int kMostFailures = 20; ///< exchanges in a row

    [[nodiscard]] bool render(const glm::dvec3& force) noexcept
    {
        return device_->setForceAndTorqueAndGripperForce(toChai3d(force), chai3d::cVector3d(0, 0, 0), 0);
    }

    [[nodiscard]] bool readHand(LineSample& sample) noexcept
    {
        chai3d::cVector3d place, speed, spin;
        chai3d::cMatrix3d turn;
        unsigned int      buttons = 0;
        double            angle   = 0;
        if (!device_->getPosition(place) || !device_->getLinearVelocity(speed)) return false;
        sample.position = fromChai3d(place);
        sample.velocity = fromChai3d(speed);
        // What a device does not sense its class answers with nothing, or not at all.
        if (device_->getRotation(turn)) sample.orientation = fromChai3d(turn);
        if (device_->getAngularVelocity(spin)) sample.angularVelocity = fromChai3d(spin);
        if (device_->getGripperAngleRad(angle)) sample.gripperAngle = angle;
        if (device_->getUserSwitches(buttons)) sample.buttons = buttons;
        return true;
    }

    chai3d::cGenericHapticDevicePtr device_;
    Chai3dCalibration               calibration_;
    bool                            isOpen_ = false;
    int                             failed_ = 0; ///< exchanges in a row
};

/// Returns what CHAI3D's table says of a device. Mass and damping of the bare arm are not in it, so none is credited.
[[nodiscard]] inline HapticDeviceInfo chai3dInfo(const chai3d::cHapticDeviceInfo& theirs)
{
    HapticDeviceInfo info;
    info.model            = theirs.m_modelName.empty() ? "device of CHAI3D" : theirs.m_modelName;
    info.workspaceRadius  = theirs.m_workspaceRadius;
    info.maximumForce     = theirs.m_actuatedPosition ? theirs.m_maxLinearForce : 0;
    info.maximumStiffness = theirs.m_maxLinearStiffness;
    info.maximumDamping   = theirs.m_maxLinearDamping;
    info.buttons          = 32; // it does not say how many
    info.rotates          = theirs.m_sensedRotation;
    info.hasGripper       = theirs.m_sensedGripper;
    return info;
}

/// Makes one of Palpate's devices of one of CHAI3D's; HapticDevice::open() then opens it.
/// \param device       used by nothing else while it is open
/// \param calibration  whether the arm may move by itself when it is opened, or knows already where it is
[[nodiscard]] inline std::unique_ptr<HapticDevice> makeChai3dDevice(chai3d::cGenericHapticDevicePtr device,
                                                                    Chai3dCalibration               calibration,
                                                                    const LineSettings&             settings = {})
{
    const HapticDeviceInfo info = device ? chai3dInfo(device->getSpecifications()) : HapticDeviceInfo{};
    return std::make_unique<LineDevice>(std::make_unique<Chai3dLine>(std::move(device), calibration), info, settings);
}

} // namespace palp
