#include "device/hid/bridge_stream.h"

#include <algorithm>
#include <array>

namespace palp {
namespace {

constexpr std::array<std::uint8_t, 3> kStart{0x01, 'P', 'B'};          ///< of an answer, before its version
constexpr std::size_t                 kMostWaiting = 64 * kBridgeSize; ///< [byte] of a stream that is not read

} // namespace

void BridgeStream::feed(std::span<const std::uint8_t> bytes)
{
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    if (bytes_.size() > kMostWaiting) bytes_.erase(bytes_.begin(), bytes_.end() - std::ptrdiff_t(kMostWaiting));
}

std::optional<BridgeBytes> BridgeStream::next()
{
    auto start = std::search(bytes_.begin(), bytes_.end(), kStart.begin(), kStart.end());
    if (start == bytes_.end()) // its last bytes may be the start of a start
        start = bytes_.end() - std::ptrdiff_t(std::min(bytes_.size(), kStart.size() - 1));
    bytes_.erase(bytes_.begin(), start);
    if (bytes_.size() < kBridgeSize || !std::equal(kStart.begin(), kStart.end(), bytes_.begin())) return {};
    BridgeBytes report{};
    std::copy_n(bytes_.begin(), kBridgeSize, report.begin());
    // A report whose checksum is wrong has lost bytes, and the next one may begin within it.
    const std::uint16_t sum     = bridgeChecksum(std::span(report).first(kBridgeSize - 2));
    const bool          isWhole = report[kBridgeSize - 2] == (sum & 0xFFU) && report[kBridgeSize - 1] == sum >> 8U;
    bytes_.erase(bytes_.begin(), bytes_.begin() + (isWhole ? std::ptrdiff_t(kBridgeSize) : 1));
    return report;
}

} // namespace palp
