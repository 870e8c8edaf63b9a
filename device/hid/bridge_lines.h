#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "device/hid/hid_bridge.h"
#include "device/hid/hid_port.h"

// The bridge's report over lines other than USB's HID: datagrams of UDP, and the bytes of a serial port.
namespace palp {

/// Where a bridge is, other than on USB.
struct BridgeLine {
    enum class Kind : std::uint8_t { udp, serial };

    Kind          kind = Kind::udp;
    std::string   place{};  ///< of udp: the address of this machine to listen at; of a serial port its node
    std::uint16_t port = 0; ///< of udp
};

/// Reads "udp:PORT", "udp:HOST:PORT" or "serial:NODE"; empty if a text begins with neither.
/// \throws Error naming what was found
[[nodiscard]] std::optional<BridgeLine> parseBridgeLine(std::string_view text);

/// Opens such a line.
///
/// By UDP this side listens, and the first that sends a report is the device: commands go to it, and others are not
/// heard until it was silent for a second. A serial port is set to raw bytes; its speed is left to USB.
/// \throws HidRefused saying why
[[nodiscard]] std::unique_ptr<HidPort> openBridgeLine(const BridgeLine& line);

/// Makes the bridge at such a line: the driver is that of USB.
[[nodiscard]] std::unique_ptr<HapticDevice> makeLineBridge(const BridgeLine& line, HidBridgeSettings settings = {});

} // namespace palp
