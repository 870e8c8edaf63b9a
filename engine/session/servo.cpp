#include "engine/session/servo.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "engine/session/clutch.h"

namespace palp {
namespace {

std::uint32_t flag(SessionFlag which, bool set) noexcept
{
    return set ? static_cast<std::uint32_t>(which) : 0U;
}

/// Returns the lower of what the scene wants and the device can do; 0 in a device's list states nothing.
double lower(double wanted, double possible)
{
    return possible > 0 ? std::min(wanted, possible) : wanted;
}

/// Sets the governor. A device without force moves nothing, so nothing can swing: it is given what the simulated arm
/// would be, whose figures are the defaults.
GovernorSettings governorOf(const Scene& scene, const HapticDeviceInfo& limits)
{
    GovernorSettings settings;
    settings.maximumForce     = lower(scene.maxForce, limits.maximumForce);
    settings.maximumStiffness = lower(scene.stiffnessCap, limits.maximumStiffness);
    if (limits.maximumForce > 0) {
        settings.mass            = limits.mass;
        settings.ownDamping      = limits.ownDamping;
        settings.statedStiffness = lower(settings.statedStiffness, limits.maximumStiffness);
        settings.weight          = kCarried * limits.weight;
        settings.motorForce      = lower(settings.motorForce, limits.maximumForce);
    }
    return settings;
}

constexpr double kFading = 30e-3; ///< [s] the governor takes 20 ms of it; the law that answers lasts until then

/// Returns how long a contact may last without an answer of the plate for it [s]; see ForceHalf::tableOverdue().
double longestWithoutTable(double patchPeriod)
{
    constexpr double kOldest = 0.25, kPeriods = 3; // [s] a hand moves 5 cm in it; [1]
    return std::max(kOldest, kPeriods * patchPeriod);
}

} // namespace

ContactHalf::ContactHalf(const SoftObject& object, const Scene& scene, const std::optional<glm::dvec3>& from)
    : proxy_(object, {scene.proxy, scene.staticFriction, scene.dynamicFriction})
{
    if (!from) return;
    proxy_.step(*from);
    held_.touch.point = *from;
    isFree_           = false;
}

const ProxyContact& ContactHalf::tick(double time, const Hand& hand, const glm::dvec3& lean) noexcept
{
    isKnown_ = isKnown_ || hand.hasPlace();
    if (!isKnown_) {
        held_.touch.time = time;
        held_.behind     = !isFree_;
        if (isFree_) held_.touch.point = hand.position;
        return held_;
    }
    const glm::dvec3  place = hand.position + lean;
    const ProxyState& proxy = proxy_.step(place);
    isFree_                 = isFree_ || (!proxy.touching && proxy.position == place);
    motion_.add(time, proxy.position);
    glm::dvec3 velocity = motion_.velocity();
    if (proxy.touching) velocity -= glm::dot(velocity, proxy.normal) * proxy.normal; // of the way down to the surface
    held_ = {{held_.touch.sequence + 1, time, proxy.touching, proxy.position, proxy.normal, velocity},
             proxy.pull + proxy.fade * lean,
             proxy.fade * lean,
             proxy.limited,
             !isFree_};
    return held_;
}

double AnswerPeriod::add(std::uint64_t sequence, double time) noexcept
{
    if (sequence == sequence_) return period_;
    if (sequence_ > 0 && sequence > sequence_ && time > time_) period_ = (time - time_) / double(sequence - sequence_);
    sequence_ = sequence;
    time_     = time;
    return period_;
}

ForceHalf::ForceHalf(const Scene& scene, const HapticDeviceInfo& limits, const HomogeneousLaw* first)
    : law_(scene.patch.forceLaw), thickness_(scene.material.thickness), linear_(scene.material.isLinear()),
      ofScene_(scene.material.stiffening), stiffening_(ofScene_), patchPeriod_(1 / scene.deformationRate),
      scale_(scene.workspaceScale), resetsByClutch_(clutchBit(scene) == kOperatorsButton),
      compliance_(scene.complianceLaw, first, longestWithoutTable(1 / scene.deformationRate) + kFading),
      relaxing_(scene.material.relaxation, scene.patch.footprintRadius), governor_(governorOf(scene, limits))
{
}

/// Goes towards the newest shape within some periods of the deformation, so that no step is felt; in free space at
/// once.
void ForceHalf::follow(const PatchUpdate* newest, double dt, bool touching) noexcept
{
    if (newest && newest->table.sequence != shapeOf_ && newest->table.usable() && newest->shape.usable()) {
        shapeOf_     = newest->table.sequence;
        newestShape_ = newest->shape;
    }
    if (shape_ == newestShape_) return;
    const double share = touching ? -std::expm1(-std::max(dt, 0.0) / patchPeriod_) : 1;
    shape_             = share < 1 ? between(shape_, newestShape_, share) : newestShape_;
}

namespace {

/// Returns the force that dents a linear plate as deep as this one is under a hand of this depth [N]. What lies in
/// series with the plate of compliance c is a spring.
double loadAt(const DepthLaw& law, double depth, double c) noexcept
{
    if (law.shape.step == 0 || !(law.stiffness > 0) || !(c > 0)) return law.stiffness * depth;
    return std::max(0.0, (depth - law.force(depth) * (1 / law.stiffness - c)) / c);
}

/// Returns whether a table is as good as one of now, for as long as nothing else says that its thread is alive.
bool lastsStill(const LocalCompliance& handed) noexcept
{
    constexpr double kLongest = 2; // [s]
    return handed.lasts && handed.age < kLongest;
}

} // namespace

ForceHalf::WantedForce ForceHalf::wantedForce(const std::optional<LocalCompliance>& local, double dt, const Hand& hand,
                                              const ProxyContact& held) noexcept
{
    const glm::dvec3& outward = held.touch.outward; // of the surface, whichever way friction tilts the pull
    const double      along   = glm::dot(hand.velocity, outward);
    const auto        tangent = [&](const glm::dvec3& v) { return v - glm::dot(v, outward) * outward; };
    const bool        slid    = held.touch.touching && last_.touch.touching;
    const glm::dvec3  way     = slid ? held.touch.point - last_.touch.point : glm::dvec3(0);

    const double depth = glm::length(held.pull), surface = depth > 0 ? std::max(depth, relaxing_.surface()) : depth;
    const EnergyTankOutput tank =
        tank_.step({.stiffness       = stiffnessOf(local) * scale_,
                    .depth           = surface / scale_,
                    .normalSpeed     = along / scale_,
                    .tangentialSpeed = glm::length(tangent(hand.velocity)) / scale_,
                    .dt              = dt,
                    .drag            = -glm::dot(tangent(held.pull), tangent(way)) * forceShare_ / (scale_ * scale_),
                    .spareDamping    = governor_.spareDamping(),
                    .stiffening      = stiffening_ * scale_,
                    .steepest        = governor_.stiffnessCap(),
                    .storedShare     = relaxing_.storedShare(),
                    .shape           = {shape_.step / scale_, shape_.tangents}});

    const DepthLaw law = inScene(tank.law);
    WantedForce    result{{}, law.secant(depth), law.mostTangent(depth), tank.used * scale_, tank.stored * scale_};
    plateCompliance_ = local ? local->compliance : 0;
    result.load      = loadAt(law, depth, plateCompliance_);
    if (relaxing_.relaxes()) relax(result, law, dt, held);
    result.force = result.stiffness * held.pull;
    return result;
}

/// Returns a law of the device's metres in those of the scene.
DepthLaw ForceHalf::inScene(const DepthLaw& atDevice) const noexcept
{
    return {atDevice.stiffness / scale_,
            atDevice.stiffening / scale_,
            atDevice.steepest / scale_,
            {atDevice.shape.step * scale_, atDevice.shape.tangents}};
}

/// Takes from the elastic force what the material under the finger has got used to.
void ForceHalf::relax(WantedForce& want, const DepthLaw& law, double dt, const ProxyContact& held) noexcept
{
    const double                  depth = glm::length(held.pull), elastic = law.force(depth);
    const RelaxingContact::Output out = relaxing_.step({law, depth, held.touch.point, dt});
    forceShare_                       = elastic > 0 ? out.force / elastic : 1;
    want.stiffness *= forceShare_;
    want.admitted += out.refreshed;
    want.stored = depth > 0 ? out.stored : 0; // what a surface stores that was left, no hand gets back
    want.load   = loadAt(law, relaxing_.surface(), plateCompliance_);
}

/// Returns the force that dents the plate as it is drawn [N]. A plate is linear, and stiffens only together with the
/// contact: a hand of this depth dents it as deep as that of a spring does, whatever force it feels.
double ForceHalf::plateLoad(const WantedForce& want, const GovernorOutput& out, const ProxyContact& held) const noexcept
{
    const double pressed = std::max(0.0, glm::dot(out.force, held.touch.outward));
    if (isSpring()) return pressed;
    const double     wanted = glm::length(want.force), pull = glm::length(held.pull);
    constexpr double kSome = 1e-3; // [1] of the load: below it a force says nothing about the share that is rendered
    const double     share = wanted > kSome * want.load ? std::min(1.0, glm::length(out.force) / wanted) : out.gain;
    return pull > 0 ? want.load * share * std::max(0.0, glm::dot(held.pull, held.touch.outward)) / pull : 0;
}

/// Returns the stiffness that is wanted [N/m].
double ForceHalf::stiffnessOf(const std::optional<LocalCompliance>& local) const noexcept
{
    if (!local) return 0;
    return std::min(feltStiffness(law_, local->contactStiffness, local->compliance), steepest());
}

/// Returns the b that is wanted [1/m].
double ForceHalf::stiffeningOf(const std::optional<LocalCompliance>& local) const noexcept
{
    return local ? local->stiffening.value_or(ofScene_) : ofScene_;
}

/// Returns what a contact at one place stores, as a multiple of what it does at the other [1].
double ForceHalf::storedRatio(const LocalCompliance& one, const LocalCompliance& other, double depth) const noexcept
{
    const DepthLaw here{stiffnessOf(one), stiffeningOf(one), steepest(), shape_};
    const DepthLaw there{stiffnessOf(other), stiffeningOf(other), steepest(), shape_};
    if (here.isSpring() && there.isSpring()) return here.stiffness / there.stiffness;
    const double more = here.energy(depth), less = there.energy(depth);
    return more > 0 && less > 0 ? more / less : 1;
}

/// Takes the slope of what is stored from its differences over a way on which a table's cubics are straight.
StiffnessSlope ForceHalf::slopeAt(const ProxyContact& held) const noexcept
{
    const glm::dvec3 place = held.touch.point - held.lean, outward = held.touch.outward;
    const double     depth = glm::length(held.pull - held.lean);
    constexpr double kWay  = 20e-6; // [m] a cubic of 4 mm loses 1e-5 of its slope
    const glm::dvec3 other = std::abs(outward.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 one = glm::normalize(glm::cross(outward, other)), two = glm::cross(outward, one);
    StiffnessSlope   slope;
    for (const glm::dvec3& along : {one, two}) {
        const auto ahead = compliance_.near(place + kWay * along), behind = compliance_.near(place - kWay * along);
        if (stiffnessOf(ahead) > 0 && stiffnessOf(behind) > 0)
            slope.ofLogarithm += std::log(storedRatio(*ahead, *behind, depth)) / (2 * kWay) * along;
        if (ahead) slope.curvature = ahead->curvature;
    }
    return slope;
}

/// Updates the lean for the next tick.
void ForceHalf::leanOn(const ProxyContact& held, const Hand& hand, const WantedForce& want) noexcept
{
    if (held.touch.touching) {
        StiffnessSlope slope = slopeAt(held);
        if (!isSpring() && want.stiffness > 0) slope.leverage = want.stored / want.stiffness;
        lean_.step(slope, held.pull, glm::length(hand.position - lastHand_));
    } else {
        lean_.end();
    }
    lastHand_ = hand.position;
    last_     = held;
}

/// Returns by how much the plate's answer is too old to be felt [s]; at most 0 while it is not. Time in the air does
/// not count, because nothing is asked then. A deformation at less than 12 Hz has three of its periods.
///
/// A contact that begins with the homogeneous law, or with nothing, has all of that time anew. One that begins on a
/// table has what its predecessors left of it: a table that is too old is not felt again because the hand was lifted.
/// While a table that lasts reaches the contact nothing is asked: the next window of an object may take half a second.
double ForceHalf::tableOverdue(const TickTime& now, bool touching, const PatchUpdate* newest,
                               const std::optional<LocalCompliance>& handed) noexcept
{
    if (newest && newest->table.sequence != answered_ && newest->table.usable()) {
        answered_ = newest->table.sequence;
        if (!newest->table.ended) asked_ = now.time - newest->table.time; // that was as good as new while it lasted
    }
    const bool tableInUse = handed && !handed->guessed;
    if ((touching && !touched_ && !tableInUse) || (handed && lastsStill(*handed))) asked_ = 0;
    touched_ = touching;
    if (touching) asked_ += now.dt;
    return touching ? asked_ - longestWithoutTable(patchPeriod_) : 0;
}

TickRecord ForceHalf::tick(const TickTime& now, const Hand& hand, const ProxyContact& held,
                           const PatchUpdate* newest) noexcept
{
    const bool press = hand.isThere() && ((hand.buttons & kOperatorsButton) != 0 || (resetsByClutch_ && hand.clutched));
    pressed_         = press ? pressed_ + 1 : 0;
    if (pressed_ == kPressTicks) governor_.reset();

    const Touch& touch = held.touch;
    const auto handed  = compliance_.tick({touch.point - held.lean, now.time, now.dt, newest ? &newest->table : nullptr,
                                           touch.touching}); // also in free space
    stiffening_        = stiffeningOf(handed);
    follow(newest, now.dt, touch.touching);
    const WantedForce want = wantedForce(handed, now.dt, hand, held);
    leanOn(held, hand, want);

    GovernorInput in = governorInput(now, hand, held, want);
    in.overdue       = tableOverdue(now, touch.touching, newest, handed);

    const GovernorOutput out    = governor_.step(in);
    TickRecord           record = recordOf(now, hand, held, want, out);
    if (newest && touch.touching) {
        record.rigidity      = newest->rigidity;
        record.maxDeflection = newest->mostResponse * plateLoad(want, out, held);
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
        flag(SessionFlag::stalePatch,
             record.patchAge > kStalePeriods * patchPeriod_ && !(handed && lastsStill(*handed))) |
        flag(SessionFlag::beyondTable, touch.touching && handed && handed->clamped) |
        flag(SessionFlag::noPatch, touch.touching && !handed) | flag(SessionFlag::proxyLimited, held.limited) |
        flag(SessionFlag::beyondTheory, record.maxDeflection > thickness_ * (shape_.step > 0 ? 2 : 0.5)) |
        flag(SessionFlag::oldTable, in.overdue > 0) | flag(SessionFlag::governed, touch.touching && out.actions != 0);
    return record;
}

GovernorInput ForceHalf::governorInput(const TickTime& now, const Hand& hand, const ProxyContact& held,
                                       const WantedForce& want) noexcept
{
    GovernorInput in;
    in.force           = want.force;
    in.position        = hand.position / scale_;
    in.velocity        = hand.velocity / scale_;
    in.homed           = hand.isThere();
    in.inBox           = hand.inBox;
    in.letGo           = hand.letGo;
    in.clutched        = hand.clutched;
    in.behind          = held.behind;
    in.dt              = now.dt;
    in.forceAge        = std::max(0.0, now.time - held.touch.time); // above 0 if the proxy has a thread of its own
    in.missedExchanges = hand.missed;
    in.admittedEnergy  = want.admitted / scale_;
    in.storedEnergy    = want.stored / scale_;
    in.stiffness       = want.tangent * scale_;
    in.answerAge       = hand.answerAge;
    in.sinceAnswer     = hand.sequence > 0 ? std::max(0.0, now.time - hand.answerTime) : 0;
    in.exchangePeriod  = answers_.add(hand.sequence, hand.answerTime);
    return in;
}

/// Returns what is known of a tick without the plate's answer.
TickRecord ForceHalf::recordOf(const TickTime& now, const Hand& hand, const ProxyContact& held, const WantedForce& want,
                               const GovernorOutput& out) const noexcept
{
    TickRecord record;
    record.time           = now.time;
    record.hip            = hand.position;
    record.hipVelocity    = hand.velocity;
    record.orientation    = hand.orientation;
    record.grip           = hand.grip;
    record.device         = hand.bits();
    record.missed         = hand.missed;
    record.answers        = static_cast<std::uint32_t>(hand.sequence);
    record.answerTime     = hand.answerTime;
    record.answerAge      = hand.answerAge;
    record.proxy          = held.touch.point;
    record.wanted         = want.force;
    record.force          = out.force;
    record.actions        = out.actions;
    record.stiffness      = want.stiffness;
    record.tankEnergy     = tank_.energy();
    record.observerEnergy = out.energy;
    record.normal         = held.touch.touching ? held.touch.outward : glm::dvec3(0);
    return record;
}

} // namespace palp
