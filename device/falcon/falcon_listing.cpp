// Finds what the plugged-in Falcons need before they can be used; independent of libusb.
#include "device/falcon/detail/libusb_link.h"
#include "device/falcon/falcon_driver.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

/// Asks a Falcon that can be opened. Its link is then closed, so that the boot loader listens to the next one.
void ask(FalconListing& listing)
{
    try {
        listing.readiness = askFalcon(*openFalcon(listing.path));
    } catch (const std::exception& error) { // Error or LinkLost
        listing.usable = false;
        listing.why    = std::string("it cannot be asked: ") + error.what();
        listing.help   = "plug it in anew, without a hub";
        return;
    }
    if (listing.readiness == FalconReadiness::noFirmware) {
        listing.why  = "no firmware runs on it";
        listing.help = "set FALCON_FIRMWARE to the file that came with its software; it is uploaded on opening";
    }
    if (listing.readiness == FalconReadiness::notHomed) {
        listing.why  = "it is not homed";
        listing.help = "pull the grip out as far as it goes, then push it in";
    }
}

} // namespace

std::vector<FalconListing> listFalcons()
{
    std::vector<FalconListing> listings = findFalcons();
    for (FalconListing& listing : listings)
        if (listing.usable) ask(listing);
    return listings;
}

} // namespace palp
