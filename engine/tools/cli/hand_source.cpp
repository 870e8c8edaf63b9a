#include "engine/tools/cli/hand_source.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <iostream>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "device/falcon/falcon_firmware.h"
#include "device/falcon/libusb_link.h"
#include "device/hid/hid_bridge.h"
#include "device/hid/hidapi_system.h"
#include "device/hid/space_mouse.h"
#include "device/hid/space_mouse_report.h"
#include "engine/core/contract.h"
#include "engine/core/nearest_name.h"
#include "engine/core/quantity.h"
#include "engine/core/real_time.h"
#include "engine/session/hand_device.h"
#include "engine/session/held_falcon.h"

namespace palp {
namespace {

double metres(const std::string& text, const std::string& option, double metresPerPlainNumber)
{
    const double value = parseQuantity(text, Dimension::length, option, metresPerPlainNumber);
    if (value > 0) return value;
    throw Error(option + ": expected a length above 0, found \"" + text + "\"");
}

/// "50 mm/s" or "0.05".
double metresPerSecond(const std::string& text, const std::string& option)
{
    std::string length = text;
    if (length.ends_with("/s")) length.resize(length.size() - 2);
    const double value = parseQuantity(length, Dimension::length, option);
    if (value > 0 && value <= HandPath::kFastest) return value;
    throw Error(option + ": expected a speed above 0 and up to " + formatQuantity(HandPath::kFastest, "m/s") +
                ", found \"" + text + "\"");
}

/// Of the thickness: the deflection is at most some tenths more than the hand's depth, so theory holds [1].
constexpr double kDepth = 0.4;

HandPath pathFor(const HandOptions& o, double seconds, const Scene& scene, const SoftObject& object)
{
    const auto motion = valueNamed<HandMotion>(o.hand);
    if (!motion) return readHand(o.hand);
    const HandPlace place = handPlace(scene, object);
    HandScript      script;
    script.motion = *motion;
    script.speed  = metresPerSecond(o.speed, "--speed");
    script.depth =
        o.depth.empty() ? kDepth * scene.material.thickness : metres(o.depth, "--press-depth", o.metresPerPlainNumber);
    script.radius   = metres(o.reach, "--reach", o.metresPerPlainNumber);
    script.height   = scene.startHeight;
    script.duration = seconds;
    return draped(makeHand(script, place), place, object);
}

/// "150 N/m" or "150".
SimulatedHand gripOf(const std::string& text)
{
    std::string number = text;
    if (number.ends_with("N/m")) number.resize(number.size() - 3);
    SimulatedHand hand;
    hand.stiffness = parseQuantity(number, Dimension::none, "--arm (N/m)");
    if (!(hand.stiffness > 0 && hand.stiffness <= 5000))
        throw Error("--arm: expected the stiffness of a grip, above 0 and up to 5000 N/m (150 is relaxed, 500 firm), "
                    "found \"" +
                    text + "\"");
    hand.damping = 2; // [N s/m] of a relaxed hand; published measurements have 1 to 5
    return hand;
}

/// Farther than so many sizes of the object a hand hardly goes [1].
constexpr double kWide = 5;

/// Diagonal of the box that the hand stays in [m].
double widthOf(const HandPath& path)
{
    glm::dvec3 low = path.samples().front().position, high = low;
    for (const HandPose& s : path.samples()) {
        low  = glm::min(low, s.position);
        high = glm::max(high, s.position);
    }
    return glm::length(high - low);
}

/// A scripted hand or one from a file, alone or holding something that forces move.
void script(HandSource& source, HandOptions options, const Scene& scene, const SoftObject& object)
{
    const bool falcon = options.hand == "falcon-emulator";
    if (falcon || options.hand == "arm") {
        options.hand = "scan";
        if (options.grip.empty()) options.grip = "300 N/m";
    }
    source.path = std::make_unique<const HandPath>(pathFor(options, source.seconds, scene, object));
    if (!valueNamed<HandMotion>(options.hand)) {
        if (options.seconds.empty()) source.seconds = source.path->duration();
        if (const double wide = widthOf(*source.path), size = object.cloud().bounds().diagonal(); wide > kWide * size)
            source.warnings.push_back("the hand goes over " + formatQuantity(wide, "m") + " and the object measures " +
                                      formatQuantity(size, "m") + ": are its positions metres?");
    }
    if (options.grip.empty()) {
        source.device = std::make_unique<HandDevice>(*source.path);
        return;
    }
    const glm::dvec3 start = source.path->position(source.path->begin());
    source.frame           = falcon ? deviceFrame(start, handPlace(scene, object).outward) : DeviceFrame{start};
    const HoldingHand hand{*source.path, gripOf(options.grip), source.frame};
    if (falcon) {
        source.device = std::make_unique<HeldFalcon>(hand, HeldFalcon::ready(), options.falcon.settings());
    } else
        source.device = std::make_unique<HeldArm>(hand);
}

/// "falcon@1-2.3": what `palpate devices` calls it, and where it is plugged in if there are several.
struct NamedDevice {
    std::string name, path;

    explicit NamedDevice(const std::string& hand) : name(hand.substr(0, hand.find('@')))
    {
        if (name.size() < hand.size()) path = hand.substr(name.size() + 1);
    }

    [[nodiscard]] bool isHeld() const { return name == "falcon" || name == "bridge" || name == "spacemouse"; }
};

/// The first HID device of that kind, or the one at that path.
std::unique_ptr<HapticDevice> hidFor(const NamedDevice& wanted, HidSystem& hid)
{
    const bool bridge = wanted.name == "bridge";
    for (const HidListing& listing : hid.list()) {
        if (!wanted.path.empty() && listing.path != wanted.path) continue;
        if (bridge && isBridge(listing)) return std::make_unique<HidBridgeDevice>(hid, listing);
        if (!bridge && spaceMouseModel(listing)) return std::make_unique<SpaceMouse>(hid, listing);
    }
    throw Error("--hand " + wanted.name + ": none is plugged in" + (wanted.path.empty() ? "" : " at " + wanted.path) +
                "; palpate devices tells what there is");
}

/// A device that somebody holds: the middle of its workspace is where the scene's hand starts.
void hold(HandSource& source, const HandOptions& options, const Scene& scene, const SoftObject& object)
{
    const HandPlace place = handPlace(scene, object);
    source.frame          = deviceFrame(place.point + scene.startHeight * place.outward, place.outward);
    const NamedDevice wanted(options.hand);
    if (wanted.name == "falcon") {
        source.device = falconFor(options.falcon, wanted.path);
        return;
    }
    if (!hasHidSupport()) throw Error("--hand " + options.hand + ": this palpate is " + hidSupport());
    source.hid    = std::make_unique<HidapiSystem>();
    source.device = hidFor(wanted, *source.hid);
}

/// Options that would do nothing.
void refuseOptionsOfAFalcon(const HandOptions& options)
{
    const bool real = NamedDevice(options.hand).name == "falcon", any = real || options.hand == "falcon-emulator";
    if (!any && (options.falcon.countsPerTorque || options.falcon.eventCharacter))
        throw Error("--falcon-counts and --falcon-event-character are of --hand falcon, found --hand " + options.hand);
    if (!real && !options.falcon.firmware.empty())
        throw Error("--falcon-firmware is of --hand falcon, found --hand " + options.hand);
}

/// A word that is neither a file nor a hand was meant for one of these.
void refuseSlips(const std::string& word)
{
    static constexpr std::array<std::string_view, 9> kKnown{
        "press", "circle", "scan", "falcon", "falcon-emulator", "arm", "bridge", "spacemouse", "mouse"};
    if (std::ranges::find(kKnown, word) != kKnown.end() || NamedDevice(word).isHeld() || std::filesystem::exists(word))
        return;
    if (const auto meant = nearestName(word, kKnown))
        throw Error("--hand " + word + ": there is no such hand or file; did you mean " + std::string(*meant) + "?");
}

/// What the words alone tell.
void demandNamed(const HandOptions& options)
{
    if (options.hand == "mouse")
        throw Error("--hand mouse: the mouse needs a window, which this command has not; try scan, or --hand arm");
    refuseSlips(options.hand);
    refuseOptionsOfAFalcon(options);
    if (NamedDevice(options.hand).isHeld() && !options.grip.empty())
        throw Error("--arm: a person holds the " + options.hand + "; leave one of the two out");
}

} // namespace

double secondsOf(const std::string& text)
{
    constexpr double kMost  = 86400; // [s] a day
    std::string      number = text;
    if (number.ends_with("s")) number.resize(number.size() - 1);
    const double seconds = parseQuantity(number, Dimension::none, "--seconds");
    if (seconds > 0 && seconds <= kMost) return seconds;
    throw Error("--seconds: expected a time above 0 and up to 86400 s, found \"" + text + "\"");
}

FalconDeviceSettings FalconOptions::settings() const
{
    FalconDeviceSettings settings;
    settings.loop.countsPerTorque = countsPerTorque.value_or(FalconMotors::kCountsPerTorque);
    settings.start.eventCharacter = eventCharacter;
    return settings;
}

void addFalconOptions(CLI::App& command, FalconOptions& options)
{
    const CLI::Validator inRange{[](const std::string& text) -> std::string {
                                     const double counts = parseQuantity(text, Dimension::none, "--falcon-counts");
                                     if (counts >= 2000 && counts <= 10000) return {};
                                     return "expected 2000 to 10000, found " + text;
                                 },
                                 "[2000 - 10000]"};
    command.add_option("--falcon-firmware", options.firmware,
                       "image that a Falcon needs after it was plugged in [FALCON_FIRMWARE]");
    command
        .add_option("--falcon-counts", options.countsPerTorque,
                    "counts per N m of a Falcon's motors, see palpate calibrate [4200]")
        ->check(inRange);
    command.add_flag("--falcon-event-character", options.eventCharacter,
                     "ask the Falcon's bridge to pass on each answer at once; nobody has tried it on a device yet");
}

void demandGood(const HandOptions& options)
{
    demandNamed(options);
    if (!options.seconds.empty()) static_cast<void>(secondsOf(options.seconds));
    if (!options.grip.empty()) static_cast<void>(gripOf(options.grip));
    const bool simulated = options.hand == "arm" || options.hand == "falcon-emulator";
    if (!simulated && !NamedDevice(options.hand).isHeld() && !valueNamed<HandMotion>(options.hand))
        static_cast<void>(readHand(options.hand));
}

HandSource handFor(const HandOptions& options, const Scene& scene, const SoftObject& object)
{
    demandNamed(options);
    HandSource source;
    if (!options.seconds.empty()) source.seconds = secondsOf(options.seconds);
    const bool held = NamedDevice(options.hand).isHeld();
    if (held)
        hold(source, options, scene, object);
    else
        script(source, options, scene, object);
    source.device->open();
    return source;
}

std::unique_ptr<HapticDevice> falconFor(const FalconOptions& options, const std::string& path)
{
    FalconDeviceSettings settings = options.settings();
    settings.path                 = path;
    if (const auto image = falconFirmwarePath(options.firmware); !image.empty())
        settings.firmware = readFirmware(image);
    return std::make_unique<FalconDevice>([path] { return openFalcon(path); }, settings);
}

bool waitForHoming(HapticDevice& device, const std::atomic<bool>& stop,
                   const std::function<void(const std::string&)>& tell)
{
    if (!device.info().needsHoming || device.info().isSimulation) return false;
    const auto start = std::chrono::steady_clock::now();
    Metronome  metronome{std::chrono::milliseconds(1)};
    bool       told = false;
    double     well = 0; // [s] when it was last without a fault
    device.home();
    for (;;) {
        const double      now   = std::chrono::duration<double>(metronome.wait() - start).count();
        const HapticState state = device.exchange(GovernedForce(), now);
        if (state.homed) break;
        if (stop) throw Error("homing was given up; no force flows before it");
        constexpr double kPatience = 1; // [s] for the first answers, and for a fault that may pass
        if (state.fault == DeviceFault::none) well = now;
        if (now > well + kPatience)
            throw Error(device.info().model + ": lost while it was to be homed (" + name(state.fault) +
                        "); palpate doctor may tell why");
        if (now > kPatience && !told) {
            tell("home the " + device.info().model +
                 ": pull the grip all the way out, then push it all the way in; its red light goes out");
            told = true;
        }
    }
    return told;
}

void waitForHoming(HapticDevice& device, const std::atomic<bool>& stop)
{
    const auto tell = [](const std::string& sentence) { std::cerr << "palpate: " << sentence << "\n"; };
    if (waitForHoming(device, stop, tell)) tell("homed");
}

} // namespace palp
