#include "device/hid/bridge_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace palp {
namespace {

constexpr std::uint8_t kAnswer = 1, kCommand = 2; // numbers of the reports
constexpr std::uint8_t kMark0 = 'P', kMark1 = 'B';
constexpr std::uint8_t kEnable = 1, kHome = 2;     // flags of a command
constexpr std::size_t  kChecked = kBridgeSize - 2; // [byte] before the checksum

constexpr double kMicro = 1e-6, kMilli = 1e-3, kTenthOfMilli = 1e-4; // steps of fields
constexpr double kLongestWatchdog = 0.255;                           // [s] that its byte holds
constexpr double kFiftieth        = 0.02;                            // [N s/m] up to 5.1
constexpr double kUnit            = 1.0 / 32767;                     // of a quaternion's parts

/// Writes fields one after the other, low byte first.
class Writer {
public:
    Writer(std::uint8_t number, std::uint16_t sequence)
    {
        for (std::uint8_t byte : {number, kMark0, kMark1, std::uint8_t(kBridgeMajor << 4 | kBridgeMinor)}) put(byte);
        put(sequence);
    }

    template <class Integer>
    void put(Integer value)
    {
        const auto bits = std::make_unsigned_t<Integer>(value);
        for (std::size_t n = 0; n < sizeof(Integer); ++n) bytes_[at_++] = std::uint8_t(bits >> (8 * n));
    }

    template <class Integer>
    void put(double value, double step)
    {
        using Limits         = std::numeric_limits<Integer>;
        const double rounded = std::isfinite(value) ? std::round(value / step) : 0;
        put(Integer(std::clamp(rounded, double(Limits::min()), double(Limits::max()))));
    }

    template <class Integer>
    void put(const glm::dvec3& value, double step)
    {
        for (int axis = 0; axis < 3; ++axis) put<Integer>(value[axis], step);
    }

    [[nodiscard]] BridgeBytes done()
    {
        at_ = kChecked; // reserved bytes stay 0
        put(bridgeChecksum(std::span(bytes_).first(kChecked)));
        return bytes_;
    }

private:
    BridgeBytes bytes_{};
    std::size_t at_ = 0;
};

class Reader {
public:
    explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    template <class Integer>
    [[nodiscard]] Integer get()
    {
        std::make_unsigned_t<Integer> bits = 0;
        for (std::size_t n = 0; n < sizeof(Integer); ++n)
            bits = std::make_unsigned_t<Integer>(bits | std::make_unsigned_t<Integer>(bytes_[at_++]) << (8 * n));
        return Integer(bits);
    }

    template <class Integer>
    [[nodiscard]] double get(double step)
    {
        return get<Integer>() * step;
    }

    template <class Integer>
    [[nodiscard]] glm::dvec3 getVector(double step)
    {
        const double x = get<Integer>(step), y = get<Integer>(step), z = get<Integer>(step);
        return {x, y, z};
    }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t                   at_ = 4; // behind number, mark and version
};

BridgeVerdict verdictOn(std::span<const std::uint8_t> report, std::uint8_t number)
{
    if (report.size() != kBridgeSize || report[0] != number || report[1] != kMark0 || report[2] != kMark1)
        return BridgeVerdict::notOurs;
    if (report[3] >> 4 != kBridgeMajor) return BridgeVerdict::otherVersion; // its checksum may be elsewhere
    const std::uint16_t sum = std::uint16_t(report[kChecked] | report[kChecked + 1] << 8);
    return sum == bridgeChecksum(report.first(kChecked)) ? BridgeVerdict::good : BridgeVerdict::damaged;
}

} // namespace

std::uint16_t bridgeChecksum(std::span<const std::uint8_t> bytes) noexcept
{
    unsigned sum = 0xFFFF;
    for (std::uint8_t byte : bytes) {
        sum ^= unsigned(byte) << 8;
        for (int bit = 0; bit < 8; ++bit) sum = (sum & 0x8000 ? sum << 1 ^ 0x1021 : sum << 1) & 0xFFFF;
    }
    return std::uint16_t(sum);
}

BridgeBytes encode(const BridgeAnswer& answer) noexcept
{
    Writer out(kAnswer, answer.sequence);
    out.put(answer.flags);
    out.put(answer.buttons);
    out.put<std::int32_t>(answer.position, kMicro);
    out.put<std::int16_t>(answer.velocity, kMilli);
    out.put<std::int16_t>(answer.gripper, kMilli);
    const glm::dquat& turn = answer.orientation;
    for (double part : {turn.w, turn.x, turn.y, turn.z}) out.put<std::int16_t>(part, kUnit);
    // The device's clock wraps around. The remainder of a number that is not finite is not finite; put() makes it 0.
    out.put<std::uint32_t>(std::fmod(std::round(answer.deviceTime / kMicro), 4294967296.0) * kMicro, kMicro);
    out.put(answer.command);
    out.put<std::int16_t>(answer.rendered, kMilli);
    out.put<std::uint16_t>(answer.workspaceRadius, kTenthOfMilli);
    out.put<std::uint16_t>(answer.maximumForce, kMilli);
    out.put<std::uint16_t>(answer.maximumStiffness, 1);
    out.put<std::uint16_t>(answer.maximumDamping, kMilli);
    out.put(std::uint8_t(std::min(answer.buttonCount, 32U)));
    out.put<std::uint8_t>(answer.ownDamping, kFiftieth);
    return out.done();
}

BridgeBytes encode(const BridgeCommand& command) noexcept
{
    Writer out(kCommand, command.sequence);
    out.put(std::uint16_t((command.enable ? kEnable : 0) | (command.home ? kHome : 0)));
    out.put<std::int16_t>(command.enable ? command.force : glm::dvec3(0), kMilli);
    // 0 would mean no watchdog, and put() makes 0 of what is not finite.
    out.put<std::uint8_t>(std::min(std::max(kMilli, command.watchdog), kLongestWatchdog), kMilli);
    out.put(command.lights);
    return out.done();
}

BridgeVerdict decode(std::span<const std::uint8_t> report, BridgeAnswer& out) noexcept
{
    const BridgeVerdict verdict = verdictOn(report, kAnswer);
    if (verdict != BridgeVerdict::good) return verdict;
    Reader       in(report);
    BridgeAnswer answer;
    answer.sequence = in.get<std::uint16_t>();
    answer.flags    = in.get<std::uint16_t>();
    answer.buttons  = in.get<std::uint32_t>();
    answer.position = in.getVector<std::int32_t>(kMicro);
    answer.velocity = in.getVector<std::int16_t>(kMilli);
    answer.gripper  = in.get<std::int16_t>(kMilli);
    const double w = in.get<std::int16_t>(kUnit), x = in.get<std::int16_t>(kUnit), y = in.get<std::int16_t>(kUnit),
                 z          = in.get<std::int16_t>(kUnit);
    answer.deviceTime       = in.get<std::uint32_t>(kMicro);
    answer.command          = in.get<std::uint16_t>();
    answer.rendered         = in.getVector<std::int16_t>(kMilli);
    answer.workspaceRadius  = in.get<std::uint16_t>(kTenthOfMilli);
    answer.maximumForce     = in.get<std::uint16_t>(kMilli);
    answer.maximumStiffness = in.get<std::uint16_t>();
    answer.maximumDamping   = in.get<std::uint16_t>(kMilli);
    answer.buttonCount      = std::min<unsigned>(in.get<std::uint8_t>(), 32);
    answer.ownDamping       = in.get<std::uint8_t>(kFiftieth); // 0 in version 1.0
    if (answer.has(BridgeFlag::rotates)) {
        const glm::dquat turn(w, x, y, z);
        if (glm::length(turn) < 0.5) return BridgeVerdict::damaged; // not a unit quaternion: the firmware left it empty
        answer.orientation = glm::normalize(turn);
    }
    out = answer;
    return verdict;
}

BridgeVerdict decode(std::span<const std::uint8_t> report, BridgeCommand& out) noexcept
{
    const BridgeVerdict verdict = verdictOn(report, kCommand);
    if (verdict != BridgeVerdict::good) return verdict;
    Reader in(report);
    out.sequence     = in.get<std::uint16_t>();
    const auto flags = in.get<std::uint16_t>();
    out.enable       = (flags & kEnable) != 0;
    out.home         = (flags & kHome) != 0;
    out.force        = in.getVector<std::int16_t>(kMilli);
    out.watchdog     = in.get<std::uint8_t>(kMilli);
    out.lights       = in.get<std::uint8_t>();
    if (!out.enable) out.force = {};
    return verdict;
}

const ZeroRule kBridgeZero{.pushes =
                               [](std::span<const std::uint8_t> report) noexcept {
                                   BridgeCommand command;
                                   return decode(report, command) == BridgeVerdict::good && command.enable;
                               },
                           .silence =
                               [](std::span<std::uint8_t> report) noexcept {
                                   BridgeCommand command;
                                   if (decode(report, command) != BridgeVerdict::good) return;
                                   command.sequence = std::uint16_t(command.sequence + kBridgeZeroAhead);
                                   command.enable   = false;
                                   command.force    = {};
                                   std::ranges::copy(encode(command), report.begin());
                               }};

} // namespace palp
