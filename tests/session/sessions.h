#pragma once
#include <cmath>

#include "engine/session/recording.h"

namespace palp {

/// A record whose every number tells its place.
inline TickRecord recordNumber(int i)
{
    TickRecord s;
    s.time           = i * 1e-3;
    s.hip            = {std::sin(i * 0.01) / 3, i * 1e-5, -0.0};
    s.hipVelocity    = {i * 1e-4, 0, -1e-3};
    s.device         = 1U << 8 | std::uint32_t(i % 3) << 16U;
    s.missed         = i % 4;
    s.answerTime     = i * 1e-3 - 1e-4 / 3;
    s.answerAge      = (i % 3) * 1e-3 / 7;
    s.answers        = std::uint32_t(i);
    s.wanted         = {0, 1e-3, i / 7.0};
    s.orientation    = {0.8, 0, 0.6, i * 1e-6};
    s.actions        = i % 6 == 0 ? 40U : 0U;
    s.stiffness      = 400 + i / 3.0;
    s.tankEnergy     = 1e-3 / (i + 2);
    s.observerEnergy = -1e-4 * (i % 11);
    s.proxy          = {std::sin(i * 0.01) / 7, i * 1e-5, 1e-3};
    s.force          = {0, 0, i / 3.0};
    s.normal         = {0, 0.6, 0.8};
    s.rigidity       = 2e-3 + i * 1e-9;
    s.compliance     = 1.88e-3;
    s.maxDeflection  = 1e-3 / (i + 1);
    s.errorEstimate  = 1e-5;
    s.patchAge       = (i % 17) * 1e-3;
    s.tickTime       = 5e-6;
    s.iterations     = i % 7 - 1;
    s.faults         = i % 5 == 0 ? 0x80000001u : 0;
    s.grip           = i / 900.0;
    return s;
}

inline SessionInfo someInfo()
{
    return {.scene    = parseScene(R"({"cloud": "sample:skin", "thickness": "3 mm"})", "skin.json", "."),
            .versions = {{"palpate", "0.1.0"}},
            .solver   = "host",
            .clock    = SessionClock::virtualTime,
            .command  = "palpate run skin.json --hand press"};
}

} // namespace palp
