#include "engine/session/interrupt.h"

#include <csignal>
#include <cstdlib>

#include <gtest/gtest.h>
#include <unistd.h>

namespace palp {
namespace {

/// Gets a signal, another after that time, and ends as the flag says.
[[noreturn]] void stopTwice(useconds_t between)
{
    const std::atomic<bool>& stop = catchInterrupts();
    std::raise(SIGTERM);
    ::usleep(between);
    std::raise(SIGTERM);
    std::_Exit(stop ? 7 : 1);
}

TEST(Interrupts, ASignalThatComesTwiceAtOnceIsOneRequestAndALaterOneEndsTheProgram)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe"); // a program of its own: other tests have run threads
    EXPECT_EXIT(stopTwice(1'000), testing::ExitedWithCode(7), "") << "the session ends in order";
    EXPECT_EXIT(stopTwice(600'000), testing::KilledBySignal(SIGTERM), "");
}

} // namespace
} // namespace palp
