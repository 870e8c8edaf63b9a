#include "device/falcon/libusb_words.h"

#include <libusb.h>

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

void explainRefusal(FalconListing& listing, int error)
{
    switch (error) {
    case LIBUSB_ERROR_ACCESS:
        listing.why  = "no permission to open it";
        listing.help = "put this line into /etc/udev/rules.d/70-palpate-falcon.rules and plug it in anew: " +
                       std::string(kFalconUdevLine);
        break;
    case LIBUSB_ERROR_BUSY:
        listing.why  = "a program has it open already";
        listing.help = "end the other program that uses it";
        break;
    default:
        listing.why  = std::string("it cannot be opened: ") + libusb_error_name(error);
        listing.help = "plug it in anew, without a hub";
    }
}

} // namespace palp
