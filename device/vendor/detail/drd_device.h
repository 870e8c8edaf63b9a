#pragma once
#include <array>

#include "device/vendor/detail/drd_library.h"

namespace palp {

/// What the library says of one device, by the names of Status.
using DrdStatus = std::array<int, kDrdStatus>;

/// One device that is open.
struct DrdDevice {
    int  id      = -1;    ///< the library's number for it; -1: closed
    bool isRobot = false; ///< drdOpenID() opened it: the functions drd* know it, and drdClose() closes it
    int  type    = 0;     ///< the library's number of it
};

inline constexpr int kDrdFalcon = 60; ///< a type: a Novint Falcon, which is homed by hand alone

/// Opens a device by its index: for all functions of the library, or, where that fails, for those named dhd* alone.
[[nodiscard]] DrdDevice openDrd(const DrdLibrary& drd, int index) noexcept;

/// Closes it as it was opened. Does nothing if it is closed.
void closeDrd(const DrdLibrary& drd, DrdDevice& device) noexcept;

/// Returns whether the device knows where its arm is: until then its encoders mean nothing.
[[nodiscard]] bool isHomed(const DrdLibrary& drd, const DrdDevice& device, const DrdStatus& status) noexcept;

/// Likewise, of a device that is asked for its status first. One that gives none is not homed.
[[nodiscard]] bool isHomed(const DrdLibrary& drd, const DrdDevice& device) noexcept;

} // namespace palp
