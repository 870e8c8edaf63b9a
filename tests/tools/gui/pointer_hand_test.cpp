#include "engine/tools/gui/pointer_hand.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

const Bounds kBox{{-0.05, -0.05, -0.01}, {0.05, 0.05, 0}};

/// Where the hand is after a time that is long for its spring.
glm::dvec3 settled(PointerHand& hand, double& time)
{
    HapticState state;
    for (int n = 0; n < 500; ++n) state = hand.device().exchange({}, time += 1e-3);
    return hand.frame().handOf(state).position;
}

TEST(PointerHand, HoversPressesAndSpringsBack)
{
    double      time = 0;
    PointerHand hand({{0.01, 0, 0}, {0, 0, 1}}, 10e-3, kBox);
    EXPECT_NEAR(glm::distance(settled(hand, time), {0.01, 0, 10e-3}), 0, 1e-9);
    ASSERT_TRUE(hand.press({{0.02, 0, 0}, {0, 0, 1}}, 1.5e-3));
    EXPECT_TRUE(hand.pressing());
    EXPECT_NEAR(glm::distance(settled(hand, time), {0.02, 0, -1.5e-3}), 0, 1e-9);
    hand.release();
    EXPECT_NEAR(glm::distance(settled(hand, time), {0.02, 0, 10e-3}), 0, 1e-9);
}

TEST(PointerHand, AMarkIsTheDevicesSecondButtonWhereverTheHandGoes)
{
    double      time = 0;
    PointerHand hand({{0, 0, 0}, {0, 0, 1}}, 10e-3, kBox);
    ASSERT_TRUE(hand.press({{0.01, 0, 0}, {0, 0, 1}}, 1e-3));
    hand.mark(true);
    EXPECT_EQ(hand.device().exchange({}, time += 1e-3).buttons, 2u);
    EXPECT_NEAR(glm::distance(settled(hand, time), {0.01, 0, -1e-3}), 0, 1e-9) << "it stays where it presses";
    ASSERT_TRUE(hand.press({{0.02, 0, 0}, {0, 0, 1}}, 1e-3));
    EXPECT_EQ(hand.device().exchange({}, time += 1e-3).buttons, 2u);
    hand.mark(false);
    EXPECT_EQ(hand.device().exchange({}, time += 1e-3).buttons, 0u);
}

TEST(PointerHand, DoesNotGoThroughTheObjectToItsOtherSide)
{
    double      time = 0;
    PointerHand hand({{0, 0, 0}, {0, 0, 1}}, 10e-3, kBox);
    const Hit   below{{0, 0, -0.01}, {0, 0, -1}};
    EXPECT_FALSE(hand.press(below, 1e-3));
    EXPECT_NEAR(glm::distance(settled(hand, time), {0, 0, 10e-3}), 0, 1e-9) << "nothing has happened";
    hand.begin(below);
    time = 0;
    EXPECT_NEAR(glm::distance(settled(hand, time), {0, 0, -20e-3}), 0, 1e-9);
    EXPECT_TRUE(hand.press(below, 1e-3));
}

} // namespace
} // namespace palp
