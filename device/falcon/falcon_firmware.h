#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palp {

/// Bounds of an image's size [bytes]. Known images have 7 to 9 kB; the rest of the range is for unknown ones.
inline constexpr std::size_t kLeastFalconFirmware = 4096, kMostFalconFirmware = 16384;

/// Returns the path of the image of a Falcon's firmware: that of the option --falcon-firmware, else of the environment
/// variable FALCON_FIRMWARE, else empty.
///
/// A Falcon loses its firmware without power and needs it before anything else. Palpate has none: the images are
/// Novint's, under terms that forbid passing them on. They come with the software of the device.
[[nodiscard]] std::filesystem::path falconFirmwarePath(const std::string& option);

/// Reads the image in a file. Its format is unknown; only its size is checked, before memory is allocated for it.
/// \throws Error naming the path, what was expected and found, and what to try
[[nodiscard]] std::vector<std::uint8_t> readFirmware(const std::filesystem::path& path);

} // namespace palp
