#pragma once
#include <array>
#include <cstdint>
#include <functional>

#include "device/device_check.h"
#include "engine/session/duration_histogram.h"

namespace palp {

/// How late the ticks of a servo come.
struct TickLateness {
    /// Upper ends of the histogram's bins [s]; the last one is open.
    static constexpr std::array kBins{50e-6, 100e-6, 200e-6, 500e-6, 1e-3, 2e-3, 5e-3, 10e-3, 20e-3};

    std::array<std::uint64_t, kBins.size() + 1> counts{};
    DurationHistogram                           all; ///< [s]

    void add(double late) noexcept;
};

/// The servo's clock, on an idle machine and with every core busy.
struct ServoJitter {
    TickLateness idle, busy;
    double       seconds = 0; ///< [s] of each
};

/// Lets a thread with the rights of a servo's wait for ticks of 1 ms, first alone, then beside a thread on every core
/// that only computes.
/// \param seconds     [s] of each half
/// \param onProgress  is called from time to time with the share that is done [1]
[[nodiscard]] ServoJitter measureJitter(double seconds, const std::function<void(double)>& onProgress);

/// Returns what that means for a session.
[[nodiscard]] Finding findingOn(const ServoJitter& jitter);

} // namespace palp
