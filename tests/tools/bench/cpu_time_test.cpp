#include "engine/tools/bench/cpu_time.h"

#include <chrono>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "engine/compute/processor_list.h"

namespace palp::bench {
namespace {

TEST(CpuTime, QuartilesLieBetweenTheValues)
{
    const Quartiles five = quartiles({5, 1, 4, 2, 3}), two = quartiles({1, 2});

    EXPECT_EQ(five.lower, 2);
    EXPECT_EQ(five.median, 3);
    EXPECT_EQ(five.upper, 4);
    EXPECT_EQ(two.median, 1.5);
}

TEST(CpuTime, ContestantsTakeTurnsAfterOneThatDoesNotCount)
{
    std::string order;

    const auto timings =
        takeTurns({{"a", {[&] { order += 'a'; }, [&] { order += 'A'; }}}, {"b", {[&] { order += 'b'; }}}}, 3);

    EXPECT_EQ(order, "aAbaAbaAbaAb");
    ASSERT_EQ(timings.size(), 2U);
    EXPECT_EQ(timings[0].parts.size(), 2U);
    EXPECT_EQ(timings[1].parts.size(), 1U);
}

// The thread that waits for a GPU sleeps: its processor time says nothing of the work.
TEST(CpuTime, OnlyWorkOfThisMachinesProcessorsIsTimedByTheirs)
{
    using enum compute::ProcessorKind;
    for (const auto kind : {discrete, integrated, virtualGpu, other}) EXPECT_EQ(clockOf(kind), Clock::wall);
    for (const auto kind : {software, host}) EXPECT_EQ(clockOf(kind), Clock::processor);
}

TEST(CpuTime, WorkTakesTimeAndSleepDoesNot)
{
    const auto timings = takeTurns({{"work", {[] {
                                         volatile double sum = 0;
                                         for (int n = 0; n < 1'000'000; ++n) sum = sum + 1.0 / (n + 1);
                                     }}},
                                    {"sleep", {[] { std::this_thread::sleep_for(std::chrono::milliseconds(10)); }}}},
                                   11);

    EXPECT_GT(timings[0].total.median, 5 * timings[1].total.median) << "of processor time, which a sleeper has none of";
}

} // namespace
} // namespace palp::bench
