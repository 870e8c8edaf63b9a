#include "engine/tools/gui/pointer_hand.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace palp {

PointerHand::PointerHand(const Hit& start, double height, const Bounds& bounds)
    : height_(height), reach_(std::clamp(2 * bounds.diagonal() + 4 * height, 2e-3, 9.0)), origin_(bounds.centre())
{
    begin(start);
}

void PointerHand::begin(const Hit& at)
{
    at_       = at;
    pressing_ = marking_ = false;
    target_              = above(at, height_);
    MouseDeviceSettings settings;
    settings.reach = reach_;
    settings.rest  = above(at, height_) - origin_;
    device_        = std::make_unique<MouseDevice>(settings);
    device_->open();
}

bool PointerHand::press(const Hit& at, double depth)
{
    // A hand that glides over the surface turns little from picture to picture, and a hovering one may move anywhere
    // on its own side of the object.
    const double turned = glm::dot(at.outward, at_.outward);
    const double above_ = glm::dot(above(at_, height_) - at.point, at.outward); // where it hovers, over that place [m]
    if (!(turned > 0.5 && above_ > 0)) return false;
    at_       = at;
    pressing_ = true;
    target(above(at, -depth));
    return true;
}

void PointerHand::target(const glm::dvec3& place)
{
    constexpr std::uint32_t kButton = 2; // the second one; the first is the operator's
    target_                         = place;
    device_->target(place - origin_, marking_ ? kButton : 0);
}

void PointerHand::mark(bool down)
{
    if (down == marking_) return;
    marking_ = down;
    target(target_);
}

void PointerHand::release()
{
    if (!pressing_) return;
    pressing_ = false;
    target(above(at_, height_));
}

} // namespace palp
