#pragma once
#include <cstdint>
#include <string>

namespace palp {

/// Returns the line for a file in /etc/udev/rules.d that lets the user who sits at the machine open this HID device.
[[nodiscard]] std::string udevLine(std::uint16_t vendor, std::uint16_t product);

} // namespace palp
