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

namespace {

/// Returns what goes into a contact of this depth when its law changes [J].
double riseOf(const DepthLaw& from, const DepthLaw& to, double depth) noexcept
{
    if (from.isSpring() && to.isSpring()) return depth * depth * (to.stiffness - from.stiffness) / 2;
    return to.energy(depth) - from.energy(depth);
}

/// Returns the law a share of the way from one to another. A lower cap, which is the loop's, holds at once.
DepthLaw between(const DepthLaw& from, const DepthLaw& to, double share) noexcept
{
    DepthLaw law{from.stiffness + (to.stiffness - from.stiffness) * share, to.stiffening, to.steepest};
    if (from.isSpring() && to.isSpring()) return law;
    law.shape      = between(from.shape, to.shape, share);
    law.stiffening = from.stiffening + (to.stiffening - from.stiffening) * share;
    if (to.steepest > from.steepest) law.steepest = from.steepest + (to.steepest - from.steepest) * share;
    law.stiffness = std::min(law.stiffness, law.steepest);
    return law;
}

} // namespace

/// Goes so far towards the wanted law that at most `share` of the rise of energy is taken.
void EnergyTank::takePartOf(const DepthLaw& wanted, double depth, double share) noexcept
{
    const DepthLaw from = law_;
    law_                = between(from, wanted, share); // exact where the energy is linear in what changes
    const double most   = from.energy(depth) + share * riseOf(from, wanted, depth);
    if (wanted.isSpring() && from.isSpring()) return;
    constexpr int kHalvings = 30; // of the share: 1e-9 of it
    double        enough = 0, tooMuch = share;
    if (law_.energy(depth) <= most) return;
    for (int n = 0; n < kHalvings; ++n) {
        const double middle                                                      = (enough + tooMuch) / 2;
        (between(from, wanted, middle).energy(depth) <= most ? enough : tooMuch) = middle;
    }
    law_ = between(from, wanted, enough);
}

EnergyTankOutput EnergyTank::step(const EnergyTankInput& in) noexcept
{
    const double speed = std::abs(in.tangentialSpeed);
    if (!std::isfinite(in.stiffness + in.depth + in.normalSpeed + speed + in.dt + in.drag + in.stiffening) ||
        !std::isfinite(in.storedShare) || std::isnan(in.spareDamping + in.steepest) || in.stiffness < 0 ||
        in.stiffening < 0) {
        energy_ = 0;
        law_    = {};
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
    const DepthLaw   wanted = DepthLaw::capped(in.stiffness, in.stiffening, in.steepest, in.shape);
    const double     depth  = std::max(in.depth, 0.0);
    const double     rise   = in.storedShare * riseOf(law_, wanted, depth);
    const double     paid   = law_.secant(depth) * in.drag;
    const double     need   = rise - paid;
    if (need <= 0) {
        energy_ = std::min(settings_.limit, energy_ + std::min(-need, std::max(-rise, 0.0)));
        law_    = wanted;
    } else {
        out.used = std::min(energy_, need);
        energy_ -= out.used;
        const double share = rise > 0 ? std::clamp((paid + out.used) / rise, 0.0, 1.0) : 1;
        takePartOf(wanted, depth, share);
    }
    out.law       = law_;
    out.stiffness = law_.stiffness;
    out.stored    = in.storedShare * law_.energy(depth);
    return out;
}

} // namespace palp
