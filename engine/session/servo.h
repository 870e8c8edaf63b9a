#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "device/haptic_device.h"
#include "engine/contact/proxy.h"
#include "engine/core/enum_names.h"
#include "engine/force/ahead.h"
#include "engine/force/compliance_tracker.h"
#include "engine/force/energy_tank.h"
#include "engine/force/governor.h"
#include "engine/force/lateral_lean.h"
#include "engine/force/relaxing_contact.h"
#include "engine/session/scene.h"
#include "engine/session/tick_record.h"

namespace palp {

/// The deformation's message to the servo about one patch. The solver writes it where the servo reads it.
struct PatchUpdate {
    ComplianceTable table;             ///< with sequence number and time
    double          rigidity      = 0; ///< D in the middle [N m]
    double          mostResponse  = 0; ///< largest deflection per force [m/N]
    double          errorEstimate = 0; ///< of the plate's solution, relative [1]
    std::int32_t    iterations    = 0; ///< of the plate's solver
    DepthShape      shape{};           ///< of the force over the depth of the hand, see Large; none: it is straight
};

/// The servo's message to the deformation about the touch.
struct Touch {
    std::uint64_t sequence = 0; ///< counts ticks; 0: none yet
    double        time     = 0; ///< [s]
    bool          touching = false;
    glm::dvec3    point{};    ///< [m] of the proxy, which is the hand's in free space
    glm::dvec3    outward{};  ///< [1] normal there, towards the hand; nothing in free space
    glm::dvec3    velocity{}; ///< of the proxy over its last 10 ms, in contact along the surface [m/s]
};

/// Bits of TickRecord::faults. The low eight are the governor's fault as a number, see GovernorFault.
enum class SessionFlag : std::uint32_t {
    stalePatch   = 1U << 8,  ///< the plate's answer in use is older than three of its periods
    beyondTable  = 1U << 9,  ///< the contact lies beyond the table's reach, or no table was there yet
    noPatch      = 1U << 10, ///< in contact, and no answer of the plate yet: no force
    proxyLimited = 1U << 11, ///< the proxy ran out of iterations
    beyondTheory = 1U << 12, ///< the deflection exceeds half the thickness, or twice it with large deflections
    governed     = 1U << 13, ///< the governor held the force back: damped, clamped, slewed, waiting or coming on
    oldTable     = 1U << 14  ///< the plate's answer is too old to feel: the force fades in 20 ms, and engages anew
};

/// The state of the hand as a device reports it.
struct Hand {
    glm::dvec3    position{};     ///< of the HIP [m]
    glm::dvec3    velocity{};     ///< filtered [m/s]
    bool          homed   = true; ///< see GovernorInput
    bool          inBox   = true;
    int           missed  = 0; ///< exchanges with the device without an answer, in a row
    DeviceFault   device  = DeviceFault::none;
    std::uint32_t buttons = 0; ///< of the device, the lower 16

    double        answerTime = 0;          ///< [s] when the device's answer came
    double        answerAge  = 0;          ///< [s] of the position at that time
    std::uint64_t sequence   = 0;          ///< of the answer; 0: nothing is known of its time
    glm::dquat    orientation{1, 0, 0, 0}; ///< of the grip; recorded and drawn only
    double        grip     = 0;            ///< [rad] by which the grip is open; recorded only
    bool          letGo    = false;        ///< see GovernorInput
    bool          clutched = false;        ///< likewise

    /// Returns whether its place is known; and whether a force may flow, too.
    [[nodiscard]] bool hasPlace() const noexcept { return homed && tellsPlace(device); }
    [[nodiscard]] bool isThere() const noexcept { return homed && device == DeviceFault::none; }

    /// Packs faults, flags and buttons into TickRecord::device; setBits() reads it back.
    [[nodiscard]] std::uint32_t bits() const noexcept
    {
        return static_cast<std::uint32_t>(device) | (homed ? kHomed : 0U) | (inBox ? kInBox : 0U) |
               (letGo ? kLetGo : 0U) | (clutched ? kClutched : 0U) | buttons << 16U;
    }
    void setBits(std::uint32_t bits) noexcept
    {
        device   = static_cast<DeviceFault>(bits & 0xFFU);
        homed    = (bits & kHomed) != 0;
        inBox    = (bits & kInBox) != 0;
        letGo    = (bits & kLetGo) != 0;
        clutched = (bits & kClutched) != 0;
        buttons  = bits >> 16U;
    }

private:
    static constexpr std::uint32_t kHomed = 1U << 8, kInBox = 1U << 9, kLetGo = 1U << 10, kClutched = 1U << 11;
};

/// The division of work between threads in real time; see runReal().
enum class SessionThreads {
    servo, ///< one thread from the hand to the force
    paper  ///< proxy and force on threads of their own, as Kumari & Chaudhuri run them
};
constexpr auto namesOf(SessionThreads)
{
    using enum SessionThreads;
    return std::to_array<NamedValue<SessionThreads>>({{servo, "servo"}, {paper, "paper"}});
}

/// The contact of the hand: the proxy and its pull.
struct ProxyContact {
    Touch      touch;
    glm::dvec3 pull{};          ///< [m] from the hand to where the force law acts; see ProxyState
    glm::dvec3 lean{};          ///< [m] part of the pull: what the proxy was given beyond the hand; see LateralLean
    bool       limited = false; ///< the proxy ran out of iterations
    bool       behind  = false; ///< the hand has not been in free space yet: it began behind the surface, or somewhere
};

/// The first half of a tick: hand -> proxy.
/// \thread one; tick() allocates, locks, throws and prints nothing, and the same input gives the same bits
class ContactHalf {
public:
    /// \param object  outlives this
    /// \param from    [m] a place in free space from which the hand has come: a hand that begins behind a surface then
    ///                touches it until it is lifted off, and is not held inside; no force comes on before. Empty: it
    ///                begins in free space
    ContactHalf(const SoftObject& object, const Scene& scene, const std::optional<glm::dvec3>& from = {});

    /// Runs one tick of the proxy. It is first placed where a hand is known to be, since that place decides on which
    /// side of the surface it is. Later a hand whose place is not known stays, see Clutch.
    /// \param time  [s] of the session's clock
    /// \param lean  [m] the latest of the force, ForceHalf::lean()
    const ProxyContact& tick(double time, const Hand& hand, const glm::dvec3& lean) noexcept;

    [[nodiscard]] const Touch& touch() const noexcept { return held_.touch; }

private:
    Proxy        proxy_;
    RecentMotion motion_;
    ProxyContact held_;
    bool         isKnown_ = false; ///< the hand was somewhere
    bool         isFree_  = true;  ///< it was in free space
};

/// The time between two answers of a device.
class AnswerPeriod {
public:
    /// Takes the newest answer, or the same one again.
    /// \return [s] per answer from the one before to this one; 0: unknown
    double add(std::uint64_t sequence, double time) noexcept;

private:
    std::uint64_t sequence_ = 0;
    double        time_     = 0; ///< [s]
    double        period_   = 0; ///< [s]
};

/// The second half of a tick: pull -> compliance -> stiffness -> tank -> governor -> force.
///
/// Where a metre of the device is s metres of the scene, a spring of K in the scene is one of s K at the device,
/// because the force stays the same. Law, compliance, lean and relaxation live in the scene. Tank and governor protect
/// the device's loop, so they are given its metres: places, depths and speeds / s, stiffness and stiffening s times,
/// energies / s. At s = 1 the bits are those without.
/// \thread as ContactHalf
class ForceHalf {
public:
    /// The device's first button. Held down for 20 ms it resets the governor's fault, because the person who holds the
    /// device is its operator; a shorter press does not count, because packets may be corrupt. Where it is the clutch
    /// too, holding that resets a fault.
    static constexpr std::uint32_t kOperatorsButton = 1;
    static constexpr int           kPressTicks      = 20;

    /// \param limits  of the device, its weight in the scene's frame; they bound the values of the scene
    /// \param first   answers until there is a table, see ComplianceTracker; outlives this; null: nothing does
    explicit ForceHalf(const Scene& scene, const HapticDeviceInfo& limits = {}, const HomogeneousLaw* first = nullptr);

    /// The time of a tick, and its clock.
    struct TickTime {
        double time; ///< [s] of the session's clock
        double dt;   ///< [s] since the last tick
    };

    /// Runs one tick of the force.
    /// \param newest  the deformation's last update; null: none yet. It stays as it is while tableInUse() is its table
    /// \return the record of the tick, complete but for tickTime
    TickRecord tick(const TickTime& now, const Hand& hand, const ProxyContact& held,
                    const PatchUpdate* newest) noexcept;

    [[nodiscard]] const ForceGovernor&   governor() const noexcept { return governor_; }
    [[nodiscard]] const ComplianceTable* tableInUse() const noexcept { return compliance_.inUse(); } ///< null: none
    [[nodiscard]] const glm::dvec3& lean() const noexcept { return lean_.way(); } ///< [m] for the next proxy's tick

private:
    /// The wanted force and the payment for it, in the metres of the scene.
    struct WantedForce {
        glm::dvec3 force{};
        double     stiffness = 0; ///< force per pull [N/m]
        double     tangent   = 0; ///< elastic, at this depth [N/m]
        double     admitted  = 0; ///< [J] by the tank, and by material that got fresh
        double     stored    = 0; ///< [J]
        double     load      = 0; ///< [N] that dents the plate as deep as the hand is in it
    };
    [[nodiscard]] WantedForce wantedForce(const std::optional<LocalCompliance>& local, double dt, const Hand& hand,
                                          const ProxyContact& held) noexcept;
    void                 relax(WantedForce& want, const DepthLaw& law, double dt, const ProxyContact& held) noexcept;
    [[nodiscard]] double plateLoad(const WantedForce& want, const GovernorOutput& out,
                                   const ProxyContact& held) const noexcept;
    [[nodiscard]] double stiffnessOf(const std::optional<LocalCompliance>& local) const noexcept;
    [[nodiscard]] double stiffeningOf(const std::optional<LocalCompliance>& local) const noexcept;
    [[nodiscard]] double storedRatio(const LocalCompliance& one, const LocalCompliance& other,
                                     double depth) const noexcept;
    [[nodiscard]] StiffnessSlope slopeAt(const ProxyContact& held) const noexcept;
    void                         leanOn(const ProxyContact& held, const Hand& hand, const WantedForce& want) noexcept;

    [[nodiscard]] double   steepest() const noexcept { return governor_.stiffnessCap() / scale_; } ///< [N/m]
    [[nodiscard]] DepthLaw inScene(const DepthLaw& atDevice) const noexcept;

    /// Returns whether force and dent are the pull times a constant.
    [[nodiscard]] bool isSpring() const noexcept { return linear_ && stiffening_ == 0 && shape_.step == 0; }
    void               follow(const PatchUpdate* newest, double dt, bool touching) noexcept;

    [[nodiscard]] double        tableOverdue(const TickTime& now, bool touching, const PatchUpdate* newest,
                                             const std::optional<LocalCompliance>& handed) noexcept;
    [[nodiscard]] GovernorInput governorInput(const TickTime& now, const Hand& hand, const ProxyContact& held,
                                              const WantedForce& want) noexcept;
    [[nodiscard]] TickRecord    recordOf(const TickTime& now, const Hand& hand, const ProxyContact& held,
                                         const WantedForce& want, const GovernorOutput& out) const noexcept;

    ForceLaw          law_;
    double            thickness_;           ///< [m]
    bool              linear_;              ///< the material's force is stiffness times depth, if b is 0 here too
    double            ofScene_;             ///< b of the scene [1/m]
    double            stiffening_;          ///< b in this tick [1/m]
    DepthShape        shape_;               ///< of the force in this tick
    DepthShape        newestShape_;         ///< what it follows
    std::uint64_t     shapeOf_         = 0; ///< sequence of the table that it came with
    double            plateCompliance_ = 0; ///< c in this tick [m/N]
    double            patchPeriod_;         ///< of the deformation [s]
    double            scale_;               ///< metres of the scene per metre of the device [1]
    bool              resetsByClutch_;      ///< the operator's button is the scene's clutch
    AnswerPeriod      answers_;
    ComplianceTracker compliance_;
    LateralLean       lean_;
    EnergyTank        tank_;
    RelaxingContact   relaxing_;
    ForceGovernor     governor_;
    double            forceShare_ = 1;   ///< [1] of the elastic force that the last tick had
    ProxyContact      last_;             ///< of the tick before
    glm::dvec3        lastHand_{};       ///< [m]
    std::uint64_t     answered_ = 0;     ///< sequence of the last table
    double            asked_    = 0;     ///< [s] of contact since that of the last table, or since it began without one
    bool              touched_  = false; ///< in the tick before
    int               pressed_  = 0;     ///< ticks that the operator's button has been down
};

/// [1] of the arm's weight that is carried. A calibration errs by one percent; carried whole, an arm that is let go
/// might rise through the room at 6 mm/s. So it sinks, and rests on the surface, some 0.05 N deep.
inline constexpr double kCarried = 0.98;

/// Both halves of a tick of touch.
///
/// The calls are the same on every clock: the servo thread makes them each millisecond, a virtual session as fast as it
/// can.
/// \thread as its halves
class Servo {
public:
    Servo(const SoftObject& object, const Scene& scene, const HapticDeviceInfo& limits = {},
          const HomogeneousLaw* first = nullptr, const std::optional<glm::dvec3>& from = {})
        : contact_(object, scene, from), force_(scene, limits, first)
    {
    }

    TickRecord tick(const ForceHalf::TickTime& now, const Hand& hand, const PatchUpdate* newest) noexcept
    {
        return force_.tick(now, hand, contact_.tick(now.time, hand, force_.lean()), newest);
    }

    [[nodiscard]] const Touch&           touch() const noexcept { return contact_.touch(); }
    [[nodiscard]] const ForceGovernor&   governor() const noexcept { return force_.governor(); }
    [[nodiscard]] const ComplianceTable* tableInUse() const noexcept { return force_.tableInUse(); } ///< null: none

private:
    ContactHalf contact_;
    ForceHalf   force_;
};

} // namespace palp
