#include "engine/session/gripped_haply.h"

#include <algorithm>
#include <cmath>

#include "device/haply/haply_record.h"

namespace palp {
namespace {

std::unique_ptr<LineDevice> driverOf(EmulatedHaply& service)
{
    HapticDeviceInfo info = haplyInfo("inverse3");
    info.model            = "emulated Haply Inverse3";
    info.isSimulation     = true;
    return std::make_unique<LineDevice>(std::make_unique<HaplyLine>(service.opener(), HaplyLineSettings{}), info,
                                        LineSettings{.pace = LinePace::caller});
}

} // namespace

const DeviceRecord kHaplyEmulatorRecord{
    .name      = "haply-emulator",
    .model     = "a Haply Inverse3 emulated down to its service's sockets, in a scripted hand",
    .holder    = DeviceHolder::scriptedHand,
    .simulated = true,
    .make      = [](const DeviceRequest& request) -> std::unique_ptr<HapticDevice> {
        return std::make_unique<GrippedHaply>(*request.hand);
    }};

SimulatedArmSettings GrippedHaply::assumedArm()
{
    SimulatedArmSettings arm;
    arm.mass          = 0.3;
    arm.damping       = 2;
    arm.encoderStep   = 0; // positions come as decimal text
    arm.delayTicks    = 0; // the service and its pace have the delays
    arm.halfWorkspace = 0.11;
    arm.boxRadius     = 0.10;
    return arm;
}

GrippedHaply::GrippedHaply(const GrippingHand& hand, const EmulatedHaplySettings& service,
                           const SimulatedArmSettings& arm)
    : hand_(hand), arm_(arm, hand.at(0).target),
      service_(service, [this](const glm::dvec3& force, double dt) { return moved(force, dt); }),
      device_(driverOf(service_))
{
    hand.demandWithin(arm.boxRadius);
}

HapticState GrippedHaply::read(double now) noexcept
{
    if (last_ < 0 || now < last_) begun_ = service_.now() - now; // the servo's clock starts, or starts again
    last_ = now;
    service_.press(hand_.path.buttons(hand_.path.begin() + now));
    if (hand_.path.turns()) service_.turn(hand_.orientation(now));
    service_.moveTo(now + begun_);
    return device_->read(now);
}

glm::dvec3 GrippedHaply::moved(const glm::dvec3& force, double dt)
{
    arm_.holdBy(isHeld_ ? hand_.at(std::max(0.0, emulated_ - begun_)) : SimulatedHand{});
    emulated_ += dt;
    arm_.step(force, dt);
    return arm_.position();
}

} // namespace palp
