#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

// The bridge: an open report for haptic devices that people build themselves. device/README.md has it byte by byte,
// with its rules; here are the same fields in SI units, and the way between.
namespace palp {

inline constexpr std::uint16_t kBridgeUsagePage = 0xFF00, kBridgeUsage = 0x0050; ///< how a bridge is found among others
inline constexpr std::size_t   kBridgeSize  = 64; ///< [byte] with the report's number: one packet at full speed
inline constexpr unsigned      kBridgeMajor = 1;  ///< 0 to 15: another one means other bytes
inline constexpr unsigned      kBridgeMinor = 0;  ///< 0 to 15: a later one only fills what was reserved

using BridgeBytes = std::array<std::uint8_t, kBridgeSize>;

/// What a device says; a sum of these.
enum class BridgeFlag : std::uint16_t {
    motorsOn    = 1, ///< it renders the force that it was last sent
    homed       = 2, ///< the position is known
    inBox       = 4, ///< within the workspace, and the kinematics could be solved
    stopped     = 8, ///< it went to zero by itself (watchdog, heat, ...) and stays there until a command without enable
    rotates     = 16, ///< the orientation is measured
    grips       = 32, ///< the gripper's angle is measured
    needsHoming = 64
};
[[nodiscard]] constexpr std::uint16_t operator|(BridgeFlag a, BridgeFlag b) noexcept
{
    return std::uint16_t(std::uint16_t(a) | std::uint16_t(b));
}
[[nodiscard]] constexpr std::uint16_t operator|(std::uint16_t a, BridgeFlag b) noexcept
{
    return std::uint16_t(a | std::uint16_t(b));
}

/// From the device, about 1000 times a second. Frame as in HapticState.
struct BridgeAnswer {
    std::uint16_t sequence = 0; ///< one more for each report
    std::uint16_t flags    = 0; ///< of BridgeFlag
    std::uint32_t buttons  = 0; ///< bit i: button i is down
    glm::dvec3    position{};   ///< [m] in steps of 1e-6
    glm::dvec3    velocity{};   ///< [m/s] filtered; in steps of 1e-3
    double        gripper = 0;  ///< [rad] in steps of 1e-3
    glm::dquat    orientation{1, 0, 0, 0};
    double        deviceTime = 0; ///< [s] in steps of 1e-6; starts anew after 4295 s
    std::uint16_t command    = 0; ///< sequence of the command that it renders
    glm::dvec3    rendered{};     ///< [N] what the motors do now; in steps of 1e-3

    // What it is; the same in every report.
    double   workspaceRadius  = 0; ///< [m] in steps of 1e-4
    double   maximumForce     = 0; ///< [N] in steps of 1e-3; 0: input only
    double   maximumStiffness = 0; ///< [N/m] in steps of 1
    double   maximumDamping   = 0; ///< [N s/m] in steps of 1e-3
    unsigned buttonCount      = 0; ///< at most 32

    [[nodiscard]] bool has(BridgeFlag flag) const noexcept { return (flags & std::uint16_t(flag)) != 0; }
};

/// To the device.
struct BridgeCommand {
    std::uint16_t sequence = 0;     ///< one more for each report
    bool          enable   = false; ///< motors may be on
    bool          home     = false; ///< ask the user to home it
    glm::dvec3    force{};          ///< [N] in steps of 1e-3; without enable it counts as none
    double        watchdog = 0;     ///< [s] without a good command, to zero force; 1e-3 to 0.255
    std::uint8_t  lights   = 0;     ///< of DeviceLight
};

enum class BridgeVerdict : std::uint8_t {
    good,
    notOurs,      ///< wrong size, number or mark
    otherVersion, ///< another major version
    damaged       ///< the checksum does not fit, or an orientation is none
};

/// What does not fit into its field ends at the field's limit; what is not finite counts as 0.
[[nodiscard]] BridgeBytes encode(const BridgeAnswer& answer) noexcept;
[[nodiscard]] BridgeBytes encode(const BridgeCommand& command) noexcept;

/// \param out  written only if the verdict is good
[[nodiscard]] BridgeVerdict decode(std::span<const std::uint8_t> report, BridgeAnswer& out) noexcept;
[[nodiscard]] BridgeVerdict decode(std::span<const std::uint8_t> report, BridgeCommand& out) noexcept;

/// CRC-16/CCITT-FALSE: polynomial 0x1021, starts at 0xFFFF, nothing reflected. "123456789" gives 0x29B1.
[[nodiscard]] std::uint16_t bridgeChecksum(std::span<const std::uint8_t> bytes) noexcept;

} // namespace palp
