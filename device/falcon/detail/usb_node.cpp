#include "device/falcon/detail/usb_node.h"

#include <array>
#include <cstdio>

#include <fcntl.h>

namespace palp {

Guardian::Line openUsbNode(int bus, int address, int endpoint) noexcept
{
    std::array<char, 40> path{};
    std::snprintf(path.data(), path.size(), "/dev/bus/usb/%03d/%03d", bus, address);
    return {.fd = open(path.data(), O_RDWR | O_CLOEXEC), .endpoint = endpoint};
}

} // namespace palp
