#pragma once
#include <memory>
#include <string>
#include <vector>

#include "device/hid/hid_port.h"

namespace palp {

/// Describes this build's support for HID: "hidapi 0.13.1", or "compiled without hidapi".
[[nodiscard]] std::string hidSupport();
[[nodiscard]] bool        hasHidSupport() noexcept;

/// The HID devices of this machine, by hidapi's back end on hidraw; without hidapi the list is empty.
///
/// Opening needs permission, listing does not. A port waits in system calls: do not use it on the servo's thread.
/// \thread one at a time per object; objects and ports on several threads do not disturb each other
class HidapiSystem : public HidSystem {
public:
    HidapiSystem();
    ~HidapiSystem() override; ///< open ports stay valid

    /// \throws Error if hidapi does not start
    [[nodiscard]] std::vector<HidListing> list() override;

    /// Opens only paths that the last list() of this object named: hidapi 0.13.1 writes to freed memory when a path
    /// leads to anything but a hidraw node.
    [[nodiscard]] std::unique_ptr<HidPort> open(const std::string& path) override;

private:
    std::vector<HidListing> last_;
};

} // namespace palp
