#include "engine/session/duration_histogram.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palp {
namespace {

constexpr double kBin = 1.0219; ///< 2^(1/32), rounded up: from the lower end of a bin to the upper one [1]

TEST(DurationHistogram, QuantilesAreThoseOfTheDurations)
{
    DurationHistogram durations;
    for (int n = 1; n <= 100'000; ++n) durations.add(1e-8 * n); // 10 ns to 1 ms
    EXPECT_EQ(durations.count(), 100'000U);
    EXPECT_EQ(durations.most(), 1e-3);
    for (const double share : {0.5, 0.9, 0.99, 0.999, 1.0}) {
        EXPECT_GE(durations.quantile(share), share * 1e-3 / kBin);
        EXPECT_LE(durations.quantile(share), share * 1e-3 * kBin);
    }
    EXPECT_LE(durations.quantile(0), 50e-9) << "the shortest lie below the first bin";
}

TEST(DurationHistogram, OfDurationsThatAreAlikeItIsExact)
{
    DurationHistogram durations;
    for (int n = 0; n < 1000; ++n) durations.add(1e-3);
    EXPECT_NEAR(durations.quantile(0.5), 1e-3, 1e-12) << "a tick every 1.02 ms, where every one took 1, is wrong";
}

TEST(DurationHistogram, OneLateTickIsSeenAtTheEndOnly)
{
    DurationHistogram durations;
    for (int n = 0; n < 9999; ++n) durations.add(1e-5);
    durations.add(0.2);
    EXPECT_LT(durations.quantile(0.999), 1.1e-5);
    EXPECT_EQ(durations.quantile(1), 0.2);
    EXPECT_EQ(durations.most(), 0.2);
}

TEST(DurationHistogram, NoneAndStrangeOnesDoNoHarm)
{
    DurationHistogram durations;
    EXPECT_EQ(durations.quantile(0.5), 0);
    durations.add(0);
    durations.add(-1);
    durations.add(1e9);
    EXPECT_EQ(durations.count(), 3U);
    EXPECT_EQ(durations.most(), 1e9);
    durations.add(std::nan(""));
    EXPECT_EQ(durations.count(), 4U);
}

} // namespace
} // namespace palp
