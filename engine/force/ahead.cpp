#include "engine/force/ahead.h"

#include <cmath>

namespace palp {

void RecentMotion::add(double time, const glm::dvec3& position) noexcept
{
    if (count_ > 0 && !(time > past_[newest_].time)) return;
    newest_        = (newest_ + 1) % kMost;
    past_[newest_] = {time, position};
    if (count_ < kMost) ++count_;
}

glm::dvec3 RecentMotion::velocity() const noexcept
{
    constexpr double     kRounding = 1e-9; // [s] of sums of milliseconds
    const TimedPosition& newest    = past_[newest_];
    const TimedPosition* oldest    = &newest;
    for (std::size_t n = 1; n < count_; ++n) {
        const TimedPosition& before = past_[(newest_ + kMost - n) % kMost];
        if (newest.time - before.time > kSpan + kRounding && oldest != &newest) break;
        oldest = &before;
        if (newest.time - before.time > kSpan) break; // a slow clock: only the last two positions count
    }
    return oldest == &newest ? glm::dvec3(0) : (newest.position - oldest->position) / (newest.time - oldest->time);
}

glm::dvec3 aheadOf(ComplianceLaw law, const glm::dvec3& contact, const glm::dvec3& velocity, double lead) noexcept
{
    return law == ComplianceLaw::table ? contact + lead * velocity : contact;
}

int tableSide(ComplianceLaw law, double period, double spacing) noexcept
{
    constexpr double kSpeed = 0.2, kAcceleration = 3; // of a hand that explores [m/s], [m/s^2]
    if (law != ComplianceLaw::table) return 1;
    const double needed = kSpeed * period / 2 + kAcceleration * (2 * period) * (2 * period) / 2;
    int          side   = 3;
    while (side < ComplianceTable::kMostSide && side / 2 * spacing < needed) side += 2;
    return side;
}

} // namespace palp
