#pragma once
#include <ctime>

namespace palp {

/// Processor time that this thread has used [s]: what a computation costs, whatever else the machine has to do. Takes
/// some 0.3 us. Where the system has no such clock, processor time of the whole program.
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
