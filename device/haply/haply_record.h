#pragma once
#include <string>

#include "device/device_record.h"
#include "device/haply/haply_line.h"
#include "device/line_device.h"

namespace palp {

/// Haply's Inverse3 and Minverse, through their Inverse Service.
extern const DeviceRecord kHaplyRecord;

inline constexpr std::uint16_t kHaplyServicePort = 10001, kHaplyEventsPort = 10020;

inline constexpr DeviceOption kHaplyEvents{"--haply-events",
                                           "port of the Inverse Service's events, 10020 as it is shipped",
                                           DeviceOption::Kind::number, 1, 65535};

/// Where a device is: "HOST:PORT/NUMBER", each part may be missing.
struct HaplyPath {
    std::string   host = "127.0.0.1";
    std::uint16_t port = kHaplyServicePort;
    std::string   id{}; ///< empty: the first

    [[nodiscard]] std::string address() const { return host + ":" + std::to_string(port); }
};

/// Reads "", "049D", "HOST:PORT" or "HOST:PORT/049D". What the text omits is that of `usual`.
/// \throws Error naming what was found
[[nodiscard]] HaplyPath parseHaplyPath(const std::string& text, HaplyPath usual = {});

/// Makes the device of a service.
[[nodiscard]] std::unique_ptr<LineDevice> makeHaply(HaplyOpener open, const HaplyLineSettings& settings,
                                                    const LineSettings& line = {});

} // namespace palp
