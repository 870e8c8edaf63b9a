#include "engine/core/extremes.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace palp {
namespace {

TEST(Extremes, AreFoundWhereverTheyAre)
{
    for (const std::size_t count : {1, 2, 7, 8, 9, 16, 23}) // fewer than, as many as and more than are looked at together
        for (std::size_t at = 0; at < count; ++at) {
            std::vector<double> values(count, 1.0);
            values[at] = -3;
            if (count > 1) values[(at + 1) % count] = 5;
            const Extremes of = extremesOf(values);
            EXPECT_TRUE(of.finite);
            EXPECT_EQ(of.least, -3);
            EXPECT_EQ(of.most, count > 1 ? 5 : -3);
        }
}

TEST(Extremes, OneValueThatIsNotFiniteIsFoundWhereverItIs)
{
    using Limits = std::numeric_limits<double>;
    for (const double bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()})
        for (std::size_t at = 0; at < 19; ++at) {
            std::vector<double> values(19, Limits::max()); // whose sum is infinite, which is no matter
            values[at] = bad;
            EXPECT_FALSE(extremesOf(values).finite) << bad << " at " << at;
        }
    EXPECT_TRUE(extremesOf(std::vector<double>(19, Limits::max())).finite);
}

} // namespace
} // namespace palp
