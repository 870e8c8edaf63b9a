#include "engine/tools/cli/doctor_checks.h"

#include <filesystem>
#include <iterator>
#include <thread>

#ifdef __linux__
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#endif

#include "engine/compute/processor_list.h"
#include "engine/core/contract.h"
#include "engine/core/processor.h"
#include "engine/core/real_time.h"
#include "engine/plate/host/host_kernels.h"
#include "engine/session/device_registry.h"
#include "engine/tools/cli/haptic_list.h"

namespace palp {
namespace {

namespace fs = std::filesystem;

Finding vulkan()
{
    const std::string host = "; the host computes in the meantime";
    try {
        const std::vector<compute::Processor> processors = compute::listProcessors();
        std::string                           software   = "none";
        for (const compute::Processor& processor : processors) {
            if (!processor.refusals.empty()) continue;
            if (processor.kind != compute::ProcessorKind::software)
                return {"vulkan", Verdict::ok,
                        processor.name + " (" + name(processor.kind) + "), Vulkan " + processor.api};
            software = processor.name;
        }
        if (software != "none")
            return {"vulkan", Verdict::warning, "only in software: " + software,
                    "install the driver of the graphics card" + host};
        return {"vulkan", Verdict::warning, processors.empty() ? "no processor" : "no processor that can be used",
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
            "run it on a desktop; \"palpate run\" and \"palpate touch\" need no window"};
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
            "in a container pass it on, with Docker by --device /dev/bus/usb; elsewhere the kernel lacks USB support"};
}

/// Returns the finding on a kind of device that needs hardware.
Finding ofDevice(const DeviceRecord& record, const DeviceList& haptics)
{
    const std::string   part(record.name);
    const DeviceSupport support = record.support();
    if (!support.isBuilt) return {part, Verdict::missing, support.library, support.help};
    std::string models;
    for (const DeviceListing& device : haptics.devices) {
        if (device.name != record.name) continue;
        if (!device.usable) return {part, Verdict::missing, device.model + ": " + device.why, device.help};
        if (!device.why.empty())
            return {part, Verdict::warning, device.model + " can be opened, but " + device.why, device.help};
        models += (models.empty() ? "" : ", ") + device.model;
    }
    if (models.empty()) return {part, Verdict::ok, "none is plugged in; looked for with " + support.library};
    return {part, Verdict::ok, models + " can be opened"};
}

} // namespace

std::vector<Finding> examine(const DeviceList& haptics)
{
    std::vector<Finding> findings{realTime()}; // first, because GPU drivers map memory that would be locked too
    for (const Finding& finding : {vulkan(), host(), display(), usb(), checkGuardian()}) findings.push_back(finding);
    for (const DeviceRecord* record : deviceRecords()) {
        if (record->support) findings.push_back(ofDevice(*record, haptics));
        if (!record->findings) continue;
        const std::vector<Finding> more = record->findings();
        findings.insert(findings.end(), more.begin(), more.end());
    }
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
