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

GovernorSettings governorOf(const Scene& scene)
{
    GovernorSettings settings;
    settings.maximumForce              = scene.maxForce;
    settings.maximumStiffness          = scene.stiffnessCap;
    settings.stiffnessAtOneMillisecond = scene.stiffnessCap;
    return settings;
}

} // namespace

Servo::Servo(const PointCloud& cloud, const NeighbourIndex& index, const Scene& scene)
    : law_(scene.patch.forceLaw), thickness_(scene.patch.material.thickness), patchPeriod_(1 / scene.deformationRate),
      proxy_(cloud.positions(), index, {scene.proxy, scene.staticFriction, scene.dynamicFriction}),
      handOver_(scene.handOver), governor_(governorOf(scene))
{
}

Servo::Wanted Servo::wanted(double stiffness, double dt, const Hand& hand, const glm::dvec3& pull) noexcept
{
    const double     depth   = glm::length(pull);
    const glm::dvec3 outward = depth > 0 ? pull / depth : glm::dvec3(0);
    const double     along   = glm::dot(hand.velocity, outward);
    const glm::dvec3 sliding = hand.velocity - along * outward;
    const double     speed   = glm::length(sliding);

    Wanted result;
    result.tank  = tank_.step({.stiffness       = std::min(stiffness, governor_.stiffnessCap()),
                               .depth           = depth,
                               .normalSpeed     = along,
                               .tangentialSpeed = speed,
                               .dt              = dt});
    result.force = result.tank.stiffness * pull;
    if (speed > 0) result.force -= result.tank.brake / speed * sliding;
    return result;
}

SessionSample Servo::tick(double time, double dt, double loopPeriod, const Hand& hand, const PatchNews* newest) noexcept
{
    const ProxyState& proxy = proxy_.step(hand.position);
    if (proxy.touching) {
        motion_.add(time, proxy.position);
    } else {
        motion_.forget();
        handOver_.restart();
    }
    touch_ = {touch_.sequence + 1, time, proxy.touching, proxy.position, proxy.normal, motion_.velocity()};

    const auto handed =
        handOver_.tick({proxy.position, time, dt, newest ? &newest->table : nullptr}); // also beyond the surface
    const double stiffness = handed ? feltStiffness(law_, handed->contactStiffness, handed->compliance) : 0;
    const Wanted want      = wanted(stiffness, dt, hand, proxy.pull);

    GovernorInput in;
    in.force                 = want.force;
    in.position              = hand.position;
    in.velocity              = hand.velocity;
    in.homed                 = hand.homed;
    in.inBox                 = hand.inBox;
    in.time                  = time;
    in.dt                    = dt;
    in.loopPeriod            = loopPeriod;
    in.admittedEnergy        = want.tank.used;
    in.storedEnergy          = want.tank.stored;
    const GovernorOutput out = governor_.step(in);

    SessionSample sample;
    sample.time   = time;
    sample.hip    = hand.position;
    sample.proxy  = proxy.position;
    sample.force  = out.force;
    sample.normal = proxy.touching ? proxy.normal : glm::dvec3(0);
    if (newest && proxy.touching) {
        sample.rigidity      = newest->rigidity;
        sample.maxDeflection = newest->mostResponse * glm::length(out.force);
        sample.errorEstimate = newest->errorEstimate;
        sample.iterations    = newest->iterations;
    }
    if (handed && proxy.touching) {
        sample.compliance = handed->compliance;
        sample.patchAge   = handed->age;
    }
    constexpr double kStalePeriods = 3; // two are ordinary: one to solve, one in use [1]
    sample.faults                  = static_cast<std::uint32_t>(out.fault) |
                    flag(SessionFlag::stalePatch, sample.patchAge > kStalePeriods * patchPeriod_) |
                    flag(SessionFlag::beyondTable, proxy.touching && handed && handed->clamped) |
                    flag(SessionFlag::noPatch, proxy.touching && !handed) |
                    flag(SessionFlag::proxyLimited, proxy.limited) |
                    flag(SessionFlag::beyondTheory, sample.maxDeflection > thickness_ / 2) |
                    flag(SessionFlag::governed, proxy.touching && out.actions != 0);
    return sample;
}

} // namespace palp
