#include "device/falcon/detail/libusb_words.h"

#include <libusb.h>

#include "device/falcon/detail/libusb_link.h"

namespace palp {

const char* transferFailure(int status) noexcept
{
    switch (status) {
    case LIBUSB_TRANSFER_NO_DEVICE:
        return "it was unplugged";
    case LIBUSB_TRANSFER_STALL:
        return "it refused (stall)";
    case LIBUSB_TRANSFER_OVERFLOW:
        return "it sent too much at once";
    case LIBUSB_TRANSFER_TIMED_OUT:
        return "it took too long";
    default:
        return "the transfer failed";
    }
}

UsbRefusal refusal(int error)
{
    switch (error) {
    case LIBUSB_ERROR_ACCESS:
        return {"no permission to open it",
                "put this line into /etc/udev/rules.d/70-palpate-falcon.rules and plug it in anew: " +
                    std::string(kFalconUdevLine)};
    case LIBUSB_ERROR_BUSY:
        return {"a program has it open already", "end the other program that uses it"};
    default:
        return {std::string("it cannot be opened: ") + libusb_error_name(error), "plug it in anew, without a hub"};
    }
}

} // namespace palp
