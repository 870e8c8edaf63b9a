#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "device/zero_rule.h"

// The bridge: an open report for haptic devices that people build themselves. device/README.md defines its bytes and
// rules; this header has the same fields in SI units and converts between the two.
namespace palp {

inline constexpr std::uint16_t kBridgeUsagePage = 0xFF00, kBridgeUsage = 0x0050; ///< by which a bridge is found
inline constexpr std::size_t   kBridgeSize  = 64; ///< [byte] including the report's number: one packet at full speed
inline constexpr unsigned      kBridgeMajor = 1;  ///< 0 to 15: another version has other bytes
inline constexpr unsigned      kBridgeMinor = 1;  ///< 0 to 15: a later version only uses reserved bytes

using BridgeBytes = std::array<std::uint8_t, kBridgeSize>;

/// Flags of a device; values are sums of these.
enum class BridgeFlag : std::uint16_t {
    motorsOn    = 1,  ///< it renders the force that it was last sent
    homed       = 2,  ///< the position is known
    inBox       = 4,  ///< within the workspace, and the kinematics could be solved
    stopped     = 8,  ///< it went to zero force by itself (watchdog, heat, ...) until a command without enable comes
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

/// The report from the device, about 1000 times a second, in the frame of HapticState.
struct BridgeAnswer {
    std::uint16_t sequence = 0; ///< increases by 1 with each report
    std::uint16_t flags    = 0; ///< a sum of BridgeFlag
    std::uint32_t buttons  = 0; ///< bit i: button i is down
    glm::dvec3    position{};   ///< [m] in steps of 1e-6
    glm::dvec3    velocity{};   ///< [m/s] filtered; in steps of 1e-3
    double        gripper = 0;  ///< [rad] in steps of 1e-3
    glm::dquat    orientation{1, 0, 0, 0};
    double        deviceTime = 0; ///< [s] in steps of 1e-6; wraps around after 4295 s
    std::uint16_t command    = 0; ///< sequence of the command that it renders
    glm::dvec3    rendered{};     ///< [N] present force of the motors; in steps of 1e-3

    // Description of the device; the same in every report.
    double   workspaceRadius  = 0; ///< [m] in steps of 1e-4
    double   maximumForce     = 0; ///< [N] in steps of 1e-3; 0: input only
    double   maximumStiffness = 0; ///< [N/m] in steps of 1
    double   maximumDamping   = 0; ///< [N s/m] in steps of 1e-3
    unsigned buttonCount      = 0; ///< at most 32
    double   ownDamping       = 0; ///< [N s/m] of the arm without its motors, in steps of 0.02; 0: unknown

    [[nodiscard]] bool has(BridgeFlag flag) const noexcept { return (flags & std::uint16_t(flag)) != 0; }
};

/// The report to the device.
struct BridgeCommand {
    std::uint16_t sequence = 0;     ///< increases by 1 with each report
    bool          enable   = false; ///< motors may be on
    bool          home     = false; ///< ask the user to home it
    glm::dvec3    force{};          ///< [N] in steps of 1e-3; without enable it counts as zero
    double        watchdog = 0;     ///< [s] without a good command until zero force; 1e-3 to 0.255
    std::uint8_t  lights   = 0;     ///< a sum of DeviceLight
};

enum class BridgeVerdict : std::uint8_t {
    good,
    notOurs,      ///< wrong size, number or mark
    otherVersion, ///< another major version
    damaged       ///< wrong checksum, or an orientation that is not a unit quaternion
};

/// Encodes a report. A value that does not fit into its field becomes the field's limit; one that is not finite becomes
/// 0.
[[nodiscard]] BridgeBytes encode(const BridgeAnswer& answer) noexcept;
[[nodiscard]] BridgeBytes encode(const BridgeCommand& command) noexcept;

/// \param out  written only if the verdict is good
[[nodiscard]] BridgeVerdict decode(std::span<const std::uint8_t> report, BridgeAnswer& out) noexcept;
[[nodiscard]] BridgeVerdict decode(std::span<const std::uint8_t> report, BridgeCommand& out) noexcept;

/// [1] by which the number of a guardian's zero is ahead of the report's that it follows, so that reports of a program
/// that was stopped and goes on are old; the program then counts on from beyond it.
inline constexpr std::uint16_t kBridgeZeroAhead = 0x2000;

/// Commands that push, and their zero: without enable, and ahead. For a guardian process.
extern const ZeroRule kBridgeZero;

/// Computes CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF, no reflection. "123456789" gives 0x29B1.
[[nodiscard]] std::uint16_t bridgeChecksum(std::span<const std::uint8_t> bytes) noexcept;

} // namespace palp
