#include "engine/session/session_summary.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "engine/session/force_state.h"
#include "engine/session/servo.h"

namespace palp {

void SessionSummary::add(const TickRecord& record) noexcept
{
    const auto has   = [&](SessionFlag flag) { return (record.faults & static_cast<std::uint32_t>(flag)) != 0; };
    const auto found = static_cast<DeviceFault>(record.device & 0xFFU);
    if ((deviceFault == DeviceFault::none && found != DeviceFault::startingUp) || isFinal(found)) deviceFault = found;
    ++ticks;
    tick.add(record.tickTime);
    staleTicks += has(SessionFlag::stalePatch);
    oldTable += has(SessionFlag::oldTable);
    beyondTable += has(SessionFlag::beyondTable);
    beyondTheory += has(SessionFlag::beyondTheory);
    patchless += has(SessionFlag::noPatch);
    mostForce = std::max(mostForce, glm::length(record.force));
    if (record.normal == glm::dvec3(0)) return;
    ++contactTicks;
    const ForceState state = forceState(record);
    comingOn += state == ForceState::comesOn;
    if (state == ForceState::flows) mostWholeForce = std::max(mostWholeForce, glm::length(record.force));
    const double depth = glm::dot(record.proxy - record.hip, record.normal);
    mostDepth          = std::max(mostDepth, depth);
    if (depth > 0 && record.force == glm::dvec3(0)) {
        ++forceless;
        lastForceless = record;
    }
    if (!(record.compliance > 0)) return;
    const bool first = mostCompliance == 0;
    leastCompliance  = first ? record.compliance : std::min(leastCompliance, record.compliance);
    mostCompliance   = std::max(mostCompliance, record.compliance);
}

void SessionSummary::addPatch(bool solved, const std::string& reason)
{
    ++(solved ? patches : failedPatches);
    if (!reason.empty()) why = reason;
    if (patches == 0) whyPatchless = reason;
}

std::string SessionSummary::whyForceless() const
{
    const auto has = [&](SessionFlag flag) { return (lastForceless.faults & static_cast<std::uint32_t>(flag)) != 0; };
    if (forceless == 0) return {};
    const ForceState state = forceState(lastForceless);
    if (state == ForceState::stopped)
        return std::string("the governor stopped the force: ") +
               name(static_cast<GovernorFault>(lastForceless.faults & 0xFFU));
    if (state == ForceState::deviceLost || state == ForceState::deviceFaulty)
        return std::string("the device reported ") + name(static_cast<DeviceFault>(lastForceless.device & 0xFFU));
    if (state == ForceState::notHomed) return "the device was not homed";
    if (state == ForceState::programStops) return "the program was stopped";
    if (state == ForceState::outOfBox) return "the grip was out of the device's workspace";
    if (has(SessionFlag::noPatch)) return whyPatchless.empty() ? "the plate had no answer yet" : whyPatchless;
    if (has(SessionFlag::oldTable))
        return "the plate did not answer for a quarter of a second" + (why.empty() ? why : ": " + why);
    if (has(SessionFlag::governed))
        return "the governor waited: the hand must stay slower than 1.2 m/s, and begin off the object, for 1.5 s";
    return "the computed force was zero";
}

} // namespace palp
