#include "engine/tools/cli/doctor_checks.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#ifdef __linux__
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#endif

#include "device/falcon/falcon_firmware.h"
#include "device/falcon/libusb_link.h"
#include "device/hid/hidapi_system.h"
#include "engine/compute/processor_list.h"
#include "engine/core/contract.h"
#include "engine/core/processor.h"
#include "engine/core/real_time.h"
#include "engine/plate/host/host_kernels.h"

namespace palp {
namespace {

namespace fs = std::filesystem;

Finding vulkan()
{
    const std::string host = "; the host computes in the meantime";
    try {
        const std::vector<compute::Processor> devices  = compute::listProcessors();
        std::string                           software = "none";
        for (const compute::Processor& device : devices) {
            if (!device.refusals.empty()) continue;
            if (device.kind != "software")
                return {"vulkan", Verdict::ok, device.name + " (" + device.kind + "), Vulkan " + device.api};
            software = device.name;
        }
        if (software != "none")
            return {"vulkan", Verdict::warning, "only in software: " + software,
                    "install the driver of the graphics card" + host};
        return {"vulkan", Verdict::warning, devices.empty() ? "no device" : "no device that can be used",
                "install the driver of the graphics card" + host};
    } catch (const compute::ProcessorError& error) {
        return {"vulkan", Verdict::warning, error.what(), "install the driver of the graphics card" + host};
    }
}

Finding host()
{
    try {
        return {"host", Verdict::ok,
                processorName() + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads, code for " +
                    std::string(hostVariant().isa)};
    } catch (const Error& error) {
        return {"host", Verdict::missing, error.what(), "unset PALPATE_HOST_ISA"};
    }
}

Finding display()
{
    if (!displayName().empty()) return {"display", Verdict::ok, displayName()};
    return {"display", Verdict::missing, "neither DISPLAY nor WAYLAND_DISPLAY is set",
            "run it on a desktop; without a window there are \"palpate run\" and \"palpate touch\""};
}

#ifdef __linux__
std::string limitText(int resource, rlim_t unit, const char* unitName)
{
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0) return "unknown";
    return limit.rlim_cur == RLIM_INFINITY ? "unlimited" : std::to_string(limit.rlim_cur / unit) + unitName;
}
#endif

Finding realTime()
{
#ifdef __linux__
    const std::string limits = "RLIMIT_RTPRIO " + limitText(RLIMIT_RTPRIO, 1, "") + ", RLIMIT_MEMLOCK " +
                               limitText(RLIMIT_MEMLOCK, 1024, " KiB");
    std::string refused;
    std::thread([&refused] { refused = askForRealTime(); }).join(); // its priority ends with it
    munlockall();
    if (refused.empty()) return {"real time", Verdict::ok, "SCHED_FIFO and mlockall granted; " + limits};
    return {"real time", Verdict::warning, limits, refused};
#else
    return {"real time", Verdict::warning, "not on this system", "use Linux for haptics at 1 kHz"};
#endif
}

Finding usb()
{
    std::error_code failed;
    const auto      buses = std::distance(fs::directory_iterator("/dev/bus/usb", failed), fs::directory_iterator());
    if (!failed && buses > 0) return {"usb", Verdict::ok, std::to_string(buses) + " buses in /dev/bus/usb"};
    return {"usb", Verdict::missing, "there is no /dev/bus/usb",
            "in a container pass it on, such as by --device /dev/bus/usb; else the kernel has no USB"};
}

Finding ofDevice(const char* part, const DeviceListing& device)
{
    if (device.usable && device.why.empty()) return {part, Verdict::ok, device.model + " can be opened"};
    if (device.usable) return {part, Verdict::warning, device.model + " can be opened, but " + device.why, device.help};
    return {part, Verdict::missing, device.model + ": " + device.why, device.help};
}

/// Whether some rule names the product, given in lower case; rules may spell it in any.
bool hasUdevRule(const std::string& product)
{
    for (const char* folder :
         {"/etc/udev/rules.d", "/run/udev/rules.d", "/usr/lib/udev/rules.d", "/lib/udev/rules.d"}) {
        std::error_code failed;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
            if (entry.path().extension() != ".rules") continue;
            std::ifstream file(entry.path());
            for (std::string line; std::getline(file, line);) {
                std::ranges::transform(line, line.begin(), [](unsigned char c) { return char(std::tolower(c)); });
                if (line.find(product) < line.find('#')) return true;
            }
        }
    }
    return false;
}

Finding udevRule()
{
    if (hasUdevRule("cb48")) return {"udev rule", Verdict::ok, "one for the Falcon is installed"};
    return {"udev rule", Verdict::warning, "none for the Falcon; only an administrator can open one",
            std::string("put this line into /etc/udev/rules.d/70-palpate-falcon.rules: ") + kFalconUdevLine};
}

Finding falcon(const HapticList& haptics)
{
    for (const DeviceListing& device : haptics.devices)
        if (device.name == "falcon") return ofDevice("falcon", device);
    if (!hasFalconSupport())
        return {"falcon", Verdict::missing, falconSupport(), "install libusb-1.0-0-dev and build Palpate anew"};
    return {"falcon", Verdict::warning, "none is plugged in; looked for with " + falconSupport()};
}

Finding hid(const HapticList& haptics)
{
    if (!hasHidSupport())
        return {"hid", Verdict::missing, hidSupport(), "install libhidapi-dev and build Palpate anew"};
    std::string usable;
    for (const DeviceListing& device : haptics.devices) {
        if (device.name != "spacemouse" && device.name != "bridge") continue;
        if (!device.usable) return ofDevice("hid", device);
        usable += (usable.empty() ? "" : ", ") + device.model;
    }
    if (usable.empty())
        return {"hid", Verdict::ok, "no SpaceMouse and no bridge is plugged in; looked for with " + hidSupport()};
    return {"hid", Verdict::ok, usable};
}

Finding firmware()
{
    const fs::path path = falconFirmwarePath(""); // as the environment says
    if (path.empty())
        return {"falcon firmware", Verdict::warning,
                "FALCON_FIRMWARE is not set; a Falcon that was just plugged in needs it",
                "export FALCON_FIRMWARE=FILE, the image that came with the device's own driver"};
    std::error_code      failed;
    const std::uintmax_t size = fs::file_size(path, failed);
    if (failed || !std::ifstream(path))
        return {"falcon firmware", Verdict::missing, "FALCON_FIRMWARE names a file that cannot be read",
                "export FALCON_FIRMWARE=FILE, one that you may read"};
    const std::string bytes = std::to_string(size) + " byte";
    if (size < kLeastFalconFirmware || size > kMostFalconFirmware)
        return {"falcon firmware", Verdict::missing, "FALCON_FIRMWARE names a file of " + bytes + ", which is no image",
                "images have " + std::to_string(kLeastFalconFirmware) + " to " + std::to_string(kMostFalconFirmware) +
                    " byte"};
    return {"falcon firmware", Verdict::ok, bytes};
}

} // namespace

std::vector<Finding> examine(const HapticList& haptics)
{
    std::vector<Finding> findings{realTime()}; // first: drivers of GPUs map memory that would be locked as well
    for (const Finding& finding :
         {vulkan(), host(), display(), usb(), udevRule(), falcon(haptics), firmware(), hid(haptics)})
        findings.push_back(finding);
    for (const std::string& trouble : haptics.troubles) findings.push_back({"devices", Verdict::missing, trouble});
    return findings;
}

Make make()
{
    std::string system = "unknown";
#ifdef __linux__
    utsname names{};
    if (uname(&names) == 0) system = std::string(names.sysname) + " " + names.release + " " + names.machine;
#endif
#ifdef __clang__
    const std::string compiler = "Clang " __clang_version__;
#else
    const std::string compiler = "GCC " __VERSION__;
#endif
    return {PALPATE_VERSION, compiler, PALPATE_LIBRARIES ", " + hapticSupport(), system};
}

} // namespace palp
