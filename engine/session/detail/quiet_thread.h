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
    class NoSignals { // until the thread has been started, or could not be
    public:
        NoSignals()
        {
            sigset_t all;
            ::sigfillset(&all);
            ::pthread_sigmask(SIG_SETMASK, &all, &before_);
        }
        ~NoSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

    private:
        sigset_t before_;
    } const none;
    return std::thread(std::move(work));
}

} // namespace palp
