#include "device/hid/detail/udev_line.h"

#include <array>
#include <cstdio>

namespace palp {

std::string udevLine(std::uint16_t vendor, std::uint16_t product)
{
    std::array<char, 160> line{};
    std::snprintf(line.data(), line.size(), R"(KERNEL=="hidraw*", KERNELS=="*:%04X:%04X.*", TAG+="uaccess")",
                  unsigned(vendor),
                  unsigned(product)); // the kernel's name of an HID device on any bus; Bluetooth has no ATTRS{idVendor}
    return line.data();
}

} // namespace palp
