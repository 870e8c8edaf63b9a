#include "engine/tools/gui/camera_control.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace palp {

void CameraControl::resetView(const HandPlace& place)
{
    const Frame      frame  = Frame::about(place.outward);
    const glm::dvec2 centre = camera_.centre;
    camera_                 = Camera{};
    camera_.centre          = centre;
    camera_.up              = frame.normal;
    camera_.toEye           = glm::normalize(0.75 * frame.normal + 0.25 * frame.east - 0.6 * frame.north);
    camera_.target          = place.point;
    frameObject();
}

void CameraControl::lookFrom(const glm::dvec3& toEye)
{
    camera_.toEye = toEye;
    camera_.up    = std::abs(toEye.z) > 0.5 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    frameObject();
}

void CameraControl::followPointer(const WindowInput& input, bool paints, const std::optional<Hit>& hit)
{
    constexpr double kTurn = 0.006, kZoom = 0.88; // per pixel at scale 1 [rad], per notch [1]
    const double     half = 0.5 * std::max(1, input.size.y);
    if ((input.left && !input.shift && !paints) || (input.middle && paints))
        camera_ = orbited(camera_, glm::dvec2(-input.moved.x, input.moved.y) * (kTurn / input.scale));
    else if (input.right || (input.left && input.shift) || input.middle)
        camera_ = panned(camera_, {input.moved.x / half, -input.moved.y / half});
    if (input.wheel != 0 && !input.touch) camera_ = dollied(camera_, std::pow(kZoom, input.wheel));
    if (input.doubleClick && !paints && hit) camera_.target = hit->point;
}

bool CameraControl::followSpaceMouse()
{
    constexpr double kTurn = 1.5, kPan = 1, kZoom = 1; // at full deflection [rad/s], [half heights/s], [1/s]
    if (!spaceMouse_) return false;
    const auto   now = std::chrono::steady_clock::now();
    const double dt  = std::min(0.1, std::chrono::duration<double>(now - std::exchange(asked_, now)).count()); // [s]
    spaceMouse_->exchange({}, std::chrono::duration<double>(now.time_since_epoch()).count());
    const SpaceMouseAxes axes = spaceMouse_->axes();
    if (glm::length(axes.push) + glm::length(axes.turn) < 0.02) return false;
    camera_ = orbited(camera_, glm::dvec2(-axes.turn.y, axes.turn.x) * (kTurn * dt));
    camera_ = panned(camera_, glm::dvec2(axes.push.x, axes.push.y) * (kPan * dt));
    camera_ = dollied(camera_, std::exp(-axes.push.z * kZoom * dt));
    return true;
}

bool CameraControl::settle(const Bounds& bounds, const PictureArea& area, const glm::ivec2& size, double elapsed,
                           bool jumps)
{
    constexpr double kGlide = 0.08, kLongest = 0.05; // [s] time after which a third of the way is left; longest step
    constexpr double kThere = 1e-3;                  // of half the height: no step is seen [1]
    if (size.x < 1 || size.y < 1) return false;
    const glm::dvec2 wanted = centreOf(area, size), left = wanted - camera_.centre;
    const double     share = 1 - std::exp(-std::min(kLongest, elapsed) / kGlide); // of the way [1]
    camera_.centre         = jumps || glm::length(left) < kThere ? wanted : camera_.centre + share * left;
    const bool frames      = std::exchange(framing_, false);
    if (frames) {
        const double side = std::min(area.size.x, area.size.y) / size.y; // of the height of the picture [1]
        camera_           = framed(camera_, bounds.centre(), 0.5 * bounds.diagonal(), side);
    }
    return frames || left != glm::dvec2(0);
}

} // namespace palp
