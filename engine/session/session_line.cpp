#include "engine/session/session_line.h"

#include <cstdio>

#include <glm/geometric.hpp>

#include "engine/core/quantity.h"

namespace palp {

void showLine(const SessionView& view)
{
    const TickRecord& s     = view.record;
    const auto        fault = static_cast<GovernorFault>(s.faults & 0xFFU);
    const bool        old   = (s.faults & static_cast<std::uint32_t>(SessionFlag::oldTable)) != 0;
    const bool        stale = (s.faults & static_cast<std::uint32_t>(SessionFlag::stalePatch)) != 0;
    std::fprintf(stderr, "\r%6.1f s  %8s  %8s deep  a tick every %8s  a patch in %8s%s%s%s\033[K", s.time,
                 formatQuantity(glm::length(s.force), "N").c_str(),
                 formatQuantity(glm::length(s.proxy - s.hip), "m").c_str(),
                 formatQuantity(view.loopPeriod, "s").c_str(), formatQuantity(view.solveTime, "s").c_str(),
                 old     ? "  no force: the plate does not answer"
                 : stale ? "  stale"
                         : "",
                 fault == GovernorFault::none ? "" : "  no force, button 0 resets: ",
                 fault == GovernorFault::none ? "" : name(fault));
}

void clearLine()
{
    std::fprintf(stderr, "\r\033[K");
}

} // namespace palp
