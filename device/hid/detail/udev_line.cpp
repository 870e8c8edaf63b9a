#include "device/hid/detail/udev_line.h"

#include <array>
#include <cstdio>

namespace palp {

std::string udevLine(std::uint16_t vendor, std::uint16_t product)
{
    std::array<char, 160> line{};
    std::snprintf(line.data(), line.size(),
                  R"(KERNEL=="hidraw*", ATTRS{idVendor}=="%04x", ATTRS{idProduct}=="%04x", TAG+="uaccess")",
                  unsigned(vendor), unsigned(product));
    return line.data();
}

} // namespace palp
