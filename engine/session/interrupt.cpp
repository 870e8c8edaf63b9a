#include "engine/session/interrupt.h"

#include <csignal>
#include <cstdint>
#include <ctime>

#include "engine/session/detail/key_terminal.h"

namespace palp {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

constexpr std::int64_t kRepeat = 300'000'000; // [ns] within which a signal is the same request, sent to child and group
std::atomic<std::int64_t> asked = 0;          ///< [ns] when the first request came; 0: none has
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "a signal handler reads it");

/// The second request ends the program, as the first would without catchInterrupts(). It calls what signal handlers
/// may.
void onInterrupt(int signal)
{
    timespec time{};
    ::clock_gettime(CLOCK_MONOTONIC, &time);
    const std::int64_t now    = std::int64_t(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
    std::int64_t       before = 0;
    interrupted               = true;
    if (asked.compare_exchange_strong(before, now) || now - before < kRepeat) return;
    std::signal(signal, SIG_DFL);
    std::raise(signal); // as soon as the handler returns
}

std::atomic<int>  sessions    = 0; ///< that send zero before the program stops
std::atomic<bool> asksForZero = false;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler reads it");

void onStop(int /*signal*/)
{
    if (sessions > 0)
        asksForZero = true;
    else
        KeyTerminal::stopProgram();
}

} // namespace

const std::atomic<bool>& catchInterrupts()
{
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) std::signal(signal, onInterrupt);
    std::signal(SIGTSTP, onStop);
    return interrupted;
}

ZeroBeforeStop::ZeroBeforeStop() noexcept
{
    ++sessions;
}

ZeroBeforeStop::~ZeroBeforeStop()
{
    --sessions;
    if (isAsked()) stop();
}

bool ZeroBeforeStop::isAsked() const noexcept
{
    return asksForZero;
}

void ZeroBeforeStop::stop() noexcept
{
    asksForZero = false;
    KeyTerminal::stopProgram();
}

} // namespace palp
