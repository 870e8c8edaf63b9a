#include "tests/soak/invariants.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include <glm/geometric.hpp>

#include "engine/force/energy_tank.h"
#include "engine/session/force_state.h"

namespace palp::soak {
namespace {

constexpr double kRounding = 1e-9; // [N], [J] or [s]: what sums of some hundred terms of that size lose

bool isFinite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class... Parts>
std::string said(const TickRecord& record, const Parts&... parts)
{
    std::ostringstream text;
    ((text << "at " << record.time << " s: ") << ... << parts);
    return text.str();
}

/// FNV-1a over the bytes of a table that mean something.
std::uint64_t sumOf(const ComplianceTable& table)
{
    std::uint64_t sum = 0xcbf29ce484222325U;
    const auto    add = [&](const void* data, std::size_t bytes) {
        const auto* const at = static_cast<const unsigned char*>(data);
        for (std::size_t n = 0; n < bytes; ++n) sum = (sum ^ at[n]) * 0x100000001b3U;
    };
    add(&table.time, sizeof table.time);
    add(&table.side, sizeof table.side);
    add(&table.spacing, sizeof table.spacing);
    add(&table.compliance, sizeof table.compliance);
    add(&table.contactStiffness, sizeof table.contactStiffness);
    return sum;
}

} // namespace

std::optional<std::string> Invariants::check(const TickRecord& record, const GovernedForce& given, double dt,
                                             const GovernorSettings& limits)
{
    const bool   runs = dt > 0 && std::isfinite(dt);
    const double rise = runs ? std::min(dt, limits.longestTick) : 0, fall = runs ? dt : limits.nominalPeriod;

    auto wrong = checkForce(record, given);
    if (!wrong) wrong = checkChange(record, rise, fall, limits);
    if (!wrong) wrong = checkZero(record, fall, limits);
    if (!wrong) wrong = checkEnergy(record, limits);
    if (!wrong) wrong = checkFault(record, dt, limits);
    if (!wrong) wrong = checkSilence(record);
    last_ = record.force;
    pressing_ += record.force != glm::dvec3(0);
    return wrong;
}

std::optional<std::string> Invariants::checkForce(const TickRecord& record, const GovernedForce& given) const
{
    if (!isFinite(record.force) || !isFinite(given.newtons())) return said(record, "the force is not finite");
    if (const double size = glm::length(record.force); size > most_ + weight_ + kRounding)
        return said(record, "the force is ", size, " N, above its limit of ", most_, " N");
    if (weight_ == 0 && glm::length(record.force) > most_ + kRounding)
        return said(record, "the force is ", glm::length(record.force), " N, above its limit of ", most_, " N");
    if (const double size = glm::length(given.newtons()); size > GovernorSettings::kMostForce + kRounding)
        return said(record, "the device is given ", size, " N, above what any device is given");
    return {};
}

/// A force grows by the slew and by what the gain rises, and changes by no more than slew, fault ramp and rise
/// together.
std::optional<std::string> Invariants::checkChange(const TickRecord& record, double rise, double fall,
                                                   const GovernorSettings& limits) const
{
    const double gained = most_ * rise / limits.engageTime;
    const double lifted = weight_ * (fall / limits.faultRamp); // where arm and hand together are clamped
    const double grown  = glm::length(record.force) - glm::length(last_);
    if (grown > limits.slew * rise + gained + lifted + kRounding)
        return said(record, "the force grew by ", grown, " N in a tick of ", rise, " s");
    const double changed = glm::length(record.force - last_);
    if (record.force != glm::dvec3(0) &&
        changed > limits.slew * fall + gained + lifted + most_ * (fall / limits.faultRamp) + kRounding)
        return said(record, "the force changed by ", changed, " N in a tick of ", fall, " s");
    return {};
}

std::optional<std::string> Invariants::checkZero(const TickRecord& record, double fall, const GovernorSettings& limits)
{
    faulty_ = (record.faults & 0xFFU) != 0 ? faulty_ + fall : 0;
    away_   = record.normal == glm::dvec3(0) ? away_ + 1 : 0;
    if (record.force != glm::dvec3(0) && faulty_ > limits.faultRamp + limits.nominalPeriod + kRounding)
        return said(record, "a force ", faulty_, " s after the governor latched a fault");
    // Past a border the pull loses a tenth in a tick: of 8 N there are 1e-6 N left after 150.
    if (away_ > 150 && glm::length(record.force) > 1e-6)
        return said(record, "a force ", away_, " ticks after the last contact");
    return {};
}

std::optional<std::string> Invariants::checkEnergy(const TickRecord& record, const GovernorSettings& limits) const
{
    if (!(record.tankEnergy >= 0 && record.tankEnergy <= EnergyTankSettings().limit + kRounding))
        return said(record, "the tank holds ", record.tankEnergy, " J");
    if (!(std::abs(record.observerEnergy) <= limits.energyLimit + kRounding))
        return said(record, "the observer counts ", record.observerEnergy, " J");
    if (!(record.stiffness >= 0 && std::isfinite(record.stiffness)))
        return said(record, "the stiffness is ", record.stiffness, " N/m");
    return {};
}

/// What no loop can go on with stops the force in the same tick.
std::optional<std::string> Invariants::checkFault(const TickRecord& record, double dt, const GovernorSettings& limits)
{
    const bool isImpossible = !std::isfinite(dt) || dt > limits.stall || !isFinite(record.hip) ||
                              !isFinite(record.hipVelocity) || record.missed > limits.missedTicks;
    if (isImpossible && (record.faults & 0xFFU) == 0) return said(record, "an impossible input, and no fault");
    return {};
}

/// A hand that presses without a force is told why.
std::optional<std::string> Invariants::checkSilence(const TickRecord& record) const
{
    if (record.normal == glm::dvec3(0) || record.force != glm::dvec3(0) || record.wanted == glm::dvec3(0)) return {};
    if (forceState(record) != ForceState::flows) {
        if (describeForces(record).empty()) return said(record, "no force, and no words for it");
        return {};
    }
    if (record.actions != 0) return {};
    return said(record, "a force of ", glm::length(record.wanted),
                " N was wanted, none flows, and no reason is recorded");
}

void Invariants::handsOver(const ComplianceTable& table)
{
    sums_[table.sequence % kNoted] = sumOf(table);
    handed_                        = std::max<std::uint64_t>(handed_, table.sequence);
}

std::optional<std::string> Invariants::checkTable(const ComplianceTable* inUse, bool whole)
{
    if (!inUse) return {};
    std::ostringstream wrong;
    if (inUse->sequence < newest_)
        wrong << "table " << inUse->sequence << " is used after table " << newest_;
    else if (!inUse->usable())
        wrong << "table " << inUse->sequence << " is used and not usable";
    else if (whole && inUse->sequence + kNoted > handed_ && sums_[inUse->sequence % kNoted] != sumOf(*inUse))
        wrong << "table " << inUse->sequence << " was changed while it was in use";
    newest_ = inUse->sequence;
    if (wrong.str().empty()) return {};
    return wrong.str();
}

} // namespace palp::soak
