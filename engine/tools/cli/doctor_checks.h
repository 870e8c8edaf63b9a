#pragma once
#include <string>
#include <vector>

#include "device/device_record.h"

namespace palp {

/// Examines every part of the machine that a session needs, in less than a second. For some milliseconds another thread
/// asks for real-time scheduling and locks all memory, then gives both back.
[[nodiscard]] std::vector<Finding> examine(const DeviceList& haptics);

/// The program's version, compiler and libraries, and the system that it runs on.
struct Make {
    std::string palpate, compiler, libraries, system;
};
[[nodiscard]] Make make();

} // namespace palp
