#include "engine/core/progress.h"

#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/terminal.h"

namespace palp {
namespace {

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
