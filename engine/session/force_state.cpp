#include "engine/session/force_state.h"

#include "engine/force/governor.h"
#include "engine/session/servo.h"

namespace palp {

ForceState forceState(const TickRecord& record) noexcept
{
    const auto did = [&](GovernorAction action) { return (record.actions & static_cast<std::uint32_t>(action)) != 0; };
    const auto device = static_cast<DeviceFault>(record.device & 0xFFU);
    if (isFinal(device)) return ForceState::deviceLost;
    if (static_cast<GovernorFault>(record.faults & 0xFFU) != GovernorFault::none) return ForceState::stopped;
    if (device != DeviceFault::none) return ForceState::deviceFaulty;
    if (did(GovernorAction::lettingGo)) return ForceState::programStops;
    if (did(GovernorAction::notHomed)) return ForceState::notHomed;
    if (did(GovernorAction::clutched)) return ForceState::clutched;
    if (did(GovernorAction::outsideBox)) return ForceState::outOfBox;
    if ((record.faults & static_cast<std::uint32_t>(SessionFlag::oldTable)) != 0) return ForceState::plateSilent;
    if (did(GovernorAction::waiting) || did(GovernorAction::releasing)) return ForceState::waits;
    return did(GovernorAction::engaging) ? ForceState::comesOn : ForceState::flows;
}

std::string_view meaningOf(DeviceFault fault) noexcept
{
    switch (fault) {
    case DeviceFault::none:
        return "";
    case DeviceFault::closed:
        return "it is not open";
    case DeviceFault::unplugged:
        return "it went away";
    case DeviceFault::silent:
        return "it does not answer; see its cable and its power";
    case DeviceFault::garbled:
        return "its answers cannot be understood; see its cable";
    case DeviceFault::kinematics:
        return "it reports a place that its arm cannot reach";
    case DeviceFault::ownWatchdog:
        return "it stopped by itself";
    case DeviceFault::badForce:
        return "the force was no number";
    case DeviceFault::startingUp:
        return "it is being opened";
    case DeviceFault::hostTooSlow:
        return "this program was too slow for it";
    case DeviceFault::linkLost:
        return "the link to it broke";
    case DeviceFault::silenced:
        return "nothing was sent to it for 25 ms";
    }
    return "";
}

std::string describeForces(const TickRecord& record, std::string_view words)
{
    const auto        fault = static_cast<DeviceFault>(record.device & 0xFFU);
    const std::string device =
        std::string(name(fault)) + " (" + std::string(words.empty() ? meaningOf(fault) : words) + ")";
    switch (forceState(record)) {
    case ForceState::flows:
        return {};
    case ForceState::comesOn:
        return "the force comes on";
    case ForceState::waits:
        return "no force: lift the hand off the object and hold it still";
    case ForceState::plateSilent:
        return "no force: the plate does not answer";
    case ForceState::outOfBox:
        return "no force: the grip is out of its workspace";
    case ForceState::notHomed:
        return "no force: home the device";
    case ForceState::clutched:
        return "no force: the clutch is held, and the tool stays";
    case ForceState::programStops:
        return "no force: the program stops";
    case ForceState::deviceFaulty:
        return "no force: the device reports " + device;
    case ForceState::stopped:
        return std::string("no force: ") + name(static_cast<GovernorFault>(record.faults & 0xFFU)) +
               "; hold down the device's first button to reset it";
    case ForceState::deviceLost:
        return "no force: the device is lost: " + device + ", the session ends";
    }
    return {};
}

DeviceLight lightOf(ForceState state) noexcept
{
    if (state == ForceState::notHomed) return DeviceLight::red;
    return state == ForceState::flows || state == ForceState::comesOn ? DeviceLight::green : DeviceLight::blue;
}

} // namespace palp
