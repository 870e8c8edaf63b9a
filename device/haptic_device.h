#pragma once
#include <cstdint>
#include <string>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "engine/core/enum_names.h"
#include "engine/core/governed_force.h"

namespace palp {

/// What a device is and can do. Valid before open(); what only the open device knows is filled in by it.
struct HapticDeviceInfo {
    std::string model;  ///< "Novint Falcon"
    std::string path;   ///< where it is plugged in, to tell two apart; may be empty
    std::string serial; ///< may be empty

    double workspaceRadius  = 0; ///< [m] of the sphere about the origin in which the kinematics are good
    double maximumForce     = 0; ///< [N] it holds in every direction of that sphere; 0: input only
    double maximumStiffness = 0; ///< [N/m] of a wall it renders stably at 1 kHz
    double maximumDamping   = 0; ///< [N s/m]

    unsigned buttons      = 0;     ///< how many
    bool     needsHoming  = false; ///< its position is unknown until the user has moved it to its stops
    bool     rotates      = false; ///< senses its orientation
    bool     hasGripper   = false; ///< senses how far the grip is closed
    bool     isSimulation = false; ///< no hardware behind it
};

/// Why a device gives no state, or no good one. Numbers are recorded: never reuse one.
enum class DeviceFault : std::uint8_t {
    none        = 0,
    closed      = 1, ///< not opened yet, or closed
    unplugged   = 2, ///< it went away while open; close(), and open() once it is back
    silent      = 3, ///< more than 20 exchanges or 100 ms without an answer; or the link broke: close(), and open()
    garbled     = 4, ///< answers that make no sense, as many
    kinematics  = 5, ///< a position that the arm cannot have
    ownWatchdog = 6, ///< the device says that it stopped by itself
    badForce    = 7, ///< it was asked for a force that is not finite; it rendered none
    startingUp  = 8, ///< being opened: upload, first exchange
    hostTooSlow = 9  ///< exchange() was not called for 100 ms; the force had long gone by then
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
                                                   {hostTooSlow, "host-too-slow"}});
}

/// The device as of its last good answer, in its own frame: x right, y up, z towards the user, the origin in the middle
/// of its workspace.
struct HapticState {
    double        time     = 0; ///< [s] of that answer, by the clock that exchange() is given
    std::uint64_t sequence = 0; ///< answers so far; unchanged: nothing new since the last exchange
    glm::dvec3    position{};   ///< [m]
    glm::dvec3    velocity{};   ///< [m/s] filtered
    glm::dquat    orientation{1, 0, 0, 0};
    glm::dvec3    angularVelocity{};    ///< [rad/s]
    double        gripperAngle = 0;     ///< [rad]
    std::uint32_t buttons      = 0;     ///< bit i: button i is down
    bool          homed        = false; ///< the position is known
    bool          inBox        = false; ///< within the workspace, and the kinematics could be solved
    int           missed       = 0;     ///< exchanges without an answer, in a row
    DeviceFault   fault        = DeviceFault::closed;
};

/// Lights, where a device has them; a sum of these.
enum class DeviceLight : std::uint8_t { none = 0, red = 1, green = 2, blue = 4 };

/// One haptic device, real or simulated: what a driver must offer, and all that the engine knows of it.
///
/// The life of one: open(); every millisecond exchange(); close(). Trouble while open is a state, never an exception.
/// \thread open, close and destruction on any one thread while no exchange runs; exchange() on the servo's
class HapticDevice {
public:
    HapticDevice()                               = default;
    HapticDevice(const HapticDevice&)            = delete;
    HapticDevice& operator=(const HapticDevice&) = delete;
    virtual ~HapticDevice()                      = default; ///< of every driver: as close()

    [[nodiscard]] virtual const HapticDeviceInfo& info() const noexcept = 0;

    /// Makes it ready for exchange(); may take seconds (a firmware upload). Open already: nothing.
    /// \throws Error, one sentence: what is missing and the one line that helps
    virtual void open() = 0;

    /// Zero force, then lets go of the device. Closed already: nothing.
    virtual void close() noexcept = 0;

    /// One tick: renders `force` from now on, and tells where the hand is. It takes well below a millisecond, waits for
    /// no thread and allocates nothing. If it is not called, a driver with a thread holds the force for 5 ms and lets
    /// it fall to zero in 20 ms more; any other device does so by its own watchdog. After 100 ms the next state says so.
    /// \param force  [N] in the device's frame
    /// \param now    [s] of the servo's clock; simulated devices move on to it
    virtual HapticState exchange(const GovernedForce& force, double now) noexcept = 0;

    /// Asks the user to home it, by lights or words, where that is needed. Until HapticState::homed no force flows.
    virtual void home() noexcept {}

    /// Lights from the next exchange on; a sum of DeviceLight.
    virtual void light(std::uint8_t /*lights*/) noexcept {}
};

} // namespace palp
