#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "device/byte_line.h"

namespace palp {

/// A place at which a service listens.
struct TcpAddress {
    std::string   host = "127.0.0.1"; ///< a name or a number
    std::uint16_t port = 0;

    [[nodiscard]] std::string text() const { return host + ":" + std::to_string(port); }
};

/// Connects, without delays for small packets.
/// \param timeout  [s] for each of the host's addresses
/// \throws LineEnded saying why: an unknown host, a port at which nobody listens
[[nodiscard]] std::unique_ptr<ByteLine> connectTcp(const TcpAddress& address, double timeout);

} // namespace palp
