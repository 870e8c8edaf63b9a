#include "engine/tools/gui/pointer_touch.h"

#include <algorithm>
#include <utility>

#include "engine/core/quantity.h"

namespace palp {

PointerTouch::PointerTouch(const Stage& stage, Notices& notices)
    : stage_(stage), notices_(notices), hand_(Hit{stage.place().point, stage.place().outward},
                                              stage.scene().startHeight, stage.painted().cloud().bounds())
{
}

PointerTouch::Outcome PointerTouch::follow(const WindowInput& input, const std::optional<Hit>& hit, double& depth)
{
    constexpr auto   kHeld = std::chrono::milliseconds(60); // three times the time that declares
    constexpr double kStep = 0.05, kMost = 3; // of the thickness: a notch, and the largest depth and height [1]
    if (Clock::now() - declared_ > kHeld) hand_.mark(false);
    if (!input.touch) awaitsRelease_ = false;
    if (!input.touch || input.panelsTakeKeys || awaitsRelease_) {
        hand_.release();
        return Outcome::touched;
    }
    if (input.panelsTakePointer) return Outcome::touched;       // over a panel the hand stays in place
    const double thickness = stage_.scene().material.thickness; // [m]
    depth                  = std::clamp(depth - kStep * thickness * input.wheel, -kMost * thickness, kMost * thickness);
    if (input.wheel != 0) notices_.say("depth " + formatQuantity(depth, "m"));
    if (!hit || hand_.press(*hit, depth) || beginAt_) return Outcome::touched;
    beginAt_ = *hit;
    return Outcome::mustBeginAnew;
}

void PointerTouch::letGo()
{
    awaitsRelease_ = true;
    hand_.release();
}

void PointerTouch::declare()
{
    declared_ = Clock::now();
    hand_.mark(true);
    notices_.say(hand_.pressing() ? "declared: there is a nodule here"
                                  : "nothing is touched: hold Space over the place");
}

void PointerTouch::begin()
{
    // The side that a hand is on follows from the direction it comes from.
    hand_.begin(std::exchange(beginAt_, std::nullopt).value_or(hand_.at()));
}

} // namespace palp
