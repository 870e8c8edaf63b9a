#pragma once
#include <cstdint>
#include <string>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "engine/core/enum_names.h"
#include "engine/core/governed_force.h"

namespace palp {

/// A device's identity and abilities. They are valid before open(), which adds what only the open device knows.
struct HapticDeviceInfo {
    std::string model;  ///< "Novint Falcon"
    std::string path;   ///< where it is plugged in, to distinguish two; may be empty
    std::string serial; ///< may be empty

    double workspaceRadius  = 0; ///< [m] of the sphere about the origin in which the kinematics are valid
    double maximumForce     = 0; ///< [N] that it holds in every direction in that sphere; 0: input only
    double maximumStiffness = 0; ///< [N/m] of a wall that it renders stably at 1 kHz
    double maximumDamping   = 0; ///< [N s/m]
    double mass             = 0; ///< [kg] of the arm as the grip feels it; 0: unknown
    double ownDamping       = 0; ///< [N s/m] of the arm without its motors; 0: unknown, and nothing is credited
    /// [N] by which gravity pulls the grip, in the device's frame. Nothing: unknown, or balanced by its maker; then the
    /// user carries what there is.
    glm::dvec3 weight{};

    unsigned buttons      = 0;     ///< number of buttons
    bool     needsHoming  = false; ///< its position is unknown until the user has moved it to its stops
    bool     rotates      = false; ///< senses its orientation
    bool     hasGripper   = false; ///< senses how far the grip is closed
    bool     isSimulation = false; ///< it has no hardware

    std::string note;   ///< a sentence that the user should read before a session; may be empty
    std::string homing; ///< what the user does to home it: "put the stylus into its holder"; empty: as a Falcon
};

/// Why a device gives no valid state. Numbers are recorded: never reuse one.
enum class DeviceFault : std::uint8_t {
    none        = 0,
    closed      = 1,  ///< not opened yet, or closed
    unplugged   = 2,  ///< it went away while open; call close(), and open() once it is back
    silent      = 3,  ///< more than 20 exchanges or 100 ms without an answer
    garbled     = 4,  ///< as many answers that are invalid
    kinematics  = 5,  ///< a position that is impossible for the arm
    ownWatchdog = 6,  ///< the device reports that it stopped by itself
    badForce    = 7,  ///< the requested force was not finite; it rendered none
    startingUp  = 8,  ///< it is being opened: upload, first exchange
    hostTooSlow = 9,  ///< render() was not called for 100 ms; the force was already zero
    linkLost    = 10, ///< the link to it broke and stays broken: call close(), and open() anew
    silenced    = 11  ///< the guardian process took the force, because nothing was sent for 25 ms; it passes
};
constexpr auto namesOf(DeviceFault)
{
    using enum DeviceFault;
    return std::to_array<NamedValue<DeviceFault>>({{none, "none"},
                                                   {closed, "closed"},
                                                   {unplugged, "unplugged"},
                                                   {silent, "silent"},
                                                   {garbled, "garbled"},
                                                   {kinematics, "kinematics"},
                                                   {ownWatchdog, "own-watchdog"},
                                                   {badForce, "bad-force"},
                                                   {startingUp, "starting-up"},
                                                   {hostTooSlow, "host-too-slow"},
                                                   {linkLost, "link-lost"},
                                                   {silenced, "silenced"}});
}

/// Returns whether a fault stays until close(): the session with that device is over.
[[nodiscard]] constexpr bool isFinal(DeviceFault fault) noexcept
{
    return fault == DeviceFault::unplugged || fault == DeviceFault::linkLost;
}

/// Returns whether a device tells its place all the same: one that has stopped by itself, or was silenced, goes on
/// answering.
[[nodiscard]] constexpr bool tellsPlace(DeviceFault fault) noexcept
{
    using enum DeviceFault;
    return fault == none || fault == ownWatchdog || fault == badForce || fault == hostTooSlow || fault == silenced;
}

/// The device as of its last good answer, in its own frame: x right, y up, z towards the user, the origin in the middle
/// of its workspace.
struct HapticState {
    double        time     = 0; ///< [s] when that answer came, by the clock given to read()
    double        age      = 0; ///< [s] of its position at that time
    std::uint64_t sequence = 0; ///< answers so far; unchanged if there was none since the last read()
    glm::dvec3    position{};   ///< [m]
    glm::dvec3    velocity{};   ///< [m/s] filtered
    glm::dquat    orientation{1, 0, 0, 0};
    glm::dvec3    angularVelocity{};    ///< [rad/s]
    double        gripperAngle = 0;     ///< [rad]
    std::uint32_t buttons      = 0;     ///< bit i: button i is down
    bool          homed        = false; ///< the position is known
    bool          inBox        = false; ///< within the workspace, and the kinematics could be solved
    bool          clutched     = false; ///< a clutch of its own is held, or was in a session that is replayed
    int           missed       = 0;     ///< exchanges without an answer, in a row; of devices behind a service or a
                                        ///< line of the system 20 in 100 ms, which may pause
    DeviceFault fault = DeviceFault::closed;
};

/// Lights of a device that has them; values are sums of these.
enum class DeviceLight : std::uint8_t { none = 0, red = 1, green = 2, blue = 4 };

/// One haptic device, real or simulated: the interface that a driver implements, and all that the engine knows of it.
///
/// Call open(), then every millisecond read(), compute the force, render(), and at last close(). A fault while open is
/// reported in the state, never as an exception.
/// \thread open, close and destruction on any one thread while neither read() nor render() runs; these on the servo's
class HapticDevice {
public:
    HapticDevice()                               = default;
    HapticDevice(const HapticDevice&)            = delete;
    HapticDevice& operator=(const HapticDevice&) = delete;
    virtual ~HapticDevice()                      = default; ///< every driver's destructor does what close() does

    [[nodiscard]] virtual const HapticDeviceInfo& info() const noexcept = 0;

    /// Makes it ready for read() and render(), which may take seconds (a firmware upload). Does nothing if it is open.
    /// \throws Error saying in one sentence what is missing and what helps
    virtual void open() = 0;

    /// Sends zero force, then releases the device. Does nothing if it is closed.
    virtual void close() noexcept = 0;

    /// Returns the state of the hand. Like render() it takes well below a millisecond, waits for no thread and
    /// allocates nothing.
    /// \param now  [s] of the servo's clock; simulated devices move on to it
    virtual HapticState read(double now) noexcept = 0;

    /// Renders `force` from now on: a driver with a thread hands it over at once, to leave with the next packet; a
    /// device without one takes it into the next read(). If it is not called, a driver with a thread holds the force
    /// for 5 ms and lets it fall to zero in 20 ms more; any other device does so by its own watchdog. After 100 ms the
    /// next state reports it.
    /// \param force  [N] in the device's frame
    virtual void render(const GovernedForce& force) noexcept = 0;

    /// Renders a force that is known before the state is: the two calls in one, for a caller that is no servo.
    HapticState exchange(const GovernedForce& force, double now) noexcept
    {
        render(force);
        return read(now);
    }

    /// Asks the user, by lights or words, to home a device that needs it. No force flows until HapticState::homed.
    virtual void home() noexcept {}

    /// Returns what the driver knows about the last fault beyond its name, for a person: a sentence of static storage,
    /// empty if it knows nothing. \thread that of read(), or any while none runs
    [[nodiscard]] virtual const char* faultWords() const noexcept { return ""; }

    /// Sets the lights from the next render() on, a sum of DeviceLight.
    virtual void light(std::uint8_t /*lights*/) noexcept {}
};

} // namespace palp
