#include "engine/session/drawn_load.h"

#include <glm/geometric.hpp>

namespace palp {

double drawnLoad(double force, double deflection, const Patch* patch, const Material& material) noexcept
{
    if (!patch || !patch->deformed() || (material.isLinear() && patch->stiffening == 0 && !patch->large)) return force;
    const double most = mostResponse(*patch);
    return most > 0 ? deflection / most : force;
}

double drawnLoad(const TickRecord& record, const Patch* patch, const Material& material) noexcept
{
    return drawnLoad(glm::length(record.force), record.maxDeflection, patch, material);
}

} // namespace palp
