#pragma once
#include <string>
#include <vector>

#include "device/hid/hid_port.h"

namespace palp {

/// A haptic device that there is, or that would be there.
struct DeviceListing {
    std::string name{};         ///< what `--hand` takes: "falcon", "spacemouse", "bridge", "mouse", "arm"
    std::string model{};        ///< "SpaceMouse Compact"
    std::string path{};         ///< where it is plugged in; empty for what is not
    bool        usable = false; ///< it could be opened now
    std::string why{};          ///< it is not usable, or what it still needs, in words; empty if it is ready
    std::string help{};         ///< the one line that helps; may be empty
};

/// What can serve as a hand: the devices of `others`, then what `hid` lists and a driver here knows, each opened and
/// let go again to see whether that works, then what needs no hardware. A device that lists itself twice appears once.
/// \param others  from elsewhere, such as Falcons
/// \throws Error if HID devices cannot be listed
[[nodiscard]] std::vector<DeviceListing> listDevices(HidSystem& hid, std::vector<DeviceListing> others = {});

} // namespace palp
