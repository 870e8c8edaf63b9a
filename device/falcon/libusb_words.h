#pragma once
#include "device/falcon/libusb_link.h"

namespace palp {

/// What libusb's numbers mean to a user. They are ints here: no header of ours names libusb's own types.

/// \param status  of a transfer that failed \return "it was unplugged", ...; a static text
[[nodiscard]] const char* transferFailure(int status) noexcept;

/// Fills in why a device cannot be opened, and what to do. \param error  of the call that opens or claims it
void explainRefusal(FalconListing& listing, int error);

} // namespace palp
