#include "device/falcon/falcon_record.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <utility>

#include "device/falcon/detail/libusb_link.h"
#include "device/falcon/falcon_firmware.h"

namespace palp {
namespace {

namespace fs = std::filesystem;

constexpr std::array kOptions{kFalconFirmware, kFalconCounts, kFalconTimerOnly};

std::vector<DeviceListing> list(HidSystem& /*hid*/)
{
    std::vector<DeviceListing> devices;
    for (const FalconListing& falcon : listFalcons())
        devices.push_back({.path        = falcon.path,
                           .usable      = falcon.usable,
                           .why         = falcon.why,
                           .help        = falcon.help,
                           .calibration = falcon.usable ? describeConstants(falcon.serial) : "",
                           .answers     = falcon.usable && falcon.readiness != FalconReadiness::noFirmware});
    return devices;
}

std::unique_ptr<FalconDevice> falcon(const DeviceRequest&                                   request,
                                     std::function<FalconTuning(const std::string& serial)> tune)
{
    FalconDeviceSettings settings = falconSettings(request);
    settings.firmware             = falconFirmware(request);
    settings.tune                 = std::move(tune);
    return std::make_unique<FalconDevice>([path = request.path] { return openFalcon(path); }, settings);
}

std::unique_ptr<HapticDevice> make(const DeviceRequest& request)
{
    return falcon(request, [byHand = countsByHand(request.options)](const std::string& serial) {
        return tuningOf(serial, byHand);
    });
}

DeviceSupport support()
{
    return {hasFalconSupport(), falconSupport(), "install libusb-1.0-0-dev and build Palpate anew"};
}

/// Returns whether a rule names the product, given in lower case; rules may spell it in any case.
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
    return {"udev rule", Verdict::warning, "there is none for the Falcon; only an administrator can open one",
            std::string("put this line into /etc/udev/rules.d/70-palpate-falcon.rules: ") + kFalconUdevLine};
}

Finding firmware()
{
    const char*    part = "falcon firmware";
    const fs::path path = falconFirmwarePath(""); // from the environment
    if (path.empty())
        return {part, Verdict::warning, "FALCON_FIRMWARE is not set; a Falcon that was just plugged in needs it",
                "export FALCON_FIRMWARE=FILE, the image that came with the device's own driver"};
    std::error_code      failed;
    const std::uintmax_t size = fs::file_size(path, failed);
    if (failed || !std::ifstream(path))
        return {part, Verdict::missing, "FALCON_FIRMWARE names a file that cannot be read",
                "export FALCON_FIRMWARE=FILE, one that you may read"};
    const std::string bytes = std::to_string(size) + " byte";
    if (size < kLeastFalconFirmware || size > kMostFalconFirmware)
        return {part, Verdict::missing, "FALCON_FIRMWARE names a file of " + bytes + ", which is no image",
                "images have " + std::to_string(kLeastFalconFirmware) + " to " + std::to_string(kMostFalconFirmware) +
                    " byte"};
    return {part, Verdict::ok, bytes};
}

std::vector<Finding> findings()
{
    return {udevRule(), firmware()};
}

} // namespace

const DeviceRecord kFalconRecord{.name     = "falcon",
                                 .model    = "Novint Falcon",
                                 .options  = kOptions,
                                 .list     = list,
                                 .make     = make,
                                 .support  = support,
                                 .findings = findings};

std::optional<double> countsByHand(const DeviceOptionValues& options)
{
    const std::string counts = textOf(options, kFalconCounts);
    if (counts.empty()) return {};
    return numberOf(kFalconCounts, counts);
}

FalconDeviceSettings falconSettings(const DeviceRequest& request)
{
    FalconDeviceSettings settings;
    settings.path = request.path;
    if (const auto byHand = countsByHand(request.options)) settings.loop.countsPerTorque = *byHand;
    settings.start.triesEventCharacter = textOf(request.options, kFalconTimerOnly).empty();
    settings.start.onUpload            = request.onUpload;
    settings.start.cancel              = request.cancel;
    return settings;
}

std::unique_ptr<FalconDevice> makeFalconToCalibrate(const DeviceRequest& request)
{
    return falcon(request, [byHand = countsByHand(request.options)](const std::string& serial) {
        return tuningToCalibrate(serial, byHand);
    });
}

std::vector<std::uint8_t> falconFirmware(const DeviceRequest& request)
{
    const fs::path image = falconFirmwarePath(textOf(request.options, kFalconFirmware));
    return image.empty() ? std::vector<std::uint8_t>() : readFirmware(image);
}

} // namespace palp
