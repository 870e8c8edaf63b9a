#include "engine/session/drawn_load.h"

#include <glm/geometric.hpp>

namespace palp {

double drawnLoad(const TickRecord& record, const Patch* patch, const Material& material) noexcept
{
    const double force = glm::length(record.force);
    if (!patch || !patch->deformed() || (material.isLinear() && patch->stiffening == 0 && !patch->large)) return force;
    const double most = mostResponse(*patch);
    return most > 0 ? record.maxDeflection / most : force;
}

} // namespace palp
