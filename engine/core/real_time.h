#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace palp {

/// Asks the system to run the calling thread before all others (SCHED_FIFO) and to keep all memory resident (mlockall).
/// \return empty, or one sentence that says what was refused and how to allow it
[[nodiscard]] std::string askForRealTime();

/// Returns for how long the machine has been suspended since it was started [s]: the time that
/// std::chrono::steady_clock does not count. A thread that is interrupted between two clocks is off by that long. 0
/// where the system does not say.
[[nodiscard]] double timeAsleep() noexcept;

/// Tells a loop that its machine was suspended: the hand is elsewhere then, and the loop's own clock has stood still.
class SleepWatch {
public:
    /// Returns for how long the machine slept since the last call [s]; 0: it did not.
    [[nodiscard]] double slept() noexcept;
    void                 restart() noexcept { asleep_ = timeAsleep(); } ///< forgets what it slept since

private:
    double asleep_ = timeAsleep(); ///< [s]
};

/// A clock of instants at a fixed distance, for which a thread waits one after the other.
///
/// A late thread does not catch up: instants that have passed by more than a period are omitted and counted.
/// \thread one; waits neither allocate nor lock
class Metronome {
public:
    using Clock = std::chrono::steady_clock;

    explicit Metronome(std::chrono::nanoseconds period) noexcept : period_(period), next_(Clock::now()) {}

    /// Sleeps until the next instant.
    /// \return the time after the sleep
    Clock::time_point wait() noexcept;

    [[nodiscard]] std::uint64_t leftOut() const noexcept { return leftOut_; } ///< omitted instants

private:
    std::chrono::nanoseconds period_;
    Clock::time_point        next_;
    std::uint64_t            leftOut_ = 0;
};

} // namespace palp
