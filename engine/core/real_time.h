#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace palp {

/// Asks for the calling thread to run before all others (SCHED_FIFO) and for all memory to stay where it is (mlockall).
/// \return empty, or one sentence that says what was refused and how to allow it
[[nodiscard]] std::string askForRealTime();

/// Instants at a fixed distance, to be waited for one after the other.
///
/// A late thread does not try to catch up: instants that have passed by more than a period are left out, and counted.
/// \thread one; waits neither allocate nor lock
class Metronome {
public:
    using Clock = std::chrono::steady_clock;

    explicit Metronome(std::chrono::nanoseconds period) noexcept : period_(period), next_(Clock::now()) {}

    /// Sleeps until the next instant. \return the time it is then
    Clock::time_point wait() noexcept;

    [[nodiscard]] std::uint64_t leftOut() const noexcept { return leftOut_; } ///< [1]

private:
    std::chrono::nanoseconds period_;
    Clock::time_point        next_;
    std::uint64_t            leftOut_ = 0;
};

} // namespace palp
