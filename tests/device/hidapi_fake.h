#pragma once
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace palp {

/// The answers of the stand-in for hidapi, and the calls that it received.
/// \thread the test's; the counters any
struct HidapiFake {
    struct Listed {
        std::string   path;
        std::uint16_t vendor = 0, product = 0, usagePage = 0, usage = 0;
        std::wstring  model;
    };

    bool                      starts = true;
    std::vector<Listed>       devices;
    std::wstring              openError;      ///< not empty: nothing can be opened
    bool                      broken = false; ///< reads and writes fail
    std::vector<std::uint8_t> report;         ///< what every read gets
    std::vector<std::uint8_t> written;
    std::atomic<int>          waited{0}; ///< [ms] of the last read

    std::atomic<int> opened{0};  ///< calls of hid_open_path()
    std::atomic<int> ports{0};   ///< open now
    std::atomic<int> entries{0}; ///< of enumerations, not yet freed
};
[[nodiscard]] HidapiFake& hidapiFake();

} // namespace palp
