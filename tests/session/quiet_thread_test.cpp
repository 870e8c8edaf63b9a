#include "engine/session/detail/quiet_thread.h"

#include <csignal>
#include <stdexcept>

#include <gtest/gtest.h>

namespace palp {
namespace {

bool isBlocked(int signal)
{
    sigset_t now;
    ::pthread_sigmask(SIG_BLOCK, nullptr, &now);
    return sigismember(&now, signal) == 1;
}

TEST(QuietThread, GetsNoSignalsAndItsStarterDoes)
{
    bool quiet = false;
    quietThread([&] { quiet = isBlocked(SIGTERM) && isBlocked(SIGXFSZ); }).join();

    EXPECT_TRUE(quiet);
    EXPECT_FALSE(isBlocked(SIGTERM));
}

/// Work for which no thread can be started.
struct Unmovable {
    Unmovable()                 = default;
    Unmovable(const Unmovable&) = default;
    Unmovable(Unmovable&&) { throw std::runtime_error("as std::thread where there are none left"); }
    void operator()() const {}
};

TEST(QuietThread, AStarterHearsSignalsThoughNoThreadWasLeft)
{
    const Unmovable work;
    EXPECT_THROW(static_cast<void>(quietThread(work)), std::runtime_error);
    EXPECT_FALSE(isBlocked(SIGTERM));
}

} // namespace
} // namespace palp
