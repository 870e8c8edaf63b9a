#pragma once
#include <string>

namespace palp {

// Explains libusb's numbers to users. They are ints here: no header of Palpate names libusb's own types.

/// Explains why a transfer failed.
/// \param status  of that transfer
/// \return a static text such as "it was unplugged"
[[nodiscard]] const char* transferFailure(int status) noexcept;

struct UsbRefusal {
    std::string why, help; ///< as in FalconListing
};

/// Explains why a device cannot be opened, and what to do.
/// \param error  of the call that opens or claims it
[[nodiscard]] UsbRefusal refusal(int error);

} // namespace palp
