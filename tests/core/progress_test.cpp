#include "engine/core/progress.h"

#include <array>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace palp {
namespace {

/// Standard error on a terminal of its own, while the object lives.
class Terminal {
public:
    Terminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)), before_(::dup(STDERR_FILENO))
    {
        if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) return;
        const int slave = ::open(::ptsname(master_), O_RDWR | O_NOCTTY);
        if (slave < 0) return;
        good_ = ::dup2(slave, STDERR_FILENO) >= 0;
        ::close(slave);
    }
    ~Terminal()
    {
        ::dup2(before_, STDERR_FILENO);
        ::close(before_);
        if (master_ >= 0) ::close(master_);
    }
    Terminal(const Terminal&)            = delete;
    Terminal& operator=(const Terminal&) = delete;

    [[nodiscard]] bool good() const { return good_; }

    /// What was written since the last call.
    [[nodiscard]] std::string text() const
    {
        std::array<char, 4096> bytes{};
        const ssize_t          count = ::read(master_, bytes.data(), bytes.size());
        return {bytes.data(), std::size_t(count > 0 ? count : 0)};
    }

private:
    int  master_, before_;
    bool good_ = false;
};

void wait(int milliseconds)
{
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

TEST(Progress, WorkThatMayLastIsNamedAfterTwoSecondsAndWipedAtItsEnd)
{
    const Terminal terminal;
    if (!terminal.good()) GTEST_SKIP() << "no terminal can be made here";

    {
        Progress progress("solving");
        progress.mayLast();
        wait(500);
        EXPECT_EQ(terminal.text(), "");
        wait(2000);
        EXPECT_TRUE(terminal.text().starts_with("\r\033[Ksolving: 2 s"));
    }
    EXPECT_EQ(terminal.text(), "\r\033[K");
}

TEST(Progress, ShortWorkIsNotMentionedAndDoesNotWait)
{
    const Terminal terminal;
    if (!terminal.good()) GTEST_SKIP() << "no terminal can be made here";
    const auto began = std::chrono::steady_clock::now();

    {
        Progress progress("solving");
        progress.mayLast();
    }

    EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(1));
    EXPECT_EQ(terminal.text(), "");
}

} // namespace
} // namespace palp
