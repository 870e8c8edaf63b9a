#include "device/hid/space_mouse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "device/detail/setting_range.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double       kFullDeflection = 350;   // [counts] for every model, from PySpaceMouse's table
constexpr double       kWait           = 10e-3; // [s] for a report: the longest delay of a light and of close()
constexpr double       kLongest        = 0.1;   // [s] a later tick moves the point no further than after this time
constexpr std::uint8_t kLight          = 4;     // number of the output report; then 1 or 0
constexpr int          kMostReports    = 64;    // per pass, so that it returns even when flooded

/// Its z points down and its y to the user: a turn about x by 90 degrees brings y up.
glm::dvec3 upright(const std::array<std::int16_t, 6>& axes, std::size_t first)
{
    const glm::dvec3 turned(axes[first], -axes[first + 2], axes[first + 1]);
    return glm::clamp(turned / kFullDeflection, -1.0, 1.0);
}

double beyond(double deflection, double deadZone)
{
    const double rest = std::max(0.0, std::abs(deflection) - deadZone);
    return std::copysign(rest / (1 - deadZone), deflection);
}

} // namespace

SpaceMouse::SpaceMouse(HidSystem& system, const HidListing& listing, const SpaceMouseSettings& settings)
    : system_(system), listing_(listing), settings_(settings)
{
    demandRange("SpaceMouse", "speed", settings.speed, 0, 10);
    demandRange("SpaceMouse", "deadZone", settings.deadZone, 0, 0.9);
    demandRange("SpaceMouse", "reach", settings.reach, 1e-3, 10);
    demandRange("SpaceMouse", "stale", settings.stale, 0.02, 60);
    const SpaceMouseModel* model = spaceMouseModel(listing);
    if (!model) throw Error(listing.path + " is no SpaceMouse: see \"palpate devices\"");
    info_.model           = model->name;
    info_.path            = listing.path;
    info_.serial          = listing.serial;
    info_.workspaceRadius = settings.reach;
    info_.buttons         = model->buttons;
}

SpaceMouse::~SpaceMouse()
{
    close();
}

void SpaceMouse::open()
{
    if (port_) return;
    port_        = system_.open(listing_.path);
    seen_        = {};
    state_       = {};
    lastReports_ = 0;
    lit_         = true; // shows which device is in use
    isLit_       = false;
    state_.homed = state_.inBox = true;
    state_.fault                = DeviceFault::none;
    inbox_.draft()              = seen_; // reports of an earlier opening are discarded
    inbox_.publish();
    if (settings_.pace == HidPace::thread)
        thread_ = std::jthread([this](const std::stop_token& stop) {
            while (!stop.stop_requested() && readAndWrite(kWait)) {
            }
        });
}

void SpaceMouse::close() noexcept
{
    if (thread_.joinable()) {
        thread_.request_stop();
        thread_.join();
    }
    if (port_ && !seen_.lost) {
        lit_ = false;
        readAndWrite(0);
    }
    port_.reset();
    state_.fault    = DeviceFault::closed;
    state_.velocity = {};
}

/// Writes the lights, then reads every waiting report.
/// \return false if the device is gone
bool SpaceMouse::readAndWrite(double wait) noexcept
{
    if (const bool lit = lit_; lit != isLit_) {
        isLit_ = lit;
        try {
            port_->write(std::array<std::uint8_t, 2>{kLight, std::uint8_t(lit)});
        } catch (const HidLost&) { // models without a light refuse; reading notices a device that is gone
        }
    }
    try {
        std::array<std::uint8_t, 64> report{};
        for (int n = 0; n < kMostReports; ++n) {
            const std::size_t size = port_->read(report, n == 0 ? wait : 0);
            if (size == 0) break;
            seen_.reports += takeSpaceMouseReport(std::span(report).first(size), seen_.counts);
        }
    } catch (const HidLost&) {
        seen_.lost = true;
    }
    inbox_.draft() = seen_;
    inbox_.publish();
    return !seen_.lost;
}

HapticState SpaceMouse::read(double now) noexcept
{
    if (!port_ || state_.fault == DeviceFault::unplugged) return state_;
    if (settings_.pace == HidPace::caller) readAndWrite(0);
    if (state_.sequence > 0 && now < state_.time) lastReport_ += now - state_.time; // the servo's clock starts anew
    inbox_.take();
    const Reported seen = inbox_.held() ? *inbox_.held() : Reported{};
    if (seen.reports != lastReports_) {
        lastReports_ = seen.reports;
        lastReport_  = now;
    }
    SpaceMouseAxes axes{upright(seen.counts.axes, 0), upright(seen.counts.axes, 3), seen.counts.buttons};
    if (seen.lost || !(now - lastReport_ <= settings_.stale)) axes.push = axes.turn = {}; // not confirmed any more
    camera_.draft() = axes;
    camera_.publish();
    move(axes, now);
    if (seen.lost) {
        state_.fault   = DeviceFault::unplugged;
        state_.buttons = 0;
    }
    return state_;
}

void SpaceMouse::move(const SpaceMouseAxes& axes, double now) noexcept
{
    const double     passed = state_.sequence == 0 ? 0 : std::clamp(now - state_.time, 0.0, kLongest);
    const glm::dvec3 before = state_.position;
    glm::dvec3       speed{};
    for (int axis = 0; axis < 3; ++axis) speed[axis] = settings_.speed * beyond(axes.push[axis], settings_.deadZone);
    if (!std::isfinite(passed)) return; // the clock is unusable: nothing moves
    state_.position += speed * passed;
    const double out = glm::length(state_.position);
    if (out > settings_.reach) state_.position *= settings_.reach / out;
    state_.velocity = passed > 0 ? (state_.position - before) / passed : glm::dvec3(0);
    state_.buttons  = axes.buttons;
    state_.time     = now;
    ++state_.sequence;
}

SpaceMouseAxes SpaceMouse::axes() noexcept
{
    camera_.take();
    return camera_.held() ? *camera_.held() : SpaceMouseAxes{};
}

} // namespace palp
