#include "engine/core/latest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <thread>

namespace palp {
namespace {

TEST(Latest, NothingIsHeldBeforeSomethingIsPublished)
{
    Latest<int> latest;
    EXPECT_FALSE(latest.take());
    EXPECT_EQ(latest.held(), nullptr);
    latest.draft() = 7;
    EXPECT_FALSE(latest.take()) << "a draft is not published";
    latest.publish();
    EXPECT_TRUE(latest.take());
    EXPECT_EQ(*latest.held(), 7);
    EXPECT_FALSE(latest.take()) << "taken once";
    EXPECT_EQ(*latest.held(), 7) << "and kept";
}

TEST(Latest, TheNewestWinsAndTheHeldOneStays)
{
    Latest<int> latest;
    for (int n = 1; n <= 3; ++n) {
        latest.draft() = n;
        latest.publish();
    }
    EXPECT_TRUE(latest.take());
    const int* held = latest.held();
    EXPECT_EQ(*held, 3);
    for (int n = 4; n <= 20; ++n) {
        latest.draft() = n;
        latest.publish();
        EXPECT_EQ(*held, 3) << "the writer never touches what the reader holds";
    }
    EXPECT_TRUE(latest.take());
    EXPECT_EQ(*latest.held(), 20);
}

/// Values as large as a cache line, so that a torn one shows. Under ThreadSanitizer also the proof of the ordering.
TEST(Latest, NoValueIsTornAndNoneComesTwiceBackwards)
{
    constexpr int kMessages = 200'000;
    using Value             = std::array<int, 64>;
    Latest<Value> latest;
    std::thread   writer([&] {
        for (int n = 1; n <= kMessages; ++n) {
            latest.draft().fill(n);
            latest.publish();
        }
    });
    int           last = 0, torn = 0, backwards = 0;
    while (last < kMessages) {
        if (!latest.take()) continue;
        const Value& value = *latest.held();
        torn += !std::ranges::all_of(value, [&](int v) { return v == value[0]; });
        backwards += value[0] <= last;
        last = value[0];
    }
    writer.join();
    EXPECT_EQ(torn, 0);
    EXPECT_EQ(backwards, 0);
}

} // namespace
} // namespace palp
