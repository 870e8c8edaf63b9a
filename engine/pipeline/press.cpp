#include "engine/pipeline/press.h"

namespace palp {

DepthLaw depthLawOf(const Patch& patch) noexcept
{
    return {patch.feltStiffness, patch.stiffening};
}

Press pressOf(const Patch& patch, const Material& material, double force) noexcept
{
    const DepthLaw law = depthLawOf(patch);
    Press          press{law.depthOf(force), force, law.depthOf(force / (1 - material.relaxation.shares()))};
    if (patch.stiffening > 0) press.load = law.stiffness * press.depth;
    return press;
}

} // namespace palp
