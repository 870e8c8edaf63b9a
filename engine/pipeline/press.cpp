#include "engine/pipeline/press.h"

#include <cmath>

namespace palp {
namespace {

/// Returns what lies in series with the plate's own bending: contact and shear [m/N].
double restOf(const Patch& patch) noexcept
{
    return 1 / patch.feltStiffness - 1 / patch.large->tangent.front();
}

/// Returns the depth of the dent where the hand is so deep [m].
double dentAt(const Patch& patch, double depth) noexcept
{
    const double rest = restOf(patch);
    double       low = 0, high = depth;
    for (int n = 0; n < 60; ++n) {
        const double middle                                                 = (low + high) / 2;
        (middle + patch.large->forceAt(middle) * rest < depth ? low : high) = middle;
    }
    return (low + high) / 2;
}

} // namespace

DepthShape depthShapeOf(const Patch& patch) noexcept
{
    if (!patch.large || !(patch.feltStiffness > 0)) return {};
    const double rest = restOf(patch);
    DepthShape   shape{.step = (patch.large->reach() + patch.large->force.back() * rest) / DepthShape::kSteps};
    for (std::size_t n = 0; n < shape.tangents.size(); ++n) {
        const double tangent = patch.large->tangentAt(dentAt(patch, double(n) * shape.step));
        shape.tangents[n]    = tangent > 0 ? 1 / ((1 / tangent + rest) * patch.feltStiffness) : 0;
    }
    return shape;
}

DepthLaw depthLawOf(const Patch& patch) noexcept
{
    return {.stiffness = patch.feltStiffness, .stiffening = patch.stiffening, .shape = depthShapeOf(patch)};
}

Press pressOf(const Patch& patch, const Material& material, double force) noexcept
{
    const DepthLaw law = depthLawOf(patch);
    Press          press{law.depthOf(force), force, law.depthOf(force / (1 - material.relaxation.shares()))};
    if (patch.stiffening > 0) press.load = law.stiffness * press.depth;
    if (patch.large) press.load = dentAt(patch, press.depth) * patch.large->tangent.front();
    return press;
}

double forceToDent(const Patch& patch, double dent) noexcept
{
    const double plate = patch.large->forceAt(dent); // [N]
    return patch.stiffening > 0 ? depthLawOf(patch).force(dent + plate * restOf(patch)) : plate;
}

} // namespace palp
