#include "engine/session/servo.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace palp {
namespace {

std::uint32_t flag(SessionFlag which, bool set) noexcept
{
    return set ? static_cast<std::uint32_t>(which) : 0U;
}

/// Returns what the sampled spring at a cap takes of the arm's damping, K (T/2 + delay), with one tick of delay
/// [N s/m].
double spentDamping(double cap)
{
    return cap * 1.5e-3;
}

/// Returns the delay in ticks; with a thread of its own the proxy's answer is up to two more ticks old.
int delayOf(SessionThreads threads)
{
    return threads == SessionThreads::paper ? 3 : 1;
}

/// Returns the lower of what the scene wants and the device can do; 0 in a device's list states nothing.
double lower(double wanted, double possible)
{
    return possible > 0 ? std::min(wanted, possible) : wanted;
}

/// Sets the governor. The longer the delay, the lower the cap at a period of 1 ms: the spring then spends what it does
/// with a delay of one tick.
GovernorSettings governorOf(const Scene& scene, const HapticDeviceInfo& limits, SessionThreads threads)
{
    GovernorSettings settings;
    settings.maximumForce              = lower(scene.maxForce, limits.maximumForce);
    settings.maximumStiffness          = lower(scene.stiffnessCap, limits.maximumStiffness);
    settings.stiffnessAtOneMillisecond = settings.maximumStiffness;
    settings.delayTicks                = delayOf(threads);
    settings.creditedDamping           = spentDamping(settings.maximumStiffness);
    return settings;
}

/// Sets the tank, which lives on what the cap leaves of an arm's 3.2 N s/m, less a reserve.
EnergyTankSettings tankOf(const Scene& scene, const HapticDeviceInfo& limits)
{
    constexpr double   kArm = 2.5; // [N s/m] of 3.2
    EnergyTankSettings settings;
    const double       left = kArm - spentDamping(lower(scene.stiffnessCap, limits.maximumStiffness));
    settings.damping        = std::clamp(left, 0.0, settings.damping);
    return settings;
}

} // namespace

ContactHalf::ContactHalf(const SoftObject& object, const Scene& scene)
    : proxy_(object, {scene.proxy, scene.staticFriction, scene.dynamicFriction})
{
}

const ProxyContact& ContactHalf::tick(double time, const glm::dvec3& hip) noexcept
{
    const ProxyState& proxy = proxy_.step(hip);
    if (proxy.touching)
        motion_.add(time, proxy.position);
    else
        motion_.forget();
    held_ = {{held_.touch.sequence + 1, time, proxy.touching, proxy.position, proxy.normal, motion_.velocity()},
             proxy.pull,
             proxy.limited};
    return held_;
}

ForceHalf::ForceHalf(const Scene& scene, const HapticDeviceInfo& limits, SessionThreads threads)
    : law_(scene.patch.forceLaw), thickness_(scene.material.thickness), patchPeriod_(1 / scene.deformationRate),
      compliance_(scene.complianceLaw), tank_(tankOf(scene, limits)), governor_(governorOf(scene, limits, threads))
{
}

ForceHalf::WantedForce ForceHalf::wantedForce(double stiffness, double dt, const Hand& hand,
                                              const ProxyContact& held) noexcept
{
    const glm::dvec3& pull  = held.pull;
    const double      depth = glm::length(pull);
    const glm::dvec3& outward =
        held.touch.outward; // the brake is along the surface, whichever way friction tilts the pull
    const double     along   = glm::dot(hand.velocity, outward);
    const glm::dvec3 sliding = hand.velocity - along * outward;
    const double     speed   = glm::length(sliding);

    WantedForce result;
    result.tank  = tank_.step({.stiffness       = std::min(stiffness, governor_.stiffnessCap()),
                               .depth           = depth,
                               .normalSpeed     = along,
                               .tangentialSpeed = speed,
                               .dt              = dt});
    result.force = result.tank.stiffness * pull;
    if (speed > 0) result.force -= result.tank.brake / speed * sliding;
    return result;
}

/// Returns by how much the plate's answer is too old to be felt [s]; at most 0 while it is not. Time in the air does not
/// count, because nothing is asked then. A deformation at less than 12 Hz has three of its periods.
double ForceHalf::tableOverdue(const TickTime& now, bool touching, const PatchUpdate* newest) noexcept
{
    constexpr double kOldest = 0.25, kPeriods = 3; // [s] a hand moves 5 cm in it; [1]
    if (newest && newest->table.sequence != answered_ && newest->table.usable()) {
        answered_ = newest->table.sequence;
        asked_    = now.time - newest->table.time;
    }
    if (touching) asked_ += now.dt;
    return touching ? asked_ - std::max(kOldest, kPeriods * patchPeriod_) : 0;
}

TickRecord ForceHalf::tick(const TickTime& now, const Hand& hand, const ProxyContact& held,
                           const PatchUpdate* newest) noexcept
{
    const bool press = hand.homed && hand.device == DeviceFault::none && (hand.buttons & kOperatorsButton) != 0;
    pressed_         = press ? pressed_ + 1 : 0;
    if (pressed_ == kPressTicks) governor_.reset();

    const Touch& touch = held.touch;
    if (!touch.touching) compliance_.restart();
    const auto handed =
        compliance_.tick({touch.point, now.time, now.dt, newest ? &newest->table : nullptr}); // also beyond the surface
    const double      stiffness = handed ? feltStiffness(law_, handed->contactStiffness, handed->compliance) : 0;
    const WantedForce want      = wantedForce(stiffness, now.dt, hand, held);

    GovernorInput in;
    in.force             = want.force;
    in.position          = hand.position;
    in.velocity          = hand.velocity;
    in.homed             = hand.homed && hand.device == DeviceFault::none;
    in.inBox             = hand.inBox;
    in.dt                = now.dt;
    in.loopPeriod        = now.loopPeriod;
    in.forceAge          = std::max(0.0, now.time - touch.time); // above 0 if the proxy has a thread of its own
    const double overdue = tableOverdue(now, touch.touching, newest);
    if (overdue > 0) in.forceAge = std::max(in.forceAge, governor_.settings().staleAfter + overdue);
    in.missedExchanges       = hand.missed;
    in.admittedEnergy        = want.tank.used;
    in.storedEnergy          = want.tank.stored;
    const GovernorOutput out = governor_.step(in);

    TickRecord record;
    record.time        = now.time;
    record.hip         = hand.position;
    record.hipVelocity = hand.velocity;
    record.device      = hand.bits();
    record.missed      = hand.missed;
    record.proxy       = touch.point;
    record.force       = out.force;
    record.normal      = touch.touching ? touch.outward : glm::dvec3(0);
    if (newest && touch.touching) {
        record.rigidity      = newest->rigidity;
        record.maxDeflection = newest->mostResponse * std::max(0.0, glm::dot(out.force, touch.outward));
        record.errorEstimate = newest->errorEstimate;
        record.iterations    = newest->iterations;
    }
    if (handed && touch.touching) {
        record.compliance = handed->compliance;
        record.patchAge   = handed->age;
    }
    constexpr double kStalePeriods = 3; // two are ordinary: one to solve, one in use [1]
    record.faults =
        static_cast<std::uint32_t>(out.fault) |
        flag(SessionFlag::stalePatch, record.patchAge > kStalePeriods * patchPeriod_) |
        flag(SessionFlag::beyondTable, touch.touching && handed && handed->clamped) |
        flag(SessionFlag::noPatch, touch.touching && !handed) | flag(SessionFlag::proxyLimited, held.limited) |
        flag(SessionFlag::beyondTheory, record.maxDeflection > thickness_ / 2) |
        flag(SessionFlag::oldTable, overdue > 0) | flag(SessionFlag::governed, touch.touching && out.actions != 0);
    return record;
}

} // namespace palp
