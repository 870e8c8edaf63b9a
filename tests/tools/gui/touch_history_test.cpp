#include "engine/tools/gui/touch_history.h"

#include <gtest/gtest.h>

namespace palp {
namespace {

TickRecord pressed(double time, double force)
{
    TickRecord s;
    s.time   = time;
    s.force  = {0, 0, force};
    s.normal = {0, 0, 1};
    s.hip    = {0, 0, -force * 1e-3};
    return s;
}

TEST(TouchHistory, KeepsTheLargestOfEachStepOldestFirst)
{
    TouchHistory history;
    for (int n = 0; n < 1001; ++n) history.add(pressed((n + 0.5) * 1e-3, n % 10 == 3 ? n / 10 + 1 : 0.5));
    ASSERT_EQ(history.forces().size(), 100U);
    EXPECT_FLOAT_EQ(history.forces().front(), 1);
    EXPECT_FLOAT_EQ(history.forces().back(), 100);
    EXPECT_FLOAT_EQ(history.depths().back(), 0.1F);
}

TEST(TouchHistory, ForgetsWhatIsOlderThanItsLength)
{
    TouchHistory history;
    for (int n = 0; n < 20000; ++n) history.add(pressed((n + 0.5) * 1e-3, n));
    ASSERT_EQ(history.forces().size(), TouchHistory::kSteps);
    EXPECT_FLOAT_EQ(history.forces().back(), 19989) << "the last whole step";
}

TEST(TouchHistory, CountsEachPeriodOnce)
{
    TouchHistory history;
    for (int n = 0; n < 101; ++n) history.add(pressed(n * 1e-3, 1));
    float sum = 0;
    for (const float bin : history.periods()) sum += bin;
    EXPECT_EQ(sum, 100);
}

TEST(TouchHistory, BeginsAnewWhenTimeGoesBack)
{
    TouchHistory history;
    for (int n = 0; n < 500; ++n) history.add(pressed(n * 1e-3, 1));
    history.add(pressed(0, 2));
    EXPECT_EQ(history.ticks(), 1U);
    EXPECT_TRUE(history.forces().empty());
}

} // namespace
} // namespace palp
