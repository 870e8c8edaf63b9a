#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_link.h"

namespace palp {

/// Describes this build's support for the Falcon: "libusb-1.0 1.0.26", or "compiled without libusb-1.0".
[[nodiscard]] std::string falconSupport();
[[nodiscard]] bool        hasFalconSupport() noexcept; ///< whether it was compiled with libusb

/// The line for a file in /etc/udev/rules.d that lets the user who sits at the machine open a Falcon.
inline constexpr const char* kFalconUdevLine =
    R"(SUBSYSTEM=="usb", ATTR{idVendor}=="0403", ATTR{idProduct}=="cb48", TAG+="uaccess")";

/// A Falcon that is plugged in.
struct FalconListing {
    std::string path;           ///< "1-2.3": the bus, and the ports on the way to it; the same until it is moved
    bool        usable = false; ///< it can be opened now; no other program holds it
    std::string why;            ///< why it is not usable, or what it still needs; empty if it is ready
    std::string help;           ///< what to do about it
    std::string serial{};       ///< as FalconLink::serial(); empty also if it is not usable

    std::optional<FalconReadiness> readiness{}; ///< its answer; empty: it was not asked
};

/// Lists the Falcons that are plugged in. Each is opened, asked what it needs and closed again, in about 0.1 s.
/// Without libusb the list is empty, and falconSupport() says so.
/// \throws Error if USB cannot be used at all
[[nodiscard]] std::vector<FalconListing> listFalcons();
[[nodiscard]] std::vector<FalconListing> findFalcons(); ///< the same without asking any of them

/// The bridge of a Falcon, over libusb.
///
/// A few transfers always wait for incoming bytes, so that none are lost between two reads. A write is handed to the
/// kernel and goes out while the caller continues; if it fails, the next call reports it. All work is done inside the
/// calls: there is no thread. Waiting ends when something comes in; the end of a wait is rounded up to whole
/// milliseconds. Each write, and each transfer that came in, costs one small allocation inside libusb: do not use the
/// link on a thread that must not allocate. Any failed transfer loses the link permanently: a new link starts from
/// nothing, as the device needs as well. The loss is a LinkGone only if the device is no longer there. Destruction
/// waits up to 0.1 s for the last write, then cancels all transfers and closes the device.
///
/// \param path  path of a listing; empty: the first usable device
/// \throws Error saying in one sentence why it cannot be opened and what to do
[[nodiscard]] std::unique_ptr<FalconLink> openFalcon(const std::string& path = "");

} // namespace palp
