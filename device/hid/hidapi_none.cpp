// HidapiSystem of a build without hidapi.
#include "device/hid/hidapi_system.h"

namespace palp {

std::string hidSupport()
{
    return "compiled without hidapi";
}

bool hasHidSupport() noexcept
{
    return false;
}

HidapiSystem::HidapiSystem()  = default;
HidapiSystem::~HidapiSystem() = default;

std::vector<HidListing> HidapiSystem::list()
{
    return {};
}

std::unique_ptr<HidPort> HidapiSystem::open(const std::string& path)
{
    throw HidRefused(path + " cannot be opened: compiled without hidapi",
                     "install libhidapi-dev and build Palpate anew");
}

} // namespace palp
