#include "engine/session/session_line.h"

#include <algorithm>
#include <cstdio>

#include <glm/geometric.hpp>

#include "engine/core/quantity.h"
#include "engine/session/force_state.h"

namespace palp {

void showLine(const SessionView& view)
{
    const TickRecord& s      = view.record;
    const bool        stale  = (s.faults & static_cast<std::uint32_t>(SessionFlag::stalePatch)) != 0;
    const std::string forces = describeForces(s, view.words);
    std::fprintf(stderr, "\r%6.1f s  %8s  %8s deep  a tick every %8s  a patch in %8s%s%s\033[K", s.time,
                 formatQuantity(glm::length(s.force), "N").c_str(),
                 formatQuantity(std::max(0.0, glm::dot(s.proxy - s.hip, s.normal)), "m").c_str(),
                 formatQuantity(view.loopPeriod, "s").c_str(), formatQuantity(view.solveTime, "s").c_str(),
                 !forces.empty() ? "  "
                 : stale         ? "  stale"
                                 : "",
                 forces.c_str());
}

void showTime(const SessionView& view, double seconds)
{
    std::fprintf(stderr, "\r%6.1f s of %.0f s  %s\033[K", view.record.time, seconds,
                 describeForces(view.record, view.words).c_str());
}

void clearLine()
{
    std::fprintf(stderr, "\r\033[K");
}

} // namespace palp
