#include "engine/plate/detail/hard_plates.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/plate/detail/memory_shortage.h"

namespace palp {
namespace {

Plate discOf(double contrast, int cells = 32)
{
    Plate plate;
    plate.grid     = {cells, cells, 1e-3, 1e-3};
    plate.rigidity = NodeField(plate.grid, 1);
    for (int i = cells / 4; i <= cells / 2; ++i)
        for (int j = cells / 4; j <= cells / 2; ++j) plate.rigidity(i, j) = contrast;
    return plate;
}

Plate slopeOf(double contrast)
{
    Plate plate = discOf(1);
    for (int i = 0; i <= 32; ++i)
        for (int j = 0; j <= 32; ++j) plate.rigidity(i, j) = std::pow(contrast, i / 32.0);
    return plate;
}

TEST(HardPlates, APlateIsLikeAnotherByGridEdgesContrastAndJump)
{
    HardPlates hard;
    EXPECT_EQ(hard.knownBecause(discOf(1e6), 1e-4), nullptr);
    hard.remember(discOf(1e6), 1e-4, "too hard");
    ASSERT_NE(hard.knownBecause(discOf(1e6), 1e-4), nullptr);
    EXPECT_EQ(*hard.knownBecause(discOf(1e6), 1e-4), "too hard");
    EXPECT_NE(hard.knownBecause(discOf(1e6), 1e-5), nullptr) << "what is too hard is not easier";
    EXPECT_EQ(hard.knownBecause(discOf(1e6), 1e-3), nullptr) << "a looser tolerance may be reached";
    EXPECT_NE(hard.knownBecause(discOf(6e5), 1e-4), nullptr);
    EXPECT_EQ(hard.knownBecause(discOf(4e5), 1e-4), nullptr);
    EXPECT_EQ(hard.knownBecause(slopeOf(1e6), 1e-4), nullptr)
        << "as much contrast without a jump is solved in a few steps";
    EXPECT_EQ(hard.knownBecause(discOf(1e6, 40), 1e-4), nullptr);
    Plate other = discOf(1e6);
    other.edges = {Edge::clamped, Edge::free, Edge::free, Edge::free};
    EXPECT_EQ(hard.knownBecause(other, 1e-4), nullptr);
}

/// A rim that is resampled may fall between two steps, each of the root of it.
TEST(HardPlates, ARimInTwoStepsIsAsHard)
{
    HardPlates hard;
    hard.remember(discOf(1e6), 1e-4, "too hard");
    Plate plate = discOf(1e6);
    for (int j = 8; j <= 16; ++j) plate.rigidity(7, j) = plate.rigidity(17, j) = 1e3;
    for (int i = 8; i <= 16; ++i) plate.rigidity(i, 7) = plate.rigidity(i, 17) = 1e3;
    EXPECT_NEAR(largestJump(plate), 1e3, 1e-9);
    EXPECT_NE(hard.knownBecause(plate, 1e-4), nullptr);
}

/// Windows are fitted to what is touched, so that no two spacings are equal.
TEST(HardPlates, SpacingAndFoundationNeedNotBeTheSame)
{
    HardPlates hard;
    Plate      plate = discOf(1e6);
    plate.foundation = 1e5;
    hard.remember(plate, 1e-4, "too hard");
    plate.grid.spacingX *= 1.000001;
    plate.grid.spacingZ *= 0.95;
    plate.foundation *= 1.5;
    EXPECT_NE(hard.knownBecause(plate, 1e-4), nullptr);
    plate.grid.spacingX *= 1.2;
    EXPECT_EQ(hard.knownBecause(plate, 1e-4), nullptr);
    plate.grid.spacingX = 1e-3;
    plate.foundation    = 1e6;
    EXPECT_EQ(hard.knownBecause(plate, 1e-4), nullptr);
}

/// What is hard about such a plate is not its rigidity.
TEST(HardPlates, APlateThatIsHardWithoutAJumpNeedsNone)
{
    HardPlates hard;
    hard.remember(slopeOf(10), 1e-4, "too soft");
    EXPECT_NE(hard.knownBecause(slopeOf(9), 1e-4), nullptr);
    EXPECT_NE(hard.knownBecause(discOf(10), 1e-4), nullptr);
}

TEST(MemoryShortage, WhatDidNotFitIsTriedAgainLaterAndLater)
{
    MemoryShortage shortage;
    EXPECT_GT(shortage.most(), std::size_t(1) << 60);
    shortage.foundAt(100);
    const auto refusals = [&] { // of 100 before it is tried again
        int n = 0;
        while (shortage.most() < 100) {
            EXPECT_EQ(shortage.most() + 1, 100U);
            n += 2;
        }
        return n;
    };
    EXPECT_EQ(refusals(), 64);
    shortage.foundAt(100);
    EXPECT_EQ(refusals(), 128);
    shortage.foundAt(100);
    shortage.fitted(99);
    EXPECT_EQ(shortage.most(), 99U) << "that less fits says nothing";
    shortage.foundAt(50);
    EXPECT_EQ(shortage.most(), 49U);
    shortage.fitted(50);
    EXPECT_GT(shortage.most(), std::size_t(1) << 60) << "there is memory again";
    shortage.foundAt(100);
    EXPECT_EQ(refusals(), 64) << "and no memory of the shortage";
}

} // namespace
} // namespace palp
