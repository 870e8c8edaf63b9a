#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "device/hid/bridge_report.h"

namespace palp {

/// Finds the bridge's reports in a stream of bytes that may begin anywhere, lose bytes or hold others.
/// \thread one
class BridgeStream {
public:
    void feed(std::span<const std::uint8_t> bytes);

    /// Returns the next 64 bytes that begin as an answer does; only decode() proves them. Empty if more are needed.
    [[nodiscard]] std::optional<BridgeBytes> next();

private:
    std::vector<std::uint8_t> bytes_;
};

} // namespace palp
