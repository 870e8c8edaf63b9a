#include "engine/core/running_median.h"

#include <algorithm>
#include <deque>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(RunningMedian, IsThatOfTheLastValuesSortedAnew)
{
    RunningMedian<7>                   running;
    std::deque<double>                 last;
    std::mt19937                       random(5);
    std::uniform_int_distribution<int> few(0, 9); // equal values are frequent
    EXPECT_EQ(running.value(42), 42) << "nothing yet";
    for (int n = 0; n < 10000; ++n) {
        const double value = few(random);
        running.add(value);
        last.push_back(value);
        if (last.size() > 7) last.pop_front();
        std::vector<double> sorted(last.begin(), last.end());
        std::ranges::sort(sorted);
        ASSERT_EQ(running.value(42), sorted[sorted.size() / 2]) << n;
    }
}

} // namespace
} // namespace palp
