#include "engine/program/hand_source.h"

#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/session/hand_device.h"
#include "engine/session/held_arm.h"

namespace palp {
namespace {

double metres(const std::string& text, const std::string& option)
{
    const double value = parseQuantity(text, Dimension::length, option);
    if (value > 0) return value;
    throw Error(option + ": expected a length above 0, found \"" + text + "\"");
}

/// "50 mm/s" or "0.05".
double metresPerSecond(std::string text, const std::string& option)
{
    if (text.ends_with("/s")) text.resize(text.size() - 2);
    return metres(text, option);
}

/// Of the thickness: the deflection is at most some tenths more than the hand's depth, so theory holds [1].
constexpr double kDepth = 0.4;

HandPath pathFor(const HandOptions& o, const Scene& scene, const PointCloud& cloud, const NeighbourIndex& index)
{
    const auto motion = motionNamed(o.hand);
    if (!motion) return readHand(o.hand);
    const HandPlace place = handPlace(scene, cloud, index);
    HandScript      script;
    script.motion   = *motion;
    script.speed    = metresPerSecond(o.speed, "--speed");
    script.depth    = o.depth.empty() ? kDepth * scene.patch.material.thickness : metres(o.depth, "--press-depth");
    script.radius   = metres(o.reach, "--reach");
    script.height   = scene.startHeight;
    script.duration = o.seconds;
    return draped(makeHand(script, place), place, cloud, index);
}

/// "150 N/m" or "150".
SimulatedHand gripOf(const std::string& text)
{
    std::string number = text;
    if (const auto unit = number.find("N/m"); unit != std::string::npos) number.erase(unit);
    SimulatedHand hand;
    hand.stiffness = parseQuantity(number, Dimension::none, "--arm");
    if (!(hand.stiffness > 0 && hand.stiffness <= 5000))
        throw Error("--arm: expected the stiffness of a grip, above 0 and up to 5000 N/m (150 is relaxed, 500 firm), "
                    "found \"" +
                    text + "\"");
    hand.damping = 2; // [N s/m] of a relaxed hand; published measurements have 1 to 5
    return hand;
}

} // namespace

HandSource handFor(const HandOptions& options, const Scene& scene, const PointCloud& cloud, const NeighbourIndex& index)
{
    HandSource source;
    source.path = std::make_unique<const HandPath>(pathFor(options, scene, cloud, index));
    if (options.grip.empty()) {
        source.device = std::make_unique<HandDevice>(*source.path);
    } else {
        source.frame.origin = source.path->position(source.path->begin());
        source.device       = std::make_unique<HeldArm>(HoldingHand{*source.path, gripOf(options.grip), source.frame});
    }
    source.device->open();
    return source;
}

} // namespace palp
