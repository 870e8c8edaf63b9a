#include "engine/core/real_time.h"

#include <cerrno>
#include <cstring>
#include <ctime>

#ifdef __linux__
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#endif

namespace palp {
#ifdef __linux__
namespace {

/// Returns whether more memory than the limit may be locked. Asked by a map that takes none.
bool mayLockBeyondTheLimit()
{
    rlimit limit{};
    if (getrlimit(RLIMIT_MEMLOCK, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return true;
    const std::size_t size = limit.rlim_cur + 1; // [byte] at least a page beyond it
    void* const       map  = mmap(nullptr, size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_LOCKED, -1, 0);
    if (map != MAP_FAILED) munmap(map, size);
    return map != MAP_FAILED;
}

/// Returns 0 or an error of mlockall(). A small program fits into a limit, and if what it takes later were locked too,
/// its next thread would not start: its stack would be beyond the limit. So there nothing is locked.
int lockMemory()
{
    if (!mayLockBeyondTheLimit()) return ENOMEM;
    return mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno;
}

} // namespace
#endif

std::string askForRealTime()
{
#ifdef __linux__
    constexpr int kPriority = 80; // above the kernel's threads for interrupts, which have 50
    sched_param   wanted{};
    wanted.sched_priority = kPriority;
    const int scheduling  = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
    // It locks the memory of the whole program, so one call is enough; the call may take a quarter of a second.
    static const int locking = lockMemory();
    const bool       locked  = locking == 0;
    if (scheduling == 0 && locked) return {};
    std::string refused;
    if (scheduling != 0) refused = std::string("SCHED_FIFO (") + std::strerror(scheduling) + ")";
    if (!locked) refused += std::string(refused.empty() ? "" : " and ") + "mlockall (" + std::strerror(locking) + ")";
    return "no real-time rights: " + refused +
           " refused; ticks may be late. Allow it with a line \"@realtime - rtprio 90\" and one \"@realtime - memlock "
           "unlimited\" in /etc/security/limits.conf and membership of that group";
#else
    return "real-time scheduling is only asked for on Linux; ticks may be late";
#endif
}

double timeAsleep() noexcept
{
#ifdef __linux__
    timespec counted{}, all{};
    if (clock_gettime(CLOCK_MONOTONIC, &counted) != 0 || clock_gettime(CLOCK_BOOTTIME, &all) != 0) return 0;
    return double(all.tv_sec - counted.tv_sec) + 1e-9 * double(all.tv_nsec - counted.tv_nsec);
#else
    return 0;
#endif
}

double SleepWatch::slept() noexcept
{
    constexpr double kLeast = 0.05; // [s] no machine wakes within less; two clocks are not read at once
    const double     since  = timeAsleep() - asleep_;
    if (!(since > kLeast)) return 0;
    asleep_ += since;
    return since;
}

Metronome::Clock::time_point Metronome::wait() noexcept
{
    next_ += period_;
    const auto now = Clock::now();
    if (now > next_ + period_) {
        const auto late = (now - next_) / period_;
        next_ += late * period_;
        leftOut_ += std::uint64_t(late);
    }
#ifdef __linux__ // std::this_thread::sleep_until() does the same but is not noexcept
    const auto     since = next_.time_since_epoch();
    const auto     whole = std::chrono::duration_cast<std::chrono::seconds>(since);
    const timespec until{time_t(whole.count()), long(std::chrono::nanoseconds(since - whole).count())};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
#else
    while (Clock::now() < next_) {
    }
#endif
    return Clock::now();
}

} // namespace palp
