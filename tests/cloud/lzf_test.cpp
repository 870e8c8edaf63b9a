#include "engine/cloud/detail/lzf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace palp {
namespace {

std::vector<std::byte> bytes(std::initializer_list<int> values)
{
    std::vector<std::byte> all;
    for (const int value : values) all.push_back(std::byte(value));
    return all;
}

TEST(Lzf, ARepetitionMayReachBackToTheFirstByte)
{
    std::vector<std::byte> out(6);
    EXPECT_FALSE(unpackLzf(bytes({1, 'a', 'b', 2 << 5, 1}), out).has_value()) << "a b, then four from two before";
    EXPECT_EQ(out, bytes({'a', 'b', 'a', 'b', 'a', 'b'}));
}

TEST(Lzf, NothingLiesBeforeTheFirstByte)
{
    std::vector<std::byte> out(6);
    EXPECT_TRUE(unpackLzf(bytes({1, 'a', 'b', 2 << 5, 2}), out).has_value());
    EXPECT_TRUE(unpackLzf(bytes({2 << 5, 0}), out).has_value());
}

TEST(Lzf, ALongRepetitionTakesItsLengthFromTheNextByte)
{
    std::vector<std::byte> out(1 + 7 + 20 + 2);
    EXPECT_FALSE(unpackLzf(bytes({0, 'a', 7 << 5, 20, 0}), out).has_value());
    EXPECT_EQ(std::ranges::count(out, std::byte('a')), 30);
    EXPECT_TRUE(unpackLzf(bytes({0, 'a', 7 << 5, 20}), out).has_value()) << "its distance is missing";
    EXPECT_TRUE(unpackLzf(bytes({0, 'a', 7 << 5, 21, 0}), out).has_value()) << "one byte more than there is room for";
    EXPECT_TRUE(unpackLzf(bytes({0, 'a', 7 << 5, 19, 0}), out).has_value()) << "one byte less";
}

} // namespace
} // namespace palp
