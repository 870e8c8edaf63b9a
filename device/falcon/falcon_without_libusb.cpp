// The links to Falcons of a build without libusb-1.0.
#include "device/falcon/detail/libusb_link.h"

#include "engine/core/contract.h"

namespace palp {

std::string falconSupport()
{
    return "compiled without libusb-1.0";
}

bool hasFalconSupport() noexcept
{
    return false;
}

std::vector<FalconListing> findFalcons()
{
    return {};
}

std::unique_ptr<FalconLink> openFalcon(const std::string&)
{
    throw Error("no Novint Falcon can be opened: " + falconSupport() +
                "; install libusb-1.0-0-dev and build Palpate anew");
}

} // namespace palp
