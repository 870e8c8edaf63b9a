#include "engine/program/hand_source.h"

#include <chrono>
#include <iostream>

#include "device/falcon/falcon_firmware.h"
#include "device/falcon/libusb_link.h"
#include "device/hid/hid_bridge.h"
#include "device/hid/hidapi_system.h"
#include "device/hid/space_mouse.h"
#include "device/hid/space_mouse_report.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/core/real_time.h"
#include "engine/session/hand_device.h"
#include "engine/session/held_falcon.h"

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

/// A scripted hand or one from a file, alone or holding something that forces move.
void script(HandSource& source, HandOptions options, const Scene& scene, const PointCloud& cloud,
            const NeighbourIndex& index)
{
    const bool falcon = options.hand == "falcon-emulator";
    if (falcon || options.hand == "arm") {
        options.hand = "scan";
        if (options.grip.empty()) options.grip = "300 N/m";
    }
    source.path = std::make_unique<const HandPath>(pathFor(options, scene, cloud, index));
    if (options.grip.empty()) {
        source.device = std::make_unique<HandDevice>(*source.path);
        return;
    }
    const glm::dvec3 start = source.path->position(source.path->begin());
    source.frame           = falcon ? deviceFrame(start, handPlace(scene, cloud, index).outward) : DeviceFrame{start};
    const HoldingHand hand{*source.path, gripOf(options.grip), source.frame};
    if (falcon)
        source.device = std::make_unique<HeldFalcon>(hand);
    else
        source.device = std::make_unique<HeldArm>(hand);
}

std::unique_ptr<HapticDevice> falconFor(const HandOptions& options)
{
    FalconDeviceSettings settings;
    if (const auto image = falconFirmwarePath(options.firmware); !image.empty())
        settings.firmware = readFirmware(image);
    settings.loop.countsPerTorque = options.countsPerTorque;
    return std::make_unique<FalconDevice>([] { return openFalcon(); }, settings);
}

/// The first HID device of that kind.
std::unique_ptr<HapticDevice> hidFor(const std::string& name, HidSystem& hid)
{
    const bool bridge = name == "bridge";
    for (const HidListing& listing : hid.list()) {
        if (bridge && isBridge(listing)) return std::make_unique<HidBridgeDevice>(hid, listing);
        if (!bridge && spaceMouseModel(listing)) return std::make_unique<SpaceMouse>(hid, listing);
    }
    throw Error("--hand " + name + ": none is plugged in, by " + hidSupport() +
                "; palpate devices tells what there is");
}

/// A device that somebody holds: the middle of its workspace is where the scene's hand starts.
void hold(HandSource& source, const HandOptions& options, const Scene& scene, const PointCloud& cloud,
          const NeighbourIndex& index)
{
    const HandPlace place = handPlace(scene, cloud, index);
    source.frame          = deviceFrame(place.point + scene.startHeight * place.outward, place.outward);
    if (options.hand == "falcon") {
        source.device = falconFor(options);
        return;
    }
    source.hid    = std::make_unique<HidapiSystem>();
    source.device = hidFor(options.hand, *source.hid);
}

} // namespace

HandSource handFor(const HandOptions& options, const Scene& scene, const PointCloud& cloud, const NeighbourIndex& index)
{
    if (options.hand == "mouse")
        throw Error("--hand mouse: the mouse needs a window, which this command has not; try scan, or --hand arm");
    HandSource source;
    const bool held = options.hand == "falcon" || options.hand == "bridge" || options.hand == "spacemouse";
    if (held && !options.grip.empty())
        throw Error("--arm: a person holds the " + options.hand + "; leave one of the two out");
    if (held)
        hold(source, options, scene, cloud, index);
    else
        script(source, options, scene, cloud, index);
    source.device->open();
    return source;
}

void waitForHoming(HapticDevice& device, const std::atomic<bool>& stop)
{
    if (!device.info().needsHoming || device.info().isSimulation) return;
    const auto start = std::chrono::steady_clock::now();
    Metronome  metronome{std::chrono::milliseconds(1)};
    bool       told = false;
    device.home();
    for (;;) {
        const double      now   = std::chrono::duration<double>(metronome.wait() - start).count();
        const HapticState state = device.exchange(GovernedForce(), now);
        if (state.homed) break;
        if (stop) throw Error("homing was given up; no force flows before it");
        constexpr double kPatience = 1; // [s] for the first answers
        if (now > kPatience && state.fault != DeviceFault::none)
            throw Error(device.info().model + ": lost while it was to be homed (" + name(state.fault) +
                        "); palpate doctor may tell why");
        if (now > kPatience && !told) {
            std::cerr << "palpate: home the " << device.info().model
                      << ": pull the grip all the way out, then push it all the way in; its red light goes out\n";
            told = true;
        }
    }
    if (told) std::cerr << "palpate: homed\n";
}

} // namespace palp
