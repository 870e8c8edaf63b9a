#include "engine/session/session_summary.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "engine/session/servo.h"

namespace palp {

void SessionSummary::add(const TickRecord& record) noexcept
{
    const auto has   = [&](SessionFlag flag) { return (record.faults & static_cast<std::uint32_t>(flag)) != 0; };
    const auto state = static_cast<DeviceFault>(record.device & 0xFFU);
    if (deviceFault == DeviceFault::none && state != DeviceFault::startingUp) deviceFault = state;
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
    const double depth = glm::dot(record.proxy - record.hip, record.normal);
    mostDepth          = std::max(mostDepth, depth);
    if (depth > 0 && record.force == glm::dvec3(0)) {
        ++forceless;
        forcelessFaults = record.faults;
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
    const auto has = [&](SessionFlag flag) { return (forcelessFaults & static_cast<std::uint32_t>(flag)) != 0; };
    if (forceless == 0) return {};
    if (const auto stopped = static_cast<GovernorFault>(forcelessFaults & 0xFFU); stopped != GovernorFault::none)
        return std::string("the governor stopped the force: ") + name(stopped);
    if (has(SessionFlag::noPatch)) return whyPatchless.empty() ? "the plate had no answer yet" : whyPatchless;
    if (has(SessionFlag::oldTable))
        return "the plate did not answer for a quarter of a second" + (why.empty() ? why : ": " + why);
    if (has(SessionFlag::governed))
        return "the governor waits: the hand must stay slower than 1.2 m/s for 1.5 s, and the device must be homed and "
               "in its workspace";
    return "the computed force was zero";
}

} // namespace palp
