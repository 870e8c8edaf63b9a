#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/gpu/device_error.h"

namespace palp::gpu {

/// What the processor of this machine is called as a device; it needs no driver and is not in the list.
inline constexpr std::string_view kHostDevice = "host";

/// One device as the drivers describe it.
struct DeviceDescription {
    int                      index = 0;       ///< place in the list of this machine
    std::string              name;            ///< as the driver spells it
    std::string              kind;            ///< discrete, integrated, virtual, software or other
    std::string              driver;          ///< name and version
    std::string              api;             ///< Vulkan version, such as 1.3.230
    bool                     float64 = false; ///< shaders may use double
    std::uint64_t            memory  = 0;     ///< [byte] the largest heap of its own
    std::vector<std::string> refusals;        ///< why it cannot be used; empty: it can
};

/// Every device of this machine; empty if there is no driver. Takes tens of milliseconds: it loads every driver.
[[nodiscard]] std::vector<DeviceDescription> listDevices();

/// The place in the list of the device that is wanted.
///
/// \param wanted  "auto": the first usable one of the best kind: discrete, integrated, virtual, software, other;
///                "lavapipe": a software device; an INDEX of the list; or part of a NAME, whatever the case, that fits
///                one usable device only. The two words in any case
/// \throws UnknownDevice if the word is wrong and another one would do; DeviceError if what it names cannot be used, or
///         no device can. Both with one line per device
/// \thread pure
[[nodiscard]] std::size_t chooseDevice(const std::vector<DeviceDescription>& devices, std::string_view wanted);

} // namespace palp::gpu
