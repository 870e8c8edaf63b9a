#include "engine/session/session_hand.h"

#include <algorithm>
#include <filesystem>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "device/hid/hidapi_system.h"
#include "engine/core/contract.h"
#include "engine/core/nearest_name.h"
#include "engine/core/quantity.h"
#include "engine/core/shown_text.h"
#include "engine/session/clutch.h"
#include "engine/session/gripped_arm.h"
#include "engine/session/scripted_hand.h"

namespace palp {
namespace {

/// Share of the thickness [1]: the deflection is at most some tenths more than the hand's depth, so that theory holds.
constexpr double kDepth = 0.4;

/// The default grip of a hand, on a device that only moves when it is gripped.
constexpr SimulatedHand kGrip{.stiffness = 300, .damping = 2};

/// Largest extent of a likely hand, in sizes of the object [1].
constexpr double kWide = 5;

/// Returns the diagonal of the box that the hand stays in [m].
double widthOf(const HandPath& path)
{
    glm::dvec3 low = path.waypoints().front().position, high = low;
    for (const HandPose& s : path.waypoints()) {
        low  = glm::min(low, s.position);
        high = glm::max(high, s.position);
    }
    return glm::length(high - low);
}

HandPath generated(HandMotion motion, const HandChoice& choice, double seconds, const Scene& scene,
                   const SoftObject& object)
{
    const HandPlace place = handPlace(scene, object);
    HandScript      script;
    script.motion   = motion;
    script.speed    = choice.speed;
    script.depth    = choice.depth.value_or(kDepth * scene.material.thickness);
    script.radius   = choice.radius;
    script.height   = scene.startHeight;
    script.duration = seconds;
    return draped(makeHand(script, place), place, object);
}

/// Reads a hand's file. It sets the session's length, unless the user states one.
void readPath(SessionHand& hand, const HandChoice& choice, const SoftObject& object)
{
    hand.path = std::make_unique<const HandPath>(readHand(choice.hand));
    if (!choice.seconds) hand.seconds = hand.path->duration();
    if (const double wide = widthOf(*hand.path), size = object.cloud().bounds().diagonal(); wide > kWide * size)
        hand.warnings.push_back("the hand goes over " + formatQuantity(wide, "m") + " and the object measures " +
                                formatQuantity(size, "m") + ": are its positions metres?");
}

/// Returns the frame of the device. A device that a scripted hand grips begins where the hand does; any other has its
/// middle before the scene's place.
DeviceFrame frameOf(const SessionHand& hand, const Scene& scene, const SoftObject& object)
{
    const glm::dvec3 start = hand.path ? hand.path->position(hand.path->begin()) : glm::dvec3(0);
    const HandPlace  place = handPlace(scene, object);
    return deviceFrame(hand.path ? start : place.point + scene.startHeight * place.outward, place.outward);
}

/// Returns a place just before the surface that is touched, or as far as the scene has the hand begin. An arm hangs
/// down at first, and a person may have it anywhere: inside the object, from which the skin would not let it out.
glm::dvec3 freePlace(const Scene& scene, const SoftObject& object)
{
    constexpr double kClear = 3; // [spacings] at least
    const HandPlace  place  = handPlace(scene, object);
    return place.point + std::max(scene.startHeight, kClear * object.spacing()) * place.outward;
}

void makeDevice(SessionHand& hand, const HandChoice& choice, const Scene& scene, const SoftObject& object)
{
    const DeviceRecord& record = *hand.record;
    if (record.support && !record.support().isBuilt)
        throw Error("--hand " + choice.hand + ": this build of Palpate is " + record.support().library + "; " +
                    record.support().help);
    hand.hid   = std::make_unique<HidapiSystem>();
    hand.frame = frameOf(hand, scene, object);
    if (hand.isHeldByPerson()) hand.from = freePlace(scene, object);
    hand.frame.scale  = scene.workspaceScale;
    hand.frame.clutch = clutchBit(scene);
    DeviceRequest request{.hid      = *hand.hid,
                          .options  = choice.options,
                          .path     = devicePath(choice.hand),
                          .onUpload = choice.onUpload,
                          .cancel   = choice.cancel};
    if (!hand.path) {
        hand.device = record.make(request);
        return;
    }
    const GrippingHand gripping{*hand.path, choice.grip.value_or(kGrip), hand.frame};
    request.hand = &gripping;
    hand.device  = record.make(request);
}

/// Returns what a user should know of the hand before it touches: its scale, its clutch, and what it does not render.
std::vector<std::string> notesOn(const HapticDeviceInfo& info, const Scene& scene, bool isDevice)
{
    std::vector<std::string> notes;
    if (scene.workspaceScale != 1) {
        const double possible = info.maximumStiffness > 0 ? info.maximumStiffness : scene.stiffnessCap;
        notes.push_back("1 mm of the device is " + formatQuantity(scene.workspaceScale * 1e-3, "m") +
                        " of the scene; forces are not scaled, so the device can render at most " +
                        formatQuantity(std::min(scene.stiffnessCap, possible) / scene.workspaceScale, "N/m") +
                        " of the scene");
        if (!isDevice) notes.push_back("this hand is no device, and moves in the metres of the scene");
    }
    if (scene.clutchButton > 0 && isDevice)
        notes.push_back("button " + std::to_string(scene.clutchButton) +
                        " is the clutch: while it is held no force flows and the tool stays where it is");
    if (isDevice && (info.rotates || info.hasGripper))
        notes.push_back(std::string("the device senses ") + (info.rotates ? "how it is turned" : "") +
                        (info.rotates && info.hasGripper ? " and " : "") + (info.hasGripper ? "its grip" : "") +
                        ", which is recorded; torques and the force of a grip stay zero");
    return notes;
}

} // namespace

void demandKnown(const std::string& word, const std::string& what, const std::filesystem::path& folder)
{
    if (deviceNamed(word) || valueNamed<HandMotion>(word)) return;
    std::error_code hidden; // reading it says why
    if (std::filesystem::exists(folder / word, hidden) || hidden) return;
    std::vector<std::string_view> known;
    std::string                   listed;
    const auto                    add = [&](std::string_view name, bool needsWindow) {
        known.push_back(name);
        if (!needsWindow) listed += (listed.empty() ? "" : ", ") + std::string(name);
    };
    for (const auto& motion : namesOf(HandMotion{})) add(motion.name, false);
    for (const DeviceRecord* record : deviceRecords()) add(record->name, record->holder == DeviceHolder::pointer);
    const auto meant = nearestName(word, known);
    throw Error(what + " " + shownPath(word) + ": there is no such hand or file; " +
                (meant ? "did you mean " + std::string(*meant) + "? " : "") + "hands: " + listed +
                ", or the file of a hand's path");
}

void demandGood(const HandChoice& choice)
{
    const DeviceRecord* record = deviceNamed(choice.hand);
    if (record && record->holder == DeviceHolder::pointer)
        throw Error("--hand " + choice.hand + ": it needs a window, which this command does not open; try scan, or " +
                    "--hand " + std::string(kArmRecord.name));
    demandKnown(choice.hand, "--hand");
    demandFitting(choice);
}

void demandFitting(const HandChoice& choice)
{
    demandOptionsOf(choice.hand, choice.options);
    const DeviceRecord* record = deviceNamed(choice.hand);
    if (record && record->holder != DeviceHolder::scriptedHand && choice.grip)
        throw Error("--arm: no scripted hand grips the " + choice.hand + "; omit one of the two");
}

SessionHand openHand(const HandChoice& choice, const Scene& scene, const SoftObject& object)
{
    demandGood(choice);
    SessionHand hand;
    hand.record  = deviceNamed(choice.hand);
    hand.seconds = choice.seconds.value_or(hand.seconds);
    if (!hand.record || hand.record->holder == DeviceHolder::scriptedHand) {
        const auto motion = hand.record ? HandMotion::scan : valueNamed<HandMotion>(choice.hand);
        if (motion)
            hand.path = std::make_unique<const HandPath>(generated(*motion, choice, hand.seconds, scene, object));
        else
            readPath(hand, choice, object);
    }
    if (!hand.record && choice.grip) hand.record = &kArmRecord;
    if (hand.record)
        makeDevice(hand, choice, scene, object);
    else
        hand.device = std::make_unique<ScriptedHand>(*hand.path);
    hand.device->open();
    if (const std::string& note = hand.device->info().note; !note.empty()) hand.warnings.push_back(note);
    hand.notes = notesOn(hand.device->info(), scene, hand.record != nullptr);
    return hand;
}

} // namespace palp
