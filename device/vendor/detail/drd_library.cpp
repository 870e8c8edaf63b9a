#include "device/vendor/detail/drd_library.h"

#include <vector>

#include <sys/utsname.h>

#include "device/detail/shared_library.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

std::vector<std::string> places()
{
    std::vector<std::string> all;
    const auto               add = [&](const std::string& folder) {
        for (std::string& file : filesNamed(folder, "libdrd.so")) all.push_back(std::move(file));
    };
    utsname names{};
    uname(&names);
    for (const char* variable : {"FORCEDIM_SDK", "FDSDK"})
        if (const std::string sdk = environmentOf(variable); !sdk.empty()) {
            add(sdk + "/lib/release/lin-" + names.machine + "-gcc");
            add(sdk);
        }
    if (const std::string home = environmentOf("HOME"); !home.empty()) add(home + "/.local/lib");
    add("/usr/local/lib");
    all.insert(all.end(), {"libdrd.so.3", "libdrd.so"});
    return all;
}

} // namespace

std::unique_ptr<const DrdLibrary> loadDrd()
{
    SharedLibrary library(places());
    auto          drd = std::make_unique<DrdLibrary>();
    drd->place        = library.place();
    library.take("dhdGetSDKVersion", drd->dhdGetSDKVersion);
    library.take("dhdGetDeviceCount", drd->dhdGetDeviceCount);
    library.take("drdOpenID", drd->drdOpenID);
    library.take("drdClose", drd->drdClose);
    library.take("dhdOpenID", drd->dhdOpenID);
    library.take("dhdClose", drd->dhdClose);
    library.take("dhdGetSystemType", drd->dhdGetSystemType);
    library.take("dhdGetSystemName", drd->dhdGetSystemName);
    library.take("dhdGetSerialNumber", drd->dhdGetSerialNumber);
    library.take("dhdGetPosition", drd->dhdGetPosition);
    library.take("dhdGetLinearVelocity", drd->dhdGetLinearVelocity);
    library.take("dhdGetOrientationFrame", drd->dhdGetOrientationFrame);
    library.take("dhdGetButtonMask", drd->dhdGetButtonMask);
    library.take("dhdEnableForce", drd->dhdEnableForce);
    library.take("dhdSetBrakes", drd->dhdSetBrakes);
    library.take("dhdSetGravityCompensation", drd->dhdSetGravityCompensation);
    library.take("dhdSetForceAndTorqueAndGripperForce", drd->dhdSetForceAndTorqueAndGripperForce);
    library.take("dhdGetStatus", drd->dhdGetStatus);
    library.take("dhdStop", drd->dhdStop);
    library.take("dhdErrorGetLastStr", drd->dhdErrorGetLastStr);
    library.take("drdIsInitialized", drd->drdIsInitialized);
    library.take("drdAutoInit", drd->drdAutoInit);
    library.take("drdStop", drd->drdStop);
    library.takeIfThere("dhdSetMaxForce", drd->dhdSetMaxForce);
    library.takeIfThere("dhdGetGripperAngleRad", drd->dhdGetGripperAngleRad);
    library.demandWhole("Force Dimension SDK 3");
    return drd;
}

} // namespace palp
