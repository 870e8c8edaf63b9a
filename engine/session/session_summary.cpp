#include "engine/session/session_summary.h"

#include <algorithm>

#include <glm/geometric.hpp>

#include "engine/session/servo.h"

namespace palp {

void SessionSummary::add(const TickRecord& sample) noexcept
{
    const auto has   = [&](SessionFlag flag) { return (sample.faults & static_cast<std::uint32_t>(flag)) != 0; };
    const auto state = static_cast<DeviceFault>(sample.device & 0xFFU);
    if (deviceFault == DeviceFault::none && state != DeviceFault::startingUp) deviceFault = state;
    ++ticks;
    tick.add(sample.tickTime);
    staleTicks += has(SessionFlag::stalePatch);
    beyondTable += has(SessionFlag::beyondTable);
    beyondTheory += has(SessionFlag::beyondTheory);
    patchless += has(SessionFlag::noPatch);
    mostForce = std::max(mostForce, glm::length(sample.force));
    if (sample.normal == glm::dvec3(0)) return;
    ++contactTicks;
    mostDepth = std::max(mostDepth, glm::dot(sample.proxy - sample.hip, sample.normal));
    if (!(sample.compliance > 0)) return;
    const bool first = mostCompliance == 0;
    leastCompliance  = first ? sample.compliance : std::min(leastCompliance, sample.compliance);
    mostCompliance   = std::max(mostCompliance, sample.compliance);
}

} // namespace palp
