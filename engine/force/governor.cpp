#include "engine/force/governor.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp {
namespace {

bool finite(const glm::dvec3& v) noexcept
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void mark(GovernorOutput& out, GovernorAction action) noexcept
{
    out.actions |= static_cast<std::uint32_t>(action);
}

void demand(const char* what, double value, double least, double most)
{
    if (!(value >= least && value <= most))
        throw Error("force governor: " + std::string(what) + " must be from " + std::to_string(least) + " to " +
                    std::to_string(most) + ", found " + std::to_string(value));
}

void check(const GovernorSettings& s)
{
    demand("nominalPeriod", s.nominalPeriod, 1e-5, 1e-2);
    demand("longestTick", s.longestTick, 1e-5, 2e-2);
    demand("stall", s.stall, 1e-3, 0.1);
    demand("missedTicks", s.missedTicks, 1, 20);
    demand("staleAfter", s.staleAfter, 0, 0.02);
    demand("staleRamp", s.staleRamp, 1e-3, 0.02);
    demand("passivitySpeed", s.passivitySpeed, 0, 0.1);
    demand("passivityDamping", s.passivityDamping, 0, 20);
    demand("passivityLeak", s.passivityLeak, 1e-3, 100);
    demand("energyReserve", s.energyReserve, 0, 0.1);
    demand("energyLimit", s.energyLimit, 0, 10);
    demand("energyTolerance", s.energyTolerance, 0, 0.01);
    demand("maximumForce", s.maximumForce, 0, s.kMostForce);
    demand("slew", s.slew, s.kMostForce / 0.02, 1e5); // slower, and the most force would not be gone in 20 ms
    demand("maximumSpeed", s.maximumSpeed, 0, 5);
    demand("faultRamp", s.faultRamp, 1e-3, 0.02);
    demand("calmForce", s.calmForce, 0, 1);
    demand("calmTicks", s.calmTicks, 1, 1000);
    demand("engageTime", s.engageTime, 0.1, 10);
    demand("maximumStiffness", s.maximumStiffness, 0, 1e4);
    demand("mass", s.mass, 0, 100);
    demand("ownDamping", s.ownDamping, 0, 100);
    demand("statedStiffness", s.statedStiffness, 0, 1e4);
    demand("the size of weight", glm::length(s.weight), 0, s.kMostWeight);
    demand("motorForce", s.motorForce, 0, s.kMostForce);
}

constexpr double kNominalLag = 1.5; ///< [1] periods: one from a position to its force, half for which it is held

/// [1] of the arm's damping that may be used. The Falcon's was published as 2.8 net and as 3.2 to 4.0 without the loss
/// of sampling; with less the cap is farther from what the arm bears, with more an arm worse than its figure swings.
constexpr double kUsable = 0.8;

/// [kg] of an arm whose mass is unknown: among haptic arms only pens are lighter.
constexpr double kLeastMass = 0.1;

/// [s] age of a velocity that drivers take over 15 ms.
constexpr double kVelocityAge = 7.5e-3;

/// Returns a time of the input that makes sense [s].
double credible(double time, double most) noexcept
{
    return std::isfinite(time) ? std::clamp(time, 0.0, most) : most;
}

} // namespace

ForceGovernor::ForceGovernor(const GovernorSettings& settings)
    : settings_(settings), lag_(kNominalLag * settings.nominalPeriod)
{
    check(settings_);
    cap_ = capFor(lag_);
}

GovernorOutput ForceGovernor::step(const GovernorInput& in) noexcept
{
    GovernorOutput out;
    const Elapsed  passed = elapsed(in.dt);
    measureLag(in);

    checkInput(in); // 1
    glm::dvec3 force = fault_ == GovernorFault::none ? in.force : glm::dvec3(0);

    if (!in.homed) mark(out, GovernorAction::notHomed); // 2
    if (!in.inBox) mark(out, GovernorAction::outsideBox);
    if (in.letGo) mark(out, GovernorAction::lettingGo);
    if (in.clutched) mark(out, GovernorAction::clutched);
    const bool jumped = hasJumped(in);
    if (jumped) mark(out, GovernorAction::jumped);
    const bool may = in.homed && in.inBox && !in.letGo && !in.clutched && !jumped;
    if (!may) release();

    const double fresh = freshness(usableAge(in)); // 3
    if (fresh < 1) mark(out, GovernorAction::stale);
    if (fresh == 0) release();
    const double punctual = punctuality(in);
    if (punctual < 1) mark(out, GovernorAction::late);
    force *= fresh * punctual;
    if (engagement_ == Engagement::releasing || !may) force = glm::dvec3(0);

    observeEnergy(in, passed.fall); // 4
    force = passiveForce(force, in, passed.fall, out);

    force = clampedForce(force, out); // 5
    slewTo(force, passed, out);       // 6

    watchSpeed(in); // 7
    if (fault_ != GovernorFault::none) faultGain_ = std::max(0.0, faultGain_ - passed.fall / settings_.faultRamp);

    engage(in, passed.rise, out); // 8

    out.gain   = faultGain_ * engageGain_;
    out.force  = slewed_ * out.gain;
    out.fault  = fault_;
    out.energy = energy_;
    forceless_ = out.force == glm::dvec3(0) ? forceless_ + passed.fall : 0;

    note(out.force, in);
    carry(in, passed, out); // 9
    return out;
}

void ForceGovernor::reset() noexcept
{
    if (fault_ == GovernorFault::none) return;
    fault_        = GovernorFault::none;
    faultGain_    = 1;
    engagement_   = Engagement::waiting;
    engageGain_   = 0;
    calmTicks_    = 0;
    stoppedTicks_ = 0;
    energy_       = 0;
    slewed_       = glm::dvec3(0);
    sent_         = {};
    clock_        = 0;
    hasPosition_  = false;
    forceless_    = 0;
}

ForceGovernor::Elapsed ForceGovernor::elapsed(double dt) const noexcept
{
    if (!(dt > 0) || !std::isfinite(dt)) return {0, settings_.nominalPeriod};
    return {std::min(dt, settings_.longestTick), dt};
}

/// Lets the clock run, and takes the lag of this tick into the cap.
void ForceGovernor::measureLag(const GovernorInput& in) noexcept
{
    clock_ += credible(in.dt, settings_.stall);
    if (!(in.dt > 0) || !std::isfinite(in.dt)) return;
    periods_.add(in.exchangePeriod > 0 ? credible(in.exchangePeriod, settings_.stall) : in.dt);
    lags_.add(lagOf(in) + credible(in.forceAge, settings_.stall));
    lag_ = lags_.value(lag_);
    cap_ = capFor(lag_);
}

/// Returns the lag of a loop whose ticks are all like this one, with a fresh force [s].
double ForceGovernor::lagOf(const GovernorInput& in) const noexcept
{
    const double tick   = credible(in.dt, settings_.stall);
    const double silent = credible(in.sinceAnswer, settings_.stall); // above the period if an answer is missing
    const double period = in.exchangePeriod > 0 ? std::max(credible(in.exchangePeriod, settings_.stall), silent) : tick;
    const double age    = settings_.ownDamping > 0 ? credible(in.answerAge, settings_.stall) : 0;
    return age + period + std::max(period, tick) / 2;
}

double ForceGovernor::capFor(double lag) const noexcept
{
    const double known = usableDamping(), stated = settings_.statedStiffness * kNominalLag * 1e-3;
    return std::min(settings_.maximumStiffness, (known > 0 ? known : stated) / lag);
}

double ForceGovernor::usableDamping() const noexcept
{
    return kUsable * settings_.ownDamping;
}

/// Returns what the spring at the cap takes of the arm's damping [N s/m].
double ForceGovernor::creditedDamping() const noexcept
{
    return std::min(usableDamping(), cap_ * lag_);
}

/// Returns the share of the force that a tick as late as this one may have [1].
double ForceGovernor::punctuality(const GovernorInput& in) const noexcept
{
    const double lag = lagOf(in);
    if (!(in.stiffness > 0) || kUsable * lag <= lag_) return 1; // the damping that is kept in reserve bears it
    return std::min(1.0, capFor(lag) / in.stiffness);
}

void ForceGovernor::latch(GovernorFault fault) noexcept
{
    if (fault_ != GovernorFault::none) return; // the first one is the cause
    fault_ = fault;
    release();
}

void ForceGovernor::release() noexcept
{
    calmTicks_ = 0;
    if (engagement_ == Engagement::engaging || engagement_ == Engagement::engaged) engagement_ = Engagement::releasing;
}

/// Returns the time of the position, by the governor's clock [s].
double ForceGovernor::measuredAt(const GovernorInput& in) const noexcept
{
    return clock_ - credible(in.sinceAnswer, settings_.stall) - credible(in.answerAge, settings_.stall);
}

bool ForceGovernor::isJump(double distance, double time) noexcept
{
    constexpr double kSlip = 1e-3, kFastest = 4; // [m] an encoder's step and more, [m/s] three times maximumSpeed
    return distance > kSlip + kFastest * std::max(0.0, time);
}

/// Returns whether the position is not that of the hand that was elsewhere before: a surface that is not there would
/// push it with all of its force.
bool ForceGovernor::hasJumped(const GovernorInput& in) const noexcept
{
    if (!hasPosition_ || !in.homed || !finite(in.position)) return false;
    return isJump(glm::length(in.position - lastPosition_), measuredAt(in) - lastMeasured_);
}

void ForceGovernor::checkInput(const GovernorInput& in) noexcept
{
    if (!finite(in.force) || !std::isfinite(in.admittedEnergy) || std::isnan(in.storedEnergy))
        latch(GovernorFault::forceNotFinite);
    if (!finite(in.position)) latch(GovernorFault::positionNotFinite);
    if (!finite(in.velocity)) latch(GovernorFault::velocityNotFinite);
    if (!std::isfinite(in.dt)) latch(GovernorFault::clockNotFinite);
    if (in.dt > settings_.stall) latch(GovernorFault::loopStalled);
    stoppedTicks_ = in.dt > 0 ? 0 : std::min(stoppedTicks_ + 1, settings_.missedTicks + 1);
    if (stoppedTicks_ > settings_.missedTicks) latch(GovernorFault::clockStopped);
    if (in.missedExchanges > settings_.missedTicks) latch(GovernorFault::deviceLost);
}

/// Returns the age that decides whether the force is used: one that was computed from something too old counts as old.
/// It is no lag of the loop, so it is no part of the cap's.
double ForceGovernor::usableAge(const GovernorInput& in) const noexcept
{
    return in.overdue > 0 ? std::max(in.forceAge, settings_.staleAfter + in.overdue) : in.forceAge;
}

double ForceGovernor::freshness(double age) const noexcept
{
    if (age <= settings_.staleAfter) return 1;
    if (!(age < settings_.staleAfter + settings_.staleRamp)) return 0; // also if it is not a number
    return 1 - (age - settings_.staleAfter) / settings_.staleRamp;
}

void ForceGovernor::observeEnergy(const GovernorInput& in, double dt) noexcept
{
    const bool   known    = in.homed && finite(in.position);
    const double measured = measuredAt(in);
    if (engagement_ == Engagement::waiting) {
        energy_ = 0;
    } else if (known && hasPosition_) {
        // Energy of the force that acted on the way here, plus what the arm's damping and the tank account for.
        energy_ -= glm::dot(meanForce(lastMeasured_, measured), in.position - lastPosition_);
        energy_ += creditedDamping() * glm::dot(in.velocity, in.velocity) * dt + in.admittedEnergy;
        if (in.force == glm::dvec3(0)) energy_ -= energy_ * std::min(1.0, dt / settings_.passivityLeak);
        // A contact gives back at most what it stores; the rest was dissipated and is gone.
        const double most = std::min(settings_.energyLimit, std::max(in.storedEnergy, 0.0) + settings_.energyReserve);
        energy_           = std::max(-settings_.energyLimit, std::min(energy_, most));
    }
    hasPosition_ = known;
    if (known) lastPosition_ = in.position;
    lastMeasured_ = measured;
}

/// Returns the mean of the force that acted in this time [N], by the governor's clock [s].
glm::dvec3 ForceGovernor::meanForce(double from, double until) const noexcept
{
    glm::dvec3 sum{};
    double     end = until;
    for (std::size_t back = 1; back <= kSent; ++back) {
        const SentForce& sent = sent_[(tick_ + kSent - back) % kSent];
        if (sent.from <= from && end == until) return sent.force; // it acted all the time, or no time passed
        const double begin = std::max(sent.from, from);
        if (begin < end) {
            sum += sent.force * (end - begin);
            end = begin;
        }
        if (begin == from) break;
    }
    return until > from ? sum / (until - from) : glm::dvec3(0);
}

/// Notes the force of this tick, and when it will act: with the next packet.
void ForceGovernor::note(const glm::dvec3& sent, const GovernorInput& in) noexcept
{
    const double wait    = periods_.value(settings_.nominalPeriod) - credible(in.sinceAnswer, settings_.stall);
    const double after   = sent_[(tick_ + kSent - 1) % kSent].from; // forces act in their order
    sent_[tick_ % kSent] = {sent, std::max(clock_ + std::max(wait, 0.0), after)};
    ++tick_;
}

glm::dvec3 ForceGovernor::passiveForce(glm::dvec3 force, const GovernorInput& in, double dt,
                                       GovernorOutput& out) const noexcept
{
    if (energy_ < -settings_.energyTolerance) mark(out, GovernorAction::active);
    const double speed = glm::length(in.velocity);
    const bool   flows = engagement_ == Engagement::engaging || engagement_ == Engagement::engaged;
    if (!flows || energy_ >= 0 || !(speed > settings_.passivitySpeed)) return force;
    // A damper turns unstable where its own lag times it is more than the mass; half of that.
    const double mass = settings_.mass > 0 ? settings_.mass : kLeastMass;
    const double most = mass / (2 * (lag_ + kVelocityAge));
    out.damping       = std::min({-energy_ / (speed * speed * dt), settings_.passivityDamping, most});
    // A force along the motion gives energy: it is reduced, but never turned round, or the surface would be sticky.
    const double along = glm::dot(force, in.velocity);
    if (along >= 0) out.damping = std::min(out.damping, along / (speed * speed));
    mark(out, GovernorAction::damped);
    return force - out.damping * in.velocity;
}

glm::dvec3 ForceGovernor::clampedForce(glm::dvec3 force, GovernorOutput& out) const noexcept
{
    const double size = glm::length(force);
    if (size <= settings_.maximumForce) return force;
    mark(out, GovernorAction::clamped);
    return force * (settings_.maximumForce / size);
}

void ForceGovernor::slewTo(glm::dvec3 force, Elapsed passed, GovernorOutput& out) noexcept
{
    // A late tick may take a force down by all the time that went by, but let it grow only by one long tick.
    const glm::dvec3 change = force - slewed_;
    const bool       falls  = glm::length(force) < glm::length(slewed_);
    const double     most   = settings_.slew * (falls ? passed.fall : passed.rise);
    const double     wanted = glm::length(change);
    if (wanted <= most) {
        slewed_ = force;
    } else {
        mark(out, GovernorAction::slewed);
        slewed_ += change * (most / wanted);
    }
}

/// A force that drives a hand too fast is a fault; a hand that is fast by itself, in free space, only waits anew.
void ForceGovernor::watchSpeed(const GovernorInput& in) noexcept
{
    constexpr double kFree = 0.05; // [s] the velocity of a hand that was driven shows within some 15 ms
    if (engagement_ == Engagement::waiting || glm::length(in.velocity) <= settings_.maximumSpeed) return;
    if (forceless_ > kFree && slewed_ == glm::dvec3(0))
        release();
    else
        latch(GovernorFault::tooFast);
}

void ForceGovernor::engage(const GovernorInput& in, double rise, GovernorOutput& out) noexcept
{
    const bool calm = fault_ == GovernorFault::none && in.homed && in.inBox && !in.letGo && !in.clutched &&
                      !in.behind && usableAge(in) <= settings_.staleAfter &&
                      glm::length(in.velocity) <= settings_.maximumSpeed && glm::length(slewed_) < settings_.calmForce;
    switch (engagement_) {
    case Engagement::waiting:
        mark(out, GovernorAction::waiting);
        engageGain_ = 0;
        calmTicks_  = calm ? calmTicks_ + 1 : 0;
        if (calmTicks_ >= settings_.calmTicks) engagement_ = Engagement::engaging;
        break;
    case Engagement::engaging:
        mark(out, GovernorAction::engaging);
        engageGain_ = std::min(1.0, engageGain_ + rise / settings_.engageTime);
        if (engageGain_ == 1) engagement_ = Engagement::engaged;
        break;
    case Engagement::engaged:
        break;
    case Engagement::releasing:
        mark(out, GovernorAction::releasing);
        if (slewed_ == glm::dvec3(0)) {
            engagement_ = Engagement::waiting;
            engageGain_ = 0;
            calmTicks_  = 0;
        }
        break;
    }
}

/// Carries the arm's weight, eased in and out, and sets what the device is given.
void ForceGovernor::carry(const GovernorInput& in, Elapsed passed, GovernorOutput& out) noexcept
{
    const bool may = fault_ == GovernorFault::none && in.homed && in.inBox && !in.letGo &&
                     freshness(usableAge(in)) > 0 && glm::length(in.velocity) <= settings_.maximumSpeed;
    carryTicks_ = may ? std::min(carryTicks_ + 1, settings_.calmTicks) : 0;
    if (carryTicks_ == settings_.calmTicks) carryGain_ = std::min(1.0, carryGain_ + passed.rise / settings_.engageTime);
    constexpr double kNothing = 1e-9; // [1] what rounding leaves of a ramp
    if (!may) carryGain_ -= passed.fall / settings_.faultRamp;
    if (!(carryGain_ > kNothing)) carryGain_ = 0;

    out.carried        = -carryGain_ * settings_.weight;
    toDevice_          = out.force + out.carried;
    const double whole = glm::length(toDevice_);
    if (whole > settings_.motorForce) {
        mark(out, GovernorAction::clamped);
        toDevice_ *= settings_.motorForce / whole;
        out.force = toDevice_ - out.carried;
    }
    if (carryGain_ < 1 && settings_.weight != glm::dvec3(0)) mark(out, GovernorAction::lifting);
}

} // namespace palp
