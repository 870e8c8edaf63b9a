#include "engine/force/compliance_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palp {
namespace {

constexpr double kRate  = 10;   ///< [1/s] 1 % per ms, our own prototype's: faster is felt as a tick, slower lags
constexpr double kDepth = 2e-3; ///< [m] at which an offset of b is as much of the tangent as one of ln k

} // namespace

ComplianceTable::Values ComplianceTracker::lookUp(const glm::dvec3& contact) const noexcept
{
    if (guessing_)
        if (const auto guess = first_->at(contact)) return *guess;
    if (table_ && law_ != ComplianceLaw::table) return table_->middle();
    if (const auto place = table_ ? table_->chart.project(contact) : std::nullopt) return table_->at(*place);
    // The contact is behind the sphere, not finite, or where a law without a table has no site: the last felt value
    // stays.
    return {compliance_.handed - compliance_.offset, contact_.handed - contact_.offset, true,
            table_ && table_->stiffens ? std::optional(stiffening_.handed - stiffening_.offset) : std::nullopt};
}

/// Updates the offset of what is carried when the table changes its value at the contact.
/// \param rate  at which the offset dies at least, of it in a second
void ComplianceTracker::carry(Carried& carried, double before, double after, double rate) const noexcept
{
    const bool goesOn = touching_ && fits_;
    carried.offset    = law_ == ComplianceLaw::table && goesOn ? before + carried.offset - after : 0;
    carried.rate      = std::max(rate, std::abs(carried.offset) / period_);
    carried.from      = goesOn ? carried.handed : after;
}

/// Starts a contact with the table that is there.
void ComplianceTracker::land(const ComplianceTick& now) noexcept
{
    constexpr double kLate = 1.5; // [periods] a table that is in use for longer has missed its successor

    compliance_ = contact_ = stiffening_ = {};
    guessing_                            = false;
    const bool reached                   = table_ && !lookUp(now.contact).clamped;
    fits_                                = reached && now.time - adopted_ <= kLate * period_;
    guessing_                            = !reached && first_ && first_->at(now.contact);
    landed_                              = now.time;
    const auto here                      = lookUp(now.contact);
    compliance_.handed = compliance_.from = here.lnCompliance;
    contact_.handed = contact_.from = here.lnContactStiffness;
    stiffening_.handed = stiffening_.from = here.stiffening.value_or(0);
}

void ComplianceTracker::adopt(const ComplianceTick& now) noexcept
{
    constexpr double kShortest = 1e-3, kLongest = 0.1; // [s] one tick; longer is a thread that stalled, not a period
    constexpr double kWeight = 0.25;                   // of the newest interval [1]: late and early threads even out
    constexpr double kPause  = 2;                      // [periods] longer with free space in it: nothing was solved

    const ComplianceTable::Values before   = lookUp(now.contact);
    const double                  interval = now.time - adopted_;
    const bool                    paused   = interval > (flown_ ? std::min(kPause * period_, kLongest) : kLongest);
    if (table_ && !paused) period_ += kWeight * (std::max(interval, kShortest) - period_);
    table_   = now.newest;
    flown_   = false;
    adopted_ = now.time;

    const bool                    guessed = std::exchange(guessing_, false);
    const ComplianceTable::Values after   = lookUp(now.contact);
    guessing_                             = guessed && table_->ended; // it was made for another place
    if (guessing_) return;
    fits_ = fits_ || guessed;
    carry(compliance_, before.lnCompliance, after.lnCompliance, kRate);
    carry(contact_, before.lnContactStiffness, after.lnContactStiffness, kRate);
    if (after.stiffening)
        carry(stiffening_, before.stiffening.value_or(*after.stiffening), *after.stiffening, kRate / kDepth);
    fits_ = touching_; // from here on this contact has a table of its own
}

double ComplianceTracker::hand(Carried& carried, double wanted, double time) const noexcept
{
    carried.handed = wanted + carried.offset;
    if (law_ == ComplianceLaw::blend)
        carried.handed = std::lerp(carried.from, wanted, std::min(1.0, (time - adopted_) / period_));
    return carried.handed;
}

std::optional<LocalCompliance> ComplianceTracker::tick(const ComplianceTick& now) noexcept
{
    for (Carried* carried : {&compliance_, &contact_, &stiffening_})
        carried->offset =
            std::copysign(std::max(0.0, std::abs(carried->offset) - carried->rate * now.dt), carried->offset);
    const bool landed = now.touching && !touching_;
    touching_         = now.touching;
    flown_            = flown_ || !touching_;
    if (landed || !touching_) land(now);
    if (now.newest && now.newest->sequence != (table_ ? table_->sequence : 0) && now.newest->usable()) adopt(now);
    if (guessing_ && now.time - landed_ > longestGuess_) guessing_ = false;
    if (!answers()) return {};

    const ComplianceTable::Values here = lookUp(now.contact);
    LocalCompliance               answer{std::exp(hand(compliance_, here.lnCompliance, now.time)),
                           std::exp(hand(contact_, here.lnContactStiffness, now.time)), here.clamped,
                           now.time - (guessing_ ? landed_ : table_->time), guessing_ ? 0 : table_->chart.curvature};
    answer.guessed = guessing_;
    answer.lasts   = law_ == ComplianceLaw::table && !guessing_ && table_->lasts && !here.clamped;
    if (here.stiffening) answer.stiffening = std::max(0.0, hand(stiffening_, *here.stiffening, now.time));
    return answer;
}

std::optional<LocalCompliance> ComplianceTracker::near(const glm::dvec3& place) const noexcept
{
    if (!answers()) return {};
    const ComplianceTable::Values there = lookUp(place);
    LocalCompliance               answer{std::exp(there.lnCompliance + compliance_.offset),
                           std::exp(there.lnContactStiffness + contact_.offset), there.clamped, 0,
                           table_ ? table_->chart.curvature : 0};
    if (there.stiffening) answer.stiffening = std::max(0.0, *there.stiffening + stiffening_.offset);
    return answer;
}

} // namespace palp
