#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "device/zero_rule.h"

namespace palp {

/// The host's command to a Falcon in one packet.
struct FalconCommand {
    std::array<std::int16_t, 3> motors{};       ///< [counts] top leg first, then clockwise seen from the front
    bool                        homing = false; ///< find the stops; set in every packet until all legs are homed
    std::uint8_t                lights = 0;     ///< a sum of DeviceLight

    friend bool operator==(const FalconCommand&, const FalconCommand&) = default;
};

/// A Falcon's answer to one packet.
struct FalconReply {
    std::array<std::int16_t, 3> encoders{};    ///< [counts] of the same legs; larger is further towards the user
    std::uint8_t                grip      = 0; ///< buttons: 1 plus, 2 forward, 4 centre, 8 minus
    std::uint8_t                homedLegs = 0; ///< bit i: leg i has met its stop, so its encoder is valid

    [[nodiscard]] bool homed() const noexcept { return homedLegs == 7; }

    friend bool operator==(const FalconReply&, const FalconReply&) = default;
};

/// One packet in either direction; 16 bytes out cause 16 bytes in.
///
///     byte   0   1-4 5-8 9-12                   13                                           14   15
///     out   '<'  three motors, int16 each,      bit 0 homing, 1 green, 2 blue, 3 red         0   '>'
///     in    '<'  three encoders, the same way   bits 0-3 grip, 4-6 leg homed                 ?   '>'
///
/// A number is four nibbles, the lowest first. Each byte between the brackets is sent as 0x41 + value, so that '<'
/// (0x3C) and '>' (0x3E) stand nowhere else.
/// \source   libnifalcon (BSD-3), src/firmware/FalconFirmwareNovintSDK.cpp and include/falcon/firmware/FalconFirmware.h
/// \differs  a comment there gives other colours to the lights and bit 4 to homing; its code does as above. The colours
///           have not been checked on a device yet.
using FalconPacket = std::array<std::uint8_t, 16>;

[[nodiscard]] FalconPacket encode(const FalconCommand& command) noexcept;
[[nodiscard]] FalconPacket encode(const FalconReply& reply) noexcept; ///< as a device does; for the emulator

/// Decodes a packet.
/// \return empty if a byte of the packet is outside the range of its place
/// \thread pure, as the functions above; no allocation
[[nodiscard]] std::optional<FalconCommand> decodeCommand(std::span<const std::uint8_t, 16> bytes) noexcept;
[[nodiscard]] std::optional<FalconReply>   decodeReply(std::span<const std::uint8_t, 16> bytes) noexcept;

/// Packets that push, and their zero: motors at rest, lights and homing as they were. For a guardian process.
extern const ZeroRule kFalconZero;

/// Finds the replies in a stream of bytes that may be cut anywhere and may have lost or gained bytes.
///
/// Every '<' starts a packet, and a byte that cannot stand where it stands ends one. So each whole packet in the stream
/// is found, even after garbage: the next reply is at most 31 bytes away (the 15 last bytes of a packet whose start was
/// lost, and the next one). Packets have no checksum: a byte that changed to another one of its range passes.
/// \thread one; fixed memory
class FalconParser {
public:
    /// Most replies that wait for next(). The link answers one for one, so more than two or three wait only after a
    /// stall.
    static constexpr std::size_t kWaiting = 32;

    /// Takes bytes. If more than kWaiting replies wait, the oldest are discarded.
    void feed(std::span<const std::uint8_t> bytes) noexcept;

    /// Takes out the oldest waiting reply.
    /// \return empty if no further reply is complete
    [[nodiscard]] std::optional<FalconReply> next() noexcept;

    /// Returns the number of bytes discarded so far: garbage, broken packets, and replies that feed() discarded.
    [[nodiscard]] std::uint64_t skipped() const noexcept { return skipped_; }

private:
    FalconPacket                      packet_{};    ///< the incoming one
    std::size_t                       filled_ = 0;  ///< bytes of it; 0: waiting for '<'
    std::array<FalconReply, kWaiting> replies_{};   ///< a ring
    std::size_t                       oldest_  = 0; ///< in replies_
    std::size_t                       waiting_ = 0; ///< number of replies in replies_
    std::uint64_t                     skipped_ = 0;
};

} // namespace palp
