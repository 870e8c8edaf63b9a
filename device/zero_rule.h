#pragma once
#include <cstdint>
#include <span>

namespace palp {

/// What a guardian process has to know of a device's packets: which of them push, and what says zero in their place.
/// Functions of the protocol, without state.
struct ZeroRule {
    /// Returns whether a device that receives this packet may push afterwards.
    bool (*pushes)(std::span<const std::uint8_t> packet) noexcept = nullptr;

    /// Turns a packet, in place, into one of zero force that the device takes after it.
    void (*silence)(std::span<std::uint8_t> packet) noexcept = nullptr;
};

} // namespace palp
