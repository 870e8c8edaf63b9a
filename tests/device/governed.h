#pragma once
#include <limits>

#include "engine/force/governor.h"

namespace palp {

/// A force as a device takes it: that of a governor that has engaged with nothing, then grew to it.
/// \param newtons  [N] of at most 6 N, the governor's limit
[[nodiscard]] inline GovernedForce governed(const glm::dvec3& newtons)
{
    ForceGovernor governor;
    GovernorInput in;
    in.homed = in.inBox = true;
    in.dt               = 1e-3;
    for (int n = 0; n < 1600; ++n) { // 10 ticks of calm, then 1.5 s
        governor.step(in);
    }
    in.force = newtons;
    for (int n = 0; n < 10; ++n) { // 1 N a tick
        governor.step(in);
    }
    return governor.force();
}

/// What no governor lets through: a force that is not finite, here through a frame that is none.
[[nodiscard]] inline GovernedForce notFinite()
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return GovernedForce{}.rotated({nan, nan, nan, nan});
}

} // namespace palp
