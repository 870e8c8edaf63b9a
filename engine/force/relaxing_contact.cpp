#include "engine/force/relaxing_contact.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace palp {

/// Returns what is stored under a hand of this depth, V [J].
double RelaxingContact::storedAt(const DepthLaw& law, double depth, const Depths& used) const noexcept
{
    double stored = law.energy(depth);
    for (std::size_t n = 0; n < relaxation_.count; ++n)
        stored -= relaxation_.terms[n].share * (law.energy(used[n]) + law.force(used[n]) * (depth - used[n]));
    return std::max(0.0, stored);
}

/// Returns the depth at which nothing presses: a surface that is left alone lies there for now [m].
double RelaxingContact::restingDepth(const DepthLaw& law) const noexcept
{
    double force = 0;
    for (std::size_t n = 0; n < relaxation_.count; ++n) force += relaxation_.terms[n].share * law.force(used_[n]);
    return law.depthOf(force);
}

/// Fades what belongs to the place that is left.
/// \return [J] by which that raised what is stored
double RelaxingContact::fade(const DepthLaw& law, const glm::dvec3& place) noexcept
{
    constexpr double kSamePlace = 0.25e-3; // [m] five encoder steps of a Falcon; the tremor of a hand at rest is 0.1 mm
    if (!placed_) place_ = place;
    placed_           = true;
    const double away = glm::distance(place, place_), moved = away - kSamePlace;
    if (!(moved > 0)) return 0;
    place_ += moved / away * (place - place_);

    const double keep   = std::exp(-moved / fadeLength_);
    const double before = storedAt(law, surface_, used_);
    Depths       faded{};
    for (std::size_t n = 0; n < relaxation_.count; ++n) faded[n] = law.depthOf(keep * law.force(used_[n]));
    double rise = storedAt(law, surface_, faded) - before;
    if (rise > lost_) { // V is convex in the m_i: a part of the way costs at most that part of the rise
        const double part = 1 - (1 - keep) * lost_ / rise;
        for (std::size_t n = 0; n < relaxation_.count; ++n) faded[n] = law.depthOf(part * law.force(used_[n]));
        rise = std::min(lost_, storedAt(law, surface_, faded) - before);
    }
    used_ = faded;
    lost_ -= std::max(0.0, rise);
    if (surface_ > depth_) surface_ = std::max(depth_, restingDepth(law));
    return std::max(0.0, rise);
}

/// Solves a tick in which the elastic force goes evenly from that of the surface to that of the new depth.
///
///     m' = a m + (1 - a) F_0 + (1 - r) (F_1 - F_0)        a = e^{-dt / tau}        r = (1 - a) tau / dt
///
/// so the force F_1 - sum g m' is linear in F_1, and is 0 at one F_1: a hand above its depth is left alone.
void RelaxingContact::relax(const DepthLaw& law, double depth, double dt) noexcept
{
    const double begin = law.force(surface_);
    Depths       kept{}, ramp{};
    double       old = 0, newest = 1;
    for (std::size_t n = 0; n < relaxation_.count; ++n) {
        const auto [share, time] = relaxation_.terms[n];
        const double steps = dt / time, decay = std::exp(-steps);
        ramp[n] = steps > 0 ? -std::expm1(-steps) / steps : 1;
        kept[n] = decay * law.force(used_[n]) + (ramp[n] - decay) * begin;
        old += share * kept[n];
        newest -= share * (1 - ramp[n]);
    }
    const double pressed = law.force(depth), alone = old / newest, end = std::max(pressed, alone);
    const double from = surface_;
    surface_          = end > pressed ? std::max(depth, law.depthOf(end)) : depth;
    for (std::size_t n = 0; n < relaxation_.count; ++n) {
        const auto [share, time] = relaxation_.terms[n];
        const double before      = from - used_[n];
        const double rate        = before * (begin - law.force(used_[n]));
        const double memory      = kept[n] + (1 - ramp[n]) * end;
        used_[n]                 = law.depthOf(memory);
        const double after       = surface_ - used_[n];
        // Within a tick d - s runs one way, so the lesser end is a lower bound; across 0 that is nothing.
        if (before * after > 0) lost_ += share / time * dt * std::min(rate, after * (end - memory));
    }
}

RelaxingContact::Output RelaxingContact::step(const Tick& now) noexcept
{
    const double depth = std::max(now.depth, 0.0), dt = std::max(now.dt, 0.0);
    const double place = now.place.x + now.place.y + now.place.z;
    if (!std::isfinite(now.depth + now.dt + place + now.law.stiffness + now.law.stiffening)) {
        *this = RelaxingContact(relaxation_, fadeLength_);
        return {};
    }
    if (!(depth_ > 0) && depth > 0) lost_ = 0; // a new contact

    Output out;
    if (!(now.law.stiffness > 0)) { // nothing is known of this place: the memory waits, without a force
        depth_ = depth;
        return out;
    }
    out.refreshed = fade(now.law, now.place);
    relax(now.law, depth, dt);
    depth_ = depth;
    if (surface_ <= depth) {
        out.force = now.law.force(depth);
        for (std::size_t n = 0; n < relaxation_.count; ++n)
            out.force -= relaxation_.terms[n].share * now.law.force(used_[n]);
        out.force = std::max(0.0, out.force);
    }
    out.stored           = storedAt(now.law, surface_, used_);
    const double elastic = now.law.energy(surface_);
    storedShare_         = elastic > 0 ? std::min(1.0, out.stored / elastic) : 1;
    return out;
}

} // namespace palp
