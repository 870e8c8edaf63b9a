#include "engine/session/interrupt.h"

#include <csignal>

#include "engine/session/detail/key_terminal.h"

namespace palp {
namespace {

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

void onInterrupt(int signal)
{
    interrupted = true;
    std::signal(signal, SIG_DFL);
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
