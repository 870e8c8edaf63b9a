#include "device/falcon/falcon_firmware.h"

#include <cstdlib>
#include <fstream>
#include <system_error>

#include "engine/core/contract.h"
#include "engine/core/file.h"

namespace palp {
namespace {

constexpr const char* kAdvice = "name the image from the device's own software by --falcon-firmware or FALCON_FIRMWARE";

std::string expected()
{
    return "expected the Falcon's firmware, " + std::to_string(kLeastFalconFirmware) + " to " +
           std::to_string(kMostFalconFirmware) + " bytes";
}

} // namespace

std::filesystem::path falconFirmwarePath(const std::string& option)
{
    if (!option.empty()) return option;
    const char* variable = std::getenv("FALCON_FIRMWARE");
    return variable ? variable : "";
}

std::vector<std::uint8_t> readFirmware(const std::filesystem::path& path)
{
    if (path.empty()) throw Error("no firmware for the Falcon is named: " + expected() + "; " + kAdvice);

    // Reading a pipe or a device could wait for ever.
    std::error_code failure;
    if (std::filesystem::exists(path, failure) && !std::filesystem::is_regular_file(path, failure))
        throw Error(path.string() + ": not a plain file; " + expected() + "; " + kAdvice);
    InputFile file = openRegularFile(path);

    const std::uintmax_t size = std::filesystem::file_size(path, failure);
    if (failure) throw Error(path.string() + ": its size cannot be read: " + failure.message());
    if (size < kLeastFalconFirmware || size > kMostFalconFirmware)
        throw Error(path.string() + ": " + std::to_string(size) + " bytes long; " + expected() + "; " + kAdvice);

    std::vector<std::uint8_t> image(size);
    file.read(reinterpret_cast<char*>(image.data()), std::streamsize(size));
    if (file.gcount() != std::streamsize(size))
        throw Error(path.string() + ": ends at byte " + std::to_string(file.gcount()) + " of " + std::to_string(size) +
                    "; copy it anew");
    return image;
}

} // namespace palp
