#include "engine/force/compliance_tracker.h"

#include <algorithm>
#include <cmath>

namespace palp {

ComplianceTable::Values ComplianceTracker::lookUp(const glm::dvec3& contact) const noexcept
{
    if (law_ != ComplianceLaw::table) return table_.middle();
    if (const auto place = table_.chart.project(contact)) return table_.at(*place);
    // The contact is behind the sphere, or not finite: the last felt value stays.
    return {compliance_.handed - compliance_.offset, contact_.handed - contact_.offset, true};
}

/// Updates the offset of a logarithm when the table changes its value at the contact.
void ComplianceTracker::carry(Carried& carried, double before, double after) const noexcept
{
    constexpr double kRate = 10; // [1/s] 1 % per ms, our own prototype's: faster is felt as a tick, slower lags

    carried.offset = law_ == ComplianceLaw::table && inContact_ ? before + carried.offset - after : 0;
    carried.rate   = std::max(kRate, std::abs(carried.offset) / period_);
    carried.from   = inContact_ ? carried.handed : after;
}

void ComplianceTracker::adopt(const ComplianceTick& now) noexcept
{
    constexpr double kShortest = 1e-3, kLongest = 0.1; // [s] one tick; longer is a thread that stalled, not a period
    constexpr double kWeight = 0.25;                   // of the newest interval [1]: late and early threads even out

    const ComplianceTable::Values before = lookUp(now.contact);
    if (hasTable_) period_ += kWeight * (std::clamp(now.time - adopted_, kShortest, kLongest) - period_);
    table_    = *now.newest;
    hasTable_ = true;
    adopted_  = now.time;

    const ComplianceTable::Values after = lookUp(now.contact);
    carry(compliance_, before.lnCompliance, after.lnCompliance);
    carry(contact_, before.lnContactStiffness, after.lnContactStiffness);
}

double ComplianceTracker::hand(Carried& carried, double wanted, double time) const noexcept
{
    carried.handed = wanted + carried.offset;
    if (law_ == ComplianceLaw::blend)
        carried.handed = std::lerp(carried.from, wanted, std::min(1.0, (time - adopted_) / period_));
    return std::exp(carried.handed);
}

std::optional<LocalCompliance> ComplianceTracker::tick(const ComplianceTick& now) noexcept
{
    for (Carried* carried : {&compliance_, &contact_})
        carried->offset =
            std::copysign(std::max(0.0, std::abs(carried->offset) - carried->rate * now.dt), carried->offset);
    if (now.newest && now.newest->sequence != (hasTable_ ? table_.sequence : 0) && now.newest->usable()) adopt(now);
    if (!hasTable_) return {};

    const ComplianceTable::Values here = lookUp(now.contact);
    inContact_                         = true;
    return LocalCompliance{hand(compliance_, here.lnCompliance, now.time),
                           hand(contact_, here.lnContactStiffness, now.time), here.clamped, now.time - table_.time};
}

void ComplianceTracker::restart() noexcept
{
    inContact_        = false;
    const auto middle = table_.middle();
    compliance_       = {.handed = middle.lnCompliance, .from = middle.lnCompliance};
    contact_          = {.handed = middle.lnContactStiffness, .from = middle.lnContactStiffness};
}

} // namespace palp
