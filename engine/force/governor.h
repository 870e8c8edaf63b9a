#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/vec3.hpp>

#include "engine/core/enum_names.h"
#include "engine/core/governed_force.h"
#include "engine/core/running_median.h"

namespace palp {

/// Limits of the ForceGovernor. Sources: Hannaford & Ryu, time-domain passivity control (observer, controller);
/// Colgate & Brown and Hulin et al. (stiffness of a sampled spring); OpenHaptics, CHAI3D and the Force Dimension SDK
/// (what drivers limit by default); the Falcon's mass 0.46 kg and damping 3.2 N s/m are one published measurement.
struct GovernorSettings {
    double nominalPeriod = 1e-3; ///< [s] of the servo; used where a tick says that no time passed
    double longestTick   = 4e-3; ///< [s] a later tick lets a force grow by no more than this one
    double stall         = 0.1;  ///< [s] without a tick is a fault
    int    missedTicks   = 20;   ///< more exchanges without an answer, or ticks without time, in a row are a fault

    double staleAfter = 5e-3;  ///< [s] age up to which the last render force is held
    double staleRamp  = 20e-3; ///< [s] from there to zero

    double passivitySpeed   = 0.01; ///< [m/s] below it no damping: two encoder steps of 48 um in 15 ms are 0.006
    double passivityDamping = 20;   ///< [N s/m] the most that the controller adds; less on a light arm
    double passivityLeak    = 1;    ///< [s] time constant with which the energy is forgotten out of contact
    double energyReserve    = 2e-3; ///< [J] that E may exceed what the contact stores: what was dissipated is forgotten
    /// [J] most of E where the stored energy is unknown: 6 N in a spring of 100 N/m hold 0.18
    double energyLimit = 0.2;
    /// [J] E may be below zero by this without being called active: an encoder step of 48 um against 6 N.
    double energyTolerance = 0.3e-3;

    /// [N] the bound of every force that a scene may ask for: what the Falcon holds (published: 8.9 N and more for
    /// short)
    static constexpr double kMostForce = 8;
    /// [N] the bound of every weight that is carried: twice a Falcon's arm
    static constexpr double kMostWeight = 4;

    double maximumForce = 6;     ///< [N] that the hand feels, at most kMostForce
    double slew         = 1000;  ///< [N/s] an honest contact of 1000 N/m at 0.5 m/s needs 500
    double maximumSpeed = 1.2;   ///< [m/s] beyond it is a fault (OpenHaptics: 1.2)
    double faultRamp    = 20e-3; ///< [s] from a fault to zero force, at the latest

    double calmForce  = 0.2; ///< [N] below this ... (CHAI3D's "wait for small force")
    int    calmTicks  = 10;  ///< ... for this number of ticks, the force may come on
    double engageTime = 1.5; ///< [s] from zero force to all of it; 1 to 2

    double maximumStiffness = 1000; ///< [N/m] where the loop is not the limit
    double mass             = 0.46; ///< [kg] of the arm; 0: unknown
    double ownDamping       = 3.2;  ///< [N s/m] of the arm; 0: unknown, and nothing is credited
    /// [N/m] of an arm whose damping is unknown: what its maker states for a loop of 1 kHz.
    double statedStiffness = 1000;

    /// [N] by which gravity pulls the arm, in the frame of GovernorInput; at most kMostWeight. Nothing: unknown, or
    /// balanced by its maker. The output carries it.
    glm::dvec3 weight{};
    double     motorForce = kMostForce; ///< [N] of what the hand feels and what carries the arm together, at most
};

/// Reasons for which no force flows. The numbers are recorded: never reuse one.
enum class GovernorFault : std::uint8_t {
    none              = 0,
    forceNotFinite    = 1, ///< the render force, or an energy that comes with it
    positionNotFinite = 2,
    velocityNotFinite = 3,
    clockNotFinite    = 4, ///< dt
    clockStopped      = 5, ///< dt is not above zero, for more than settings.missedTicks ticks
    loopStalled       = 6, ///< dt is above settings.stall
    deviceLost        = 7, ///< more than settings.missedTicks exchanges without an answer
    tooFast           = 8  ///< faster than settings.maximumSpeed
};
constexpr auto namesOf(GovernorFault)
{
    using enum GovernorFault;
    return std::to_array<NamedValue<GovernorFault>>({{none, "none"},
                                                     {forceNotFinite, "force-not-finite"},
                                                     {positionNotFinite, "position-not-finite"},
                                                     {velocityNotFinite, "velocity-not-finite"},
                                                     {clockNotFinite, "clock-not-finite"},
                                                     {clockStopped, "clock-stopped"},
                                                     {loopStalled, "loop-stalled"},
                                                     {deviceLost, "device-lost"},
                                                     {tooFast, "too-fast"}});
}

/// Effects of a tick on the force; GovernorOutput::actions is a sum of these.
enum class GovernorAction : std::uint32_t {
    notHomed   = 1,
    outsideBox = 2,
    stale      = 4,  ///< held beyond its time, and less than wanted
    damped     = 8,  ///< by the passivity controller
    active     = 16, ///< the observed energy is below minus settings.energyTolerance
    clamped    = 32,
    slewed     = 64,
    waiting    = 128,  ///< no force until it was small for a while
    engaging   = 256,  ///< coming on
    releasing  = 512,  ///< going down to zero, to wait again
    late       = 1024, ///< a tick was so late that its force is less than wanted
    lifting    = 2048, ///< less than the arm's weight is carried: it comes on, or goes
    lettingGo  = 4096, ///< whoever drives the loop wants no force: GovernorInput::letGo
    clutched   = 8192, ///< GovernorInput::clutched
    jumped     = 16384 ///< the grip is where no hand can have moved it since the tick before
};

/// Input of one tick. Vectors share one frame.
struct GovernorInput {
    glm::dvec3 force{};             ///< [N] on the hand, wanted; the newest there is, however old
    double     forceAge = 0;        ///< [s] since it was computed; infinity if there has never been one
    double     overdue  = 0;        ///< [s] by which what it was computed from is too old; at most 0: it is not
    glm::dvec3 position{};          ///< [m] of the grip
    glm::dvec3 velocity{};          ///< [m/s] of the grip, filtered
    bool       homed    = false;    ///< the position is known
    bool       inBox    = false;    ///< the grip is where the device's kinematics are good, and they could be solved
    bool       letGo    = false;    ///< no force is wanted, of no kind: the program is about to stop
    bool       clutched = false;    ///< the place is not the grip's for now: no force but what carries the arm
    bool       behind   = false;    ///< the hand has not been in free space yet: no force comes on
    double     dt       = 0;        ///< [s] since the last tick
    int        missedExchanges = 0; ///< with the device, in a row

    double answerAge      = 0; ///< [s] of the position when its answer came: HapticState::age
    double sinceAnswer    = 0; ///< [s] from that answer to this tick
    double exchangePeriod = 0; ///< [s] from the answer before to that one; 0: one answer a tick

    double stiffness = 0; ///< [N/m] of the spring that `force` is of: EnergyTankOutput::stiffness; 0: it is of none
    double admittedEnergy = 0; ///< [J] that the tank let in this tick: EnergyTankOutput::used
    /// [J] in the contact's spring: EnergyTankOutput::stored. Infinity: unknown.
    double storedEnergy = std::numeric_limits<double>::infinity();
};

struct GovernorOutput {
    glm::dvec3    force{};   ///< [N] that the hand feels
    glm::dvec3    carried{}; ///< [N] against the arm's weight; the device is given the sum of both
    GovernorFault fault   = GovernorFault::none;
    std::uint32_t actions = 0; ///< see GovernorAction
    double        energy  = 0; ///< [J] E of the observer: what the hand has put in and not got back
    double        damping = 0; ///< [N s/m] of the passivity controller
    double        gain    = 0; ///< [1] of engagement and fault ramp

    [[nodiscard]] bool did(GovernorAction action) const noexcept
    {
        return (actions & static_cast<std::uint32_t>(action)) != 0;
    }
};

/// Checks every force before a device: no force leaves without it. Each tick takes these steps, in this order:
///
///   1  the input is credible: finite, the clock runs, the device answers           else fault, 0
///   2  homed, in the box and not clutched; moved by at most 1 mm and 4 m/s          else 0, then engage anew
///   3  fresh: held for 5 ms, to zero in 20 ms                                      then engage anew;
///      after a late tick as much of the force as a loop that is always so late bears
///   4  passivity: E -= f (x - x'); if E < 0, f -= alpha v
///   5  at most 6 N
///   6  at most 1 N/ms
///   7  at most 1.2 m/s                                 else fault, to zero in 20 ms; in free space engage anew
///   8  engaged: below 0.2 N for 10 ticks in the box, once in free space, then from nothing to all in 1.5 s
///   9  the arm's weight is carried: from nothing to all in 1.5 s once 1, 2, 3 and 7 have been passed for 10 ticks
///      in a row, else to nothing in 20 ms
///
/// While it waits (8) no force can flow, and a fast hand (7) only restarts the wait. A fault stays until reset(). Every
/// failure that a tick can see ends at exactly zero within 20 ms of ticks. The device scales forces to its motors.
///
/// What carries the arm (9) is a constant vector, so that it does no work in a closed cycle and has no lag; neither the
/// energy (4) nor the limits (5, 6) count it. It does not wait for a calm hand (8): uncarried, the arm presses 2 N into
/// the object, and the hand would never be calm. A clutch (2) leaves it as it is.
///
/// The lag of the loop, from the place of the hand to the middle of the time in which its force acts, is the age of the
/// answer, one period of exchanges (what an answer waits for a tick, and its force for the next packet, adds up to one)
/// and half the time for which a force is held. The cap, the energy and the tank's income all follow from it.
///
/// Invariants: the force is finite and at most maximumForce; nothing is allocated, locked or thrown.
/// \source Hannaford & Ryu 2002 for step 4
/// \thread the servo's
/// \differs (a) E is taken from the force that acted, damping, limits and the device's delay included, so what the
///          controller dissipates is not credited once more; (b) the part of the arm's own damping that the spring at
///          the cap takes is counted, without which an honest sampled spring looks active; (c) E is at most what the
///          contact stores plus a reserve, so that energy that was dissipated does not hide what comes later
class ForceGovernor {
public:
    /// \throws Error naming a setting out of its range
    explicit ForceGovernor(const GovernorSettings& settings = {});

    GovernorOutput step(const GovernorInput& in) noexcept;

    /// Returns what the last step() let through, as devices take it.
    [[nodiscard]] GovernedForce force() const noexcept { return GovernedForce(toDevice_); }

    /// Ends a fault that the operator has seen. The next tick finds a cause that lasts again; the force engages anew.
    void reset() noexcept;

    /// Returns the most that a force law may render [N/m]: min(maximum, 0.8 ownDamping / lag), with the median of the
    /// lag over the last 100 ticks. A spring of K with that lag takes K lag of the arm's damping; a released arm
    /// settles as long as some is left. Where the damping is unknown: min(maximum, statedStiffness 1.5 ms / lag), in
    /// which the lag is without the age of the answer, because who states a stiffness has measured it with that age. It
    /// falls and rises at once: pass the result through the tank, which pays for a rise.
    [[nodiscard]] double stiffnessCap() const noexcept { return cap_; }

    /// Returns the lag that the cap is for [s].
    [[nodiscard]] double lag() const noexcept { return lag_; }

    /// Returns what the spring at the cap leaves of the arm's damping [N s/m]; 0 if it is unknown.
    [[nodiscard]] double spareDamping() const noexcept { return usableDamping() - creditedDamping(); }

    /// Returns whether a grip cannot have moved so far in that time: a tracker that lost it, a frame that was moved, a
    /// device that counts anew.
    /// \param distance  [m]
    /// \param time      [s]
    [[nodiscard]] static bool isJump(double distance, double time) noexcept;

    [[nodiscard]] GovernorFault           fault() const noexcept { return fault_; }
    [[nodiscard]] const GovernorSettings& settings() const noexcept { return settings_; }

private:
    static constexpr std::size_t kSent = 64; ///< ticks; the slowest lines have a lag of 10
    static constexpr std::size_t kLags = 100;

    enum class Engagement : std::uint8_t { waiting, engaging, engaged, releasing };

    struct Elapsed {
        double rise; ///< [s] by which a force may grow
        double fall; ///< [s] by which it may fall
    };
    struct SentForce {
        glm::dvec3 force{};  ///< [N]
        double     from = 0; ///< [s] from when it acts, by the governor's clock
    };

    [[nodiscard]] Elapsed    elapsed(double dt) const noexcept;
    void                     measureLag(const GovernorInput& in) noexcept;
    [[nodiscard]] double     lagOf(const GovernorInput& in) const noexcept;
    [[nodiscard]] double     capFor(double lag) const noexcept;
    [[nodiscard]] double     usableDamping() const noexcept;
    [[nodiscard]] double     creditedDamping() const noexcept;
    [[nodiscard]] double     punctuality(const GovernorInput& in) const noexcept;
    [[nodiscard]] glm::dvec3 meanForce(double from, double until) const noexcept;
    void                     note(const glm::dvec3& sent, const GovernorInput& in) noexcept;
    void                     latch(GovernorFault fault) noexcept;
    void                     release() noexcept;
    [[nodiscard]] bool       hasJumped(const GovernorInput& in) const noexcept;
    [[nodiscard]] double     measuredAt(const GovernorInput& in) const noexcept;
    void                     checkInput(const GovernorInput& in) noexcept;
    [[nodiscard]] double     usableAge(const GovernorInput& in) const noexcept;
    [[nodiscard]] double     freshness(double age) const noexcept;
    void                     observeEnergy(const GovernorInput& in, double dt) noexcept;
    [[nodiscard]] glm::dvec3 passiveForce(glm::dvec3 force, const GovernorInput& in, double dt,
                                          GovernorOutput& out) const noexcept;
    [[nodiscard]] glm::dvec3 clampedForce(glm::dvec3 force, GovernorOutput& out) const noexcept;
    void                     slewTo(glm::dvec3 force, Elapsed passed, GovernorOutput& out) noexcept;
    void                     watchSpeed(const GovernorInput& in) noexcept;
    void                     engage(const GovernorInput& in, double rise, GovernorOutput& out) noexcept;
    void                     carry(const GovernorInput& in, Elapsed passed, GovernorOutput& out) noexcept;

    GovernorSettings             settings_;
    double                       lag_;            ///< [s]
    double                       cap_;            ///< [N/m]
    RunningMedian<kLags>         lags_, periods_; ///< [s] of loop and exchanges
    GovernorFault                fault_        = GovernorFault::none;
    double                       faultGain_    = 1;
    Engagement                   engagement_   = Engagement::waiting;
    double                       engageGain_   = 0;
    int                          calmTicks_    = 0;
    int                          stoppedTicks_ = 0;
    double                       energy_       = 0;
    double                       clock_        = 0; ///< [s] sum of all ticks
    glm::dvec3                   slewed_{};         ///< [N] after step 6
    std::array<SentForce, kSent> sent_{};           ///< by the last ticks, a ring
    std::size_t                  tick_ = 0;         ///< of the ring
    glm::dvec3                   lastPosition_{};   ///< [m]
    double                       lastMeasured_ = 0; ///< [s] when that was measured, by the governor's clock
    bool                         hasPosition_  = false;
    double                       forceless_    = 0; ///< [s] since a force was felt
    double                       carryGain_    = 0; ///< [1] share of the weight that is carried
    int                          carryTicks_   = 0; ///< in a row in which it may be
    glm::dvec3                   toDevice_{};       ///< [N]
};

} // namespace palp
