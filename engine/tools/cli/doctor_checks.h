#pragma once
#include <string>
#include <vector>

#include "device/device_record.h"

namespace palp {

/// Examines every part of the machine that a session needs, in less than a second. For some milliseconds a thread of its
/// own asks for real-time scheduling and locks all memory, then it gives both back.
[[nodiscard]] std::vector<Finding> examine(const DeviceList& haptics);

/// What the program is made of: its version, compiler, libraries, and the system below.
struct Make {
    std::string palpate, compiler, libraries, system;
};
[[nodiscard]] Make make();

} // namespace palp
