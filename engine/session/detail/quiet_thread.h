#pragma once
#include <csignal>
#include <thread>
#include <utility>

namespace palp {

/// Starts a thread that gets no signals: those are for the program's own thread, and a write beyond the limit on sizes
/// is then an error instead of the end.
template <class Work>
[[nodiscard]] std::thread quietThread(Work work)
{
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    std::thread thread(std::move(work));
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
}

} // namespace palp
