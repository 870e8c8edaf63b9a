#pragma once
#include "device/detail/guardian.h"

namespace palp {

/// Opens the node of a USB device, so that libusb and a guardian process work with one descriptor: what was claimed
/// through it is claimed for both.
/// \return a descriptor of the caller's, or fd -1 and errno
[[nodiscard]] Guardian::Line openUsbNode(int bus, int address, int endpoint) noexcept;

} // namespace palp
