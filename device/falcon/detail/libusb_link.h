#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_link.h"

namespace palp {

/// What this build can do about the Falcon: "libusb-1.0 1.0.26", or "compiled without libusb-1.0".
[[nodiscard]] std::string falconSupport();
[[nodiscard]] bool        hasFalconSupport() noexcept; ///< whether it is more than that sentence

/// The line for a file in /etc/udev/rules.d that lets the user who sits at the machine open a Falcon.
inline constexpr const char* kFalconUdevLine =
    R"(SUBSYSTEM=="usb", ATTR{idVendor}=="0403", ATTR{idProduct}=="cb48", TAG+="uaccess")";

/// A Falcon that is plugged in.
struct FalconListing {
    std::string path;           ///< "1-2.3": the bus, and the ports on the way to it; the same until it is moved
    bool        usable = false; ///< it can be opened now, and nobody else holds it
    std::string why;            ///< it is not usable, or what it still needs, in words; empty if it is ready
    std::string help;           ///< what to do about that

    std::optional<FalconReadiness> readiness{}; ///< what it answered; empty: it was not asked
};

/// The Falcons that are plugged in. Each is opened, asked what it needs and let go again, in 0.1 s or so.
/// Without libusb there are none: falconSupport() says so.
/// \throws Error if USB cannot be used at all
[[nodiscard]] std::vector<FalconListing> listFalcons();
[[nodiscard]] std::vector<FalconListing> findFalcons(); ///< the same, but none is asked anything

/// The bridge of a Falcon, over libusb.
///
/// A few transfers always wait for what it sends, so that none of it is lost between two reads. A write is handed to
/// the kernel and goes out while the caller goes on; where that fails, the next call says so. All happens in the calls:
/// there is no thread. Waiting ends when something comes in; the end of a wait is rounded up to whole milliseconds.
/// Each write, and each transfer that came in, costs one small allocation inside libusb: keep the link off a thread
/// that must not. A transfer that fails for whatever reason loses the link for good: a new one starts from nothing,
/// which is what the device needs as well. Only a device that is not there any more makes that a LinkGone. Destruction
/// waits up to 0.1 s for the last write, then takes everything back and lets the device go.
///
/// \param path  of a listing; empty: the first one that is usable
/// \throws Error, one sentence: why it cannot be opened and what to do
[[nodiscard]] std::unique_ptr<FalconLink> openFalcon(const std::string& path = "");

} // namespace palp
