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
    const std::pair<const char*, double> all[] = {{"limit", settings.limit},
                                                  {"start", settings.start},
                                                  {"damping", settings.damping},
                                                  {"power", settings.power},
                                                  {"brake", settings.brake}};
    for (const auto& [what, value] : all)
        if (!(std::isfinite(value) && value >= 0))
            throw Error("energy tank: " + std::string(what) + " must be zero or more, found " + std::to_string(value));
}

EnergyTankOutput EnergyTank::step(const EnergyTankInput& in) noexcept
{
    const double speed = std::abs(in.tangentialSpeed);
    if (!std::isfinite(in.stiffness + in.depth + in.normalSpeed + speed + in.dt) || in.stiffness < 0) {
        energy_    = 0;
        stiffness_ = 0;
        return {};
    }

    // Income.
    const double dt     = std::max(in.dt, 0.0);
    const double arm    = std::clamp(in.spareDamping, 0.0, settings_.damping);
    const double income = arm * (in.normalSpeed * in.normalSpeed + speed * speed) + settings_.power;
    energy_             = std::min(settings_.limit, energy_ + income * dt);

    // Cost of the step of stiffness at this depth. A fall gives the energy back; outside it is free.
    EnergyTankOutput out;
    const double     depth = std::max(in.depth, 0.0);
    const double     need  = depth * depth * (in.stiffness - stiffness_) / 2;
    if (need <= 0) {
        energy_    = std::min(settings_.limit, energy_ - need);
        stiffness_ = in.stiffness;
    } else {
        const double paid = std::min(need, settings_.brake * stiffness_ * depth * speed * dt); // by the hand
        out.used          = std::min(energy_, need - paid);
        out.brake         = paid > 0 ? paid / (speed * dt) : 0;
        energy_ -= out.used;
        stiffness_ += (in.stiffness - stiffness_) * ((paid + out.used) / need);
    }
    out.stiffness = stiffness_;
    out.stored    = stiffness_ * depth * depth / 2;
    return out;
}

} // namespace palp
