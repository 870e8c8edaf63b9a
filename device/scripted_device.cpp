#include "device/scripted_device.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp {
namespace {

bool isFinite(const glm::dvec3& v) noexcept
{
    return std::isfinite(v.x + v.y + v.z);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

} // namespace

HandPath replayed(std::vector<PathPoint> points, double start)
{
    if (points.empty()) throw Error("replayed hand: expected at least one point, found none");
    for (std::size_t n = 0; n < points.size(); ++n) {
        if (!std::isfinite(points[n].time) || !isFinite(points[n].position))
            throw Error("replayed hand: point " + std::to_string(n) + " is not finite");
        if (n > 0 && !(points[n].time > points[n - 1].time))
            throw Error("replayed hand: point " + std::to_string(n) + " is not later than the one before it");
    }
    return [points = std::move(points), start](double now) {
        const double time = now - start + points.front().time;
        const auto   next = std::ranges::upper_bound(points, time, {}, &PathPoint::time);
        if (next == points.begin()) return points.front().position;
        if (next == points.end()) return points.back().position;
        const PathPoint& last = *(next - 1);
        return glm::mix(last.position, next->position, (time - last.time) / (next->time - last.time));
    };
}

ScriptedDevice::ScriptedDevice(HandPath path, double reach) : path_(std::move(path))
{
    if (!path_) throw Error("scripted hand: expected a path, found none");
    if (!(reach > 0) || !std::isfinite(reach))
        throw Error("scripted hand: reach must be above 0 m, found " + std::to_string(reach));
    info_.model           = "scripted hand";
    info_.workspaceRadius = reach;
    info_.isSimulation    = true;
}

void ScriptedDevice::open()
{
    if (state_.fault != DeviceFault::closed) return;
    state_       = {};
    state_.homed = true;
    state_.fault = DeviceFault::none;
}

void ScriptedDevice::close() noexcept
{
    state_.velocity = {};
    state_.fault    = DeviceFault::closed;
}

HapticState ScriptedDevice::exchange(const GovernedForce& force, double now) noexcept
{
    if (state_.fault == DeviceFault::closed) return state_;
    glm::dvec3 place(kNan);
    try {
        place = path_(now);
    } catch (...) { // a script's mistake must not end the servo
    }
    const double passed = now - state_.time;
    if (!isFinite(place) || !std::isfinite(passed)) {
        state_.velocity = {};
        state_.fault    = DeviceFault::kinematics;
        ++state_.missed;
        return state_;
    }
    if (state_.sequence > 0 && passed > 0) state_.velocity = (place - state_.position) / passed;
    state_.position = place;
    state_.inBox    = glm::length(place) <= info_.workspaceRadius;
    state_.time     = now;
    state_.missed   = 0;
    state_.fault    = isFinite(force.newtons()) ? DeviceFault::none : DeviceFault::badForce;
    ++state_.sequence;
    return state_;
}

} // namespace palp
