#pragma once
#include <ctime>

namespace palp {

/// Returns the processor time that this thread has used [s]: the cost of a computation, independent of other work on
/// the machine. The call takes some 0.3 us. Where the system has no such clock, it is the time of the whole program.
[[nodiscard]] inline double threadSeconds() noexcept
{
#ifdef CLOCK_THREAD_CPUTIME_ID
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
#else
    return double(std::clock()) / CLOCKS_PER_SEC;
#endif
}

} // namespace palp
