#include "engine/force/energy_tank.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/core/contract.h"

namespace palp {

EnergyTank::EnergyTank(const EnergyTankSettings& settings)
    : settings_(settings), energy_(std::min(settings.start, settings.limit))
{
    const std::pair<const char*, double> all[] = {
        {"limit", settings.limit}, {"start", settings.start}, {"damping", settings.damping}, {"power", settings.power}};
    for (const auto& [what, value] : all)
        if (!(std::isfinite(value) && value >= 0))
            throw Error("energy tank: " + std::string(what) + " must be zero or more, found " + std::to_string(value));
}

EnergyTankOutput EnergyTank::step(const EnergyTankInput& in) noexcept
{
    const double speed = std::abs(in.tangentialSpeed);
    if (!std::isfinite(in.stiffness + in.depth + in.normalSpeed + speed + in.dt + in.drag) || in.stiffness < 0) {
        energy_    = 0;
        stiffness_ = 0;
        return {};
    }

    // Income.
    const double dt     = std::max(in.dt, 0.0);
    const double arm    = std::clamp(in.spareDamping, 0.0, settings_.damping);
    const double income = arm * (in.normalSpeed * in.normalSpeed + speed * speed) + settings_.power;
    energy_             = std::min(settings_.limit, energy_ + income * dt);

    // Cost of the step of stiffness at this depth, less what the hand paid. A fall that pushed nobody along the surface
    // gives its energy back; friction's loss is not credited. Outside all is free.
    EnergyTankOutput out;
    const double     depth = std::max(in.depth, 0.0);
    const double     rise  = depth * depth * (in.stiffness - stiffness_) / 2;
    const double     paid  = stiffness_ * in.drag;
    const double     need  = rise - paid;
    if (need <= 0) {
        energy_    = std::min(settings_.limit, energy_ + std::min(-need, std::max(-rise, 0.0)));
        stiffness_ = in.stiffness;
    } else {
        out.used = std::min(energy_, need);
        energy_ -= out.used;
        const double share = rise > 0 ? std::clamp((paid + out.used) / rise, 0.0, 1.0) : 1;
        stiffness_ += (in.stiffness - stiffness_) * share;
    }
    out.stiffness = stiffness_;
    out.stored    = stiffness_ * depth * depth / 2;
    return out;
}

} // namespace palp
