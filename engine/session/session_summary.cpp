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
    beyondTable += has(SessionFlag::beyondTable);
    beyondTheory += has(SessionFlag::beyondTheory);
    patchless += has(SessionFlag::noPatch);
    mostForce = std::max(mostForce, glm::length(record.force));
    if (record.normal == glm::dvec3(0)) return;
    ++contactTicks;
    mostDepth = std::max(mostDepth, glm::dot(record.proxy - record.hip, record.normal));
    if (!(record.compliance > 0)) return;
    const bool first = mostCompliance == 0;
    leastCompliance  = first ? record.compliance : std::min(leastCompliance, record.compliance);
    mostCompliance   = std::max(mostCompliance, record.compliance);
}

} // namespace palp
