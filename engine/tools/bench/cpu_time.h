#pragma once
#include <functional>
#include <string>
#include <vector>

namespace palp {
class PlateSolver;
}
namespace palp::compute {
class Context;
enum class ProcessorKind;
} // namespace palp::compute

namespace palp::bench {

/// Returns the processor time of the calling thread [ms], CLOCK_THREAD_CPUTIME_ID: other work on the machine does not
/// count.
[[nodiscard]] double threadMilliseconds();

/// Returns the processor time of all threads of this process together [ms], CLOCK_PROCESS_CPUTIME_ID. Where one thread
/// works, it grows as fast as threadMilliseconds(); where a library has threads of its own, such as lavapipe's queue,
/// it includes them.
[[nodiscard]] double processMilliseconds();

[[nodiscard]] double wallMilliseconds();

struct Quartiles {
    double lower = 0, median = 0, upper = 0;
};

[[nodiscard]] Quartiles quartiles(std::vector<double> values);

enum class Clock {
    processor, ///< of all threads, for work on this machine's processors; one thread works at a time
    wall       ///< for work on other hardware
};

[[nodiscard]] double now(Clock clock); ///< [ms]
[[nodiscard]] Clock  clockOf(compute::ProcessorKind kind);
[[nodiscard]] Clock  clockOf(const compute::Context& context);
[[nodiscard]] Clock  clockOf(const PlateSolver& solver); ///< by the processor that it has opened

/// A solver that does the same work as its rivals; its parts are timed separately.
struct Contestant {
    std::string                        name;
    std::vector<std::function<void()>> parts;
    Clock                              clock = Clock::processor;
};

struct Timing {
    Quartiles              total;  ///< [ms] of the sum of the parts
    std::vector<Quartiles> parts;  ///< [ms]
    double                 hidden; ///< share of the processor time that was spent by other threads than the caller [1]
};

/// Times the contestants in turns, first, second, ..., first, second, ..., after one turn each that does not count.
/// Other work on the machine then disturbs all of them equally.
/// \param runs  counted turns of each contestant
[[nodiscard]] std::vector<Timing> takeTurns(const std::vector<Contestant>& contestants, int runs);

} // namespace palp::bench
