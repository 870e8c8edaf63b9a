// Clocks that jump, for whole programs: loaded before the C library (LD_PRELOAD), it stands between a program and its
// clocks. JUMPING_CLOCK_AFTER=SECONDS after its first look, what JUMPING_CLOCK names jumps by JUMPING_CLOCK_BY=SECONDS:
// "wall", the clock on the wall, as when somebody sets it; "all", every clock; "sleep", those that count the time for
// which a machine is suspended, as when it wakes.
#include <cstdlib>
#include <cstring>
#include <ctime>

#include <dlfcn.h>

namespace {

using ClockGetTime   = int(clockid_t, timespec*);
using ClockNanosleep = int(clockid_t, int, const timespec*, timespec*);

template <class Function>
Function* next(const char* name)
{
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

double seconds(const char* name)
{
    const char* const text = std::getenv(name);
    return text ? std::atof(text) : 0;
}

/// Reads a clock as it is.
int read(clockid_t clock, timespec* time)
{
    static const auto real = next<ClockGetTime>("clock_gettime");
    return real(clock, time);
}

double monotonic()
{
    timespec now{};
    read(CLOCK_MONOTONIC, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// Returns by how much a clock has jumped so far [s].
time_t jumpOf(clockid_t clock)
{
    static const char* const which = std::getenv("JUMPING_CLOCK");
    static const double      at = monotonic() + seconds("JUMPING_CLOCK_AFTER"), by = seconds("JUMPING_CLOCK_BY");
    const auto               is    = [](const char* name) { return which && !std::strcmp(which, name); };
    const bool               jumps = clock == CLOCK_REALTIME || (clock == CLOCK_MONOTONIC && is("all")) ||
                       (clock == CLOCK_BOOTTIME && (is("all") || is("sleep")));
    return which && jumps && monotonic() > at ? time_t(by) : 0;
}

} // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept
{
    const int result = read(clock, time);
    time->tv_sec += jumpOf(clock);
    return result;
}

/// Instants are of the clock that has jumped.
extern "C" int clock_nanosleep(clockid_t clock, int flags, const timespec* until, timespec* left)
{
    static const auto real  = next<ClockNanosleep>("clock_nanosleep");
    timespec          there = *until;
    if (flags & TIMER_ABSTIME) there.tv_sec -= jumpOf(clock);
    return real(clock, flags, &there, left);
}
