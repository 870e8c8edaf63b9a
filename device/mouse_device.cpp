#include "device/mouse_device.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "device/detail/setting_range.h"

namespace palp {
namespace {

bool isFinite(const glm::dvec3& v) noexcept
{
    return std::isfinite(v.x + v.y + v.z);
}

glm::dvec3 within(const glm::dvec3& point, double reach) noexcept
{
    const double out = glm::length(point);
    return out > reach ? point * (reach / out) : point;
}

} // namespace

const DeviceRecord kMouseRecord{
    .name      = "mouse",
    .model     = "a pointer in the window, without force",
    .holder    = DeviceHolder::pointer,
    .simulated = true,
    .make      = [](const DeviceRequest&) -> std::unique_ptr<HapticDevice> { return std::make_unique<MouseDevice>(); }};

MouseDevice::MouseDevice(const MouseDeviceSettings& settings) : settings_(settings)
{
    demandRange("mouse", "settle", settings.settle, 1e-3, 10);
    demandRange("mouse", "reach", settings.reach, 1e-3, 10);
    demandRange("mouse", "rest's distance from the origin", glm::length(settings.rest), 0, settings.reach);
    info_.model           = "mouse";
    info_.workspaceRadius = settings.reach;
    info_.buttons         = 3;
    info_.isSimulation    = true;
    release(); // sets the first target
}

void MouseDevice::open()
{
    if (state_.fault == DeviceFault::none) return;
    state_          = {};
    badForce_       = false;
    state_.position = settings_.rest;
    state_.homed = state_.inBox = true;
    state_.fault                = DeviceFault::none;
}

void MouseDevice::close() noexcept
{
    state_.velocity = {};
    state_.fault    = DeviceFault::closed;
}

void MouseDevice::render(const GovernedForce& force) noexcept
{
    badForce_ = !isFinite(force.newtons());
}

HapticState MouseDevice::read(double now) noexcept
{
    if (state_.fault == DeviceFault::closed) return state_;
    state_.fault = badForce_ ? DeviceFault::badForce : DeviceFault::none;
    target_.take();
    const Target& target = *target_.held(); // the constructor has set one

    const double passed = state_.sequence == 0 ? 0 : now - state_.time;
    if (!std::isfinite(passed)) return state_; // the clock is unusable: nothing moves
    if (passed < 0) {                          // the clock of another session: continue from there
        state_.time = now;
        return state_;
    }
    // With e = x - target and c = v + e/s: e(t) = (e + c t) exp(-t/s), v(t) = (v - c t/s) exp(-t/s).
    const double     s = settings_.settle, decay = std::exp(-passed / s);
    const glm::dvec3 away = state_.position - target.point, rush = state_.velocity + away / s;
    const glm::dvec3 moved = target.point + (away + rush * passed) * decay;
    state_.velocity        = (state_.velocity - rush * (passed / s)) * decay;
    state_.position        = within(moved, settings_.reach);
    if (state_.position != moved) state_.velocity = {}; // a swing ends at the edge
    state_.buttons = target.buttons;
    state_.time    = now;
    ++state_.sequence;
    return state_;
}

void MouseDevice::target(const glm::dvec3& point, std::uint32_t buttons) noexcept
{
    if (!isFinite(point)) return;
    target_.draft() = {within(point, settings_.reach), buttons};
    target_.publish();
}

} // namespace palp
