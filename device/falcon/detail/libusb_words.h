#pragma once
#include <string>

namespace palp {

/// What libusb's numbers mean to a user. They are ints here: no header of ours names libusb's own types.

/// \param status  of a transfer that failed \return "it was unplugged", ...; a static text
[[nodiscard]] const char* transferFailure(int status) noexcept;

struct UsbRefusal {
    std::string why, help; ///< as FalconListing's
};

/// Why a device cannot be opened, and what to do.
/// \param error  of the call that opens or claims it
[[nodiscard]] UsbRefusal refusal(int error);

} // namespace palp
