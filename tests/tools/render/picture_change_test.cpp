#include "engine/tools/render/picture_change.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

/// An orthographic eye above a plane of 2 m by 2 m, drawn 100 px wide and high.
struct Plane {
    Plane()
    {
        frame.viewFromWorld      = glm::translate(glm::mat4(1), {0, 0, -1});
        frame.clipFromView       = glm::mat4(1);
        frame.clipFromView[1][1] = -1; // rows from the top
        frame.width = frame.height = 100;
        frame.widthAtOne = frame.heightAtOne = 1;
        frame.orthographic                   = 1;
        splats                               = {{{0, 0, 0}, 0.1F, {0, 0, 1}, 7}, {{0.5F, 0.5F, 0}, 0.1F, {0, 0, 1}, 7}};
    }
    [[nodiscard]] SurfaceInput input() const
    {
        SurfaceInput input;
        input.frame  = frame;
        input.splats = splats;
        input.shapes = shapes;
        input.faces  = faces;
        input.detail = Detail::fast;
        return input;
    }
    shared::ViewFrame               frame{};
    std::vector<shared::ViewSplat>  splats;
    std::vector<shared::ViewCorner> shapes;
    std::vector<std::uint32_t>      faces;
};

TEST(PictureChange, NothingChangesWhereBothAreTheSame)
{
    const Plane a, b;
    EXPECT_TRUE(changedPart(a.input(), b.input())->empty());
}

TEST(PictureChange, APointThatMovesCoversWhereItWasAndWhereItIs)
{
    const Plane a;
    Plane       b;
    b.splats[1].position.x = 0.3F;
    const auto part        = changedPart(a.input(), b.input());
    ASSERT_TRUE(part);
    // From 0.3 to 0.5 m are pixels 65 to 75, and its radius is 5 px; no more than as much again and some pixels are
    // left.
    EXPECT_LE(part->left, 65 - 5);
    EXPECT_GE(part->right, 75 + 5);
    EXPECT_LE(part->top, 25 - 5);
    EXPECT_GE(part->bottom, 25 + 5);
    EXPECT_GE(part->left, 65 - 10 - 4);
    EXPECT_LE(part->right, 75 + 10 + 4);
    EXPECT_GE(part->top, 25 - 10 - 4);
    EXPECT_LE(part->bottom, 25 + 10 + 4);
}

TEST(PictureChange, AColourAloneIsAChange)
{
    const Plane a;
    Plane       b;
    b.splats[0].colour = 8;
    EXPECT_FALSE(changedPart(a.input(), b.input())->empty());
}

TEST(PictureChange, OfAFaceWithOneCornerMovedAllIsDrawnAgain)
{
    Plane a;
    a.splats.push_back({{-0.8F, -0.8F, 0}, 0.1F, {0, 0, 1}, 7});
    a.faces                = {0, 1, 2};
    Plane b                = a;
    b.splats[1].position.z = 0.1F;
    const auto part        = changedPart(a.input(), b.input());
    ASSERT_TRUE(part);
    EXPECT_LE(part->left, 10);
    EXPECT_GE(part->bottom, 90);
}

TEST(PictureChange, AShapeThatComesOrGoesIsDrawnAgain)
{
    const Plane a;
    Plane       b;
    b.shapes = {{{0.8F, 0, 0}, 1, {}, 0}, {{0.9F, 0, 0}, 1, {}, 0}, {{0.9F, 0.1F, 0}, 1, {}, 0}};
    for (const auto& part : {changedPart(a.input(), b.input()), changedPart(b.input(), a.input())}) {
        ASSERT_TRUE(part);
        EXPECT_LE(part->left, 90);
        EXPECT_GE(part->right, 95);
        EXPECT_GT(part->left, 80) << "the rest stays";
    }
}

TEST(PictureChange, AnotherEyeOtherDetailOrOtherNumbersOfPointsDrawAllAnew)
{
    const Plane a;
    Plane       b;
    b.frame.cueGain = 1;
    EXPECT_FALSE(changedPart(a.input(), b.input()));
    b = {};
    b.splats.pop_back();
    EXPECT_FALSE(changedPart(a.input(), b.input()));
    SurfaceInput fine = a.input();
    fine.detail       = Detail::fine;
    EXPECT_FALSE(changedPart(a.input(), fine));
    EXPECT_FALSE(changedPart(fine, a.input()));
}

TEST(PictureChange, WhatMovesBehindTheEyeDrawsAllAnew)
{
    Plane a;
    a.frame.orthographic   = 0;
    Plane b                = a;
    b.splats[0].position.z = 3;
    EXPECT_FALSE(changedPart(a.input(), b.input()));
}

TEST(PictureChange, OfTextsTheSquaresThatDiffer)
{
    Overlay a{100, 50, std::vector<std::uint32_t>(5000), {}};
    a.pixels[40] = 1; // column 40 of row 0
    a.tiles      = {1};
    Overlay b    = a;
    EXPECT_TRUE(changedPart(a, b).empty());
    b.pixels[40 * 100 + 99] = 1; // the last column of row 40
    b.tiles                 = {1, 3 | 1U << 16};
    const PixelRect part = changedPart(a, b), back = changedPart(b, a);
    EXPECT_EQ(part.left, 96);
    EXPECT_EQ(part.top, 32);
    EXPECT_EQ(part.right, 100);
    EXPECT_EQ(part.bottom, 50);
    EXPECT_EQ(back.left, part.left);
}

} // namespace
} // namespace palp
