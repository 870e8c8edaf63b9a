#include "device/vendor/detail/hd_library.h"

#include <vector>

#include "device/detail/shared_library.h"

namespace palp {
namespace {

std::vector<std::string> places()
{
    std::vector<std::string> all;
    if (const std::string folder = environmentOf("OPENHAPTICS"); !folder.empty())
        for (const char* below : {"", "/lib", "/lib64", "/usr/lib"})
            for (std::string& file : filesNamed(folder + below, "libHD.so")) all.push_back(std::move(file));
    all.insert(all.end(), {"libHD.so", "libHD.so.3.4", "libHD.so.3.3"});
    return all;
}

} // namespace

std::unique_ptr<const HdLibrary> loadHd()
{
    SharedLibrary library(places());
    auto          hd = std::make_unique<HdLibrary>();
    hd->place        = library.place();
    library.take("hdInitDevice", hd->hdInitDevice);
    library.take("hdDisableDevice", hd->hdDisableDevice);
    library.take("hdMakeCurrentDevice", hd->hdMakeCurrentDevice);
    library.take("hdBeginFrame", hd->hdBeginFrame);
    library.take("hdEndFrame", hd->hdEndFrame);
    library.take("hdEnable", hd->hdEnable);
    library.take("hdDisable", hd->hdDisable);
    library.take("hdGetDoublev", hd->hdGetDoublev);
    library.take("hdGetIntegerv", hd->hdGetIntegerv);
    library.take("hdSetDoublev", hd->hdSetDoublev);
    library.take("hdGetString", hd->hdGetString);
    library.take("hdGetError", hd->hdGetError);
    library.take("hdGetErrorString", hd->hdGetErrorString);
    library.take("hdCheckCalibration", hd->hdCheckCalibration);
    library.take("hdUpdateCalibration", hd->hdUpdateCalibration);
    library.take("hdStartScheduler", hd->hdStartScheduler);
    library.take("hdStopScheduler", hd->hdStopScheduler);
    library.take("hdScheduleAsynchronous", hd->hdScheduleAsynchronous);
    library.take("hdUnschedule", hd->hdUnschedule);
    library.demandWhole("OpenHaptics 3");
    return hd;
}

} // namespace palp
