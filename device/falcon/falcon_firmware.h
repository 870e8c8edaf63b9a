#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palp {

/// [bytes] of an image. Known ones have 7 to 9 kB; the rest of the range is for those that we do not know.
inline constexpr std::size_t kLeastFalconFirmware = 4096, kMostFalconFirmware = 16384;

/// Where the image of a Falcon's firmware is: what the option --falcon-firmware says, else the environment's
/// FALCON_FIRMWARE. Empty: neither says.
///
/// A Falcon forgets its firmware without power, and wants it before anything else. Palpate has none: the images are
/// Novint's, under terms that do not let us pass them on. They come with the software of the device.
[[nodiscard]] std::filesystem::path falconFirmwarePath(const std::string& option);

/// The image in a file. Nothing is known of its format; only its size is checked, before memory is taken for it.
/// \throws Error naming the path, what was expected and found, and what to try
[[nodiscard]] std::vector<std::uint8_t> readFirmware(const std::filesystem::path& path);

} // namespace palp
