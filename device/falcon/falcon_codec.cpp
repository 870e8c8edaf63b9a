#include "device/falcon/falcon_codec.h"

#include <algorithm>

#include "device/haptic_device.h"

namespace palp {
namespace {

constexpr std::uint8_t kStart = 0x3C, kEnd = 0x3E; ///< '<' and '>'
constexpr std::uint8_t kZero = 0x41;               ///< 'A', the byte of the value 0

constexpr std::size_t kNumberSize = 4;  ///< [bytes] of one int16
constexpr std::size_t kFlags      = 13; ///< place of the byte of flags
constexpr std::size_t kUnknown    = 14; ///< place of the byte whose use is unknown

constexpr std::uint8_t kMostOfNibble = 0x0F, kMostOfReplyFlags = 0x7F;

/// Bits of the flags of a command.
constexpr std::uint8_t kHomingBit = 1, kGreenBit = 2, kBlueBit = 4, kRedBit = 8;

constexpr bool has(std::uint8_t lights, DeviceLight light)
{
    return (lights & std::uint8_t(light)) != 0;
}

FalconPacket pack(const std::array<std::int16_t, 3>& numbers, std::uint8_t flags) noexcept
{
    FalconPacket packet;
    packet.fill(kZero);
    packet.front() = kStart;
    packet.back()  = kEnd;
    for (std::size_t leg = 0; leg < 3; ++leg) {
        const auto bits = std::uint16_t(numbers[leg]);
        for (std::size_t n = 0; n < kNumberSize; ++n)
            packet[1 + kNumberSize * leg + n] = std::uint8_t(kZero + ((bits >> (4 * n)) & kMostOfNibble));
    }
    packet[kFlags] = std::uint8_t(kZero + flags);
    return packet;
}

/// Returns whether a byte may stand at this place of a packet. The content of the byte before the last one is unknown,
/// so any value from 0x41 up is accepted there.
constexpr bool fits(std::size_t place, std::uint8_t byte, std::uint8_t mostOfFlags)
{
    if (place == 0) return byte == kStart;
    if (place == sizeof(FalconPacket) - 1) return byte == kEnd;
    if (byte < kZero) return false;
    if (place == kUnknown) return true;
    return byte - kZero <= (place == kFlags ? mostOfFlags : kMostOfNibble);
}

/// The bytes of the motors in a command.
template <class Bytes>
auto motorsOf(std::span<Bytes> packet)
{
    return packet.subspan(1, 3 * kNumberSize);
}

bool isCommand(std::span<const std::uint8_t> packet) noexcept
{
    return packet.size() == sizeof(FalconPacket) && packet.front() == kStart && packet.back() == kEnd;
}

bool pushes(std::span<const std::uint8_t> packet) noexcept
{
    return isCommand(packet) && std::ranges::any_of(motorsOf(packet), [](std::uint8_t byte) { return byte != kZero; });
}

void silence(std::span<std::uint8_t> packet) noexcept
{
    if (isCommand(packet)) std::ranges::fill(motorsOf(packet), kZero); // firmware that is uploaded is none
}

struct Content {
    std::array<std::int16_t, 3> numbers{};
    std::uint8_t                flags = 0;
};

std::optional<Content> unpack(std::span<const std::uint8_t, 16> bytes, std::uint8_t mostOfFlags) noexcept
{
    for (std::size_t place = 0; place < bytes.size(); ++place)
        if (!fits(place, bytes[place], mostOfFlags)) return std::nullopt;

    Content content;
    for (std::size_t leg = 0; leg < 3; ++leg) {
        unsigned bits = 0;
        for (std::size_t n = 0; n < kNumberSize; ++n)
            bits |= unsigned(bytes[1 + kNumberSize * leg + n] - kZero) << (4 * n);
        content.numbers[leg] = std::int16_t(std::uint16_t(bits));
    }
    content.flags = std::uint8_t(bytes[kFlags] - kZero);
    return content;
}

} // namespace

const ZeroRule kFalconZero{pushes, silence};

FalconPacket encode(const FalconCommand& command) noexcept
{
    unsigned flags = command.homing ? kHomingBit : 0;
    if (has(command.lights, DeviceLight::green)) flags |= kGreenBit;
    if (has(command.lights, DeviceLight::blue)) flags |= kBlueBit;
    if (has(command.lights, DeviceLight::red)) flags |= kRedBit;
    return pack(command.motors, std::uint8_t(flags));
}

FalconPacket encode(const FalconReply& reply) noexcept
{
    return pack(reply.encoders, std::uint8_t((reply.grip & 0x0F) | (reply.homedLegs & 0x07) << 4));
}

std::optional<FalconCommand> decodeCommand(std::span<const std::uint8_t, 16> bytes) noexcept
{
    const std::optional<Content> content = unpack(bytes, kMostOfNibble);
    if (!content) return std::nullopt;
    FalconCommand command{content->numbers, (content->flags & kHomingBit) != 0};
    if (content->flags & kGreenBit) command.lights |= std::uint8_t(DeviceLight::green);
    if (content->flags & kBlueBit) command.lights |= std::uint8_t(DeviceLight::blue);
    if (content->flags & kRedBit) command.lights |= std::uint8_t(DeviceLight::red);
    return command;
}

std::optional<FalconReply> decodeReply(std::span<const std::uint8_t, 16> bytes) noexcept
{
    const std::optional<Content> content = unpack(bytes, kMostOfReplyFlags);
    if (!content) return std::nullopt;
    return FalconReply{content->numbers, std::uint8_t(content->flags & 0x0F), std::uint8_t(content->flags >> 4)};
}

void FalconParser::feed(std::span<const std::uint8_t> bytes) noexcept
{
    for (const std::uint8_t byte : bytes) {
        if (byte == kStart) { // an unfinished packet is discarded
            skipped_ += filled_;
            filled_ = 0;
        } else if (!fits(filled_, byte, kMostOfReplyFlags)) {
            skipped_ += filled_ + 1;
            filled_ = 0;
            continue;
        }
        packet_[filled_++] = byte;
        if (filled_ < packet_.size()) continue;

        filled_ = 0;
        if (waiting_ == kWaiting) {
            oldest_ = (oldest_ + 1) % kWaiting;
            --waiting_;
            skipped_ += packet_.size();
        }
        // Each byte was checked when it came, so there is a reply.
        replies_[(oldest_ + waiting_++) % kWaiting] = decodeReply(packet_).value_or(FalconReply{});
    }
}

std::optional<FalconReply> FalconParser::next() noexcept
{
    if (waiting_ == 0) return std::nullopt;
    const FalconReply reply = replies_[oldest_];
    oldest_                 = (oldest_ + 1) % kWaiting;
    --waiting_;
    return reply;
}

} // namespace palp
