#pragma once
#include "engine/pipeline/patch.h"

namespace palp {

/// Returns the force that presses a patch's dent as deep as told [N], by its law of large deflections and, in series,
/// what of its compliance is not bending and stretching.
inline double forceAt(const Patch& patch, double depth)
{
    const double shear = patch.compliance - 1 / patch.large->tangent.front();
    double       low = 0, high = 2 * patch.large->force.back();
    for (int n = 0; n < 60; ++n) {
        const double force                                                 = (low + high) / 2;
        (patch.large->depthOf(force) + force * shear < depth ? low : high) = force;
    }
    return low;
}

} // namespace palp
