#pragma once
#include <chrono>
#include <cstdint>

namespace palp {

/// The system's clocks at time 0 of a session [ns], by which its ticks are aligned with other recordings.
struct SessionClocks {
    std::int64_t realtime  = 0; ///< CLOCK_REALTIME, since 1970
    std::int64_t monotonic = 0; ///< CLOCK_MONOTONIC, since the machine was started

    /// Reads both clocks for an instant of the steady clock, which is CLOCK_MONOTONIC.
    [[nodiscard]] static SessionClocks at(std::chrono::steady_clock::time_point instant) noexcept
    {
        using std::chrono::nanoseconds;
        const auto ago = nanoseconds(std::chrono::steady_clock::now() - instant);
        return {nanoseconds(std::chrono::system_clock::now().time_since_epoch() - ago).count(),
                nanoseconds(instant.time_since_epoch()).count()};
    }
};

} // namespace palp
