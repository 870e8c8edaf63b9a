#include "engine/tools/render/view_shapes.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

TEST(ViewShapes, AnEmptySceneHasNone)
{
    EXPECT_TRUE(shapesOf({}).empty());
}

TEST(ViewShapes, TheProxyIsABallAndTheHipAnOctahedronAroundIt)
{
    ViewScene scene;
    scene.proxy = scene.hip = glm::dvec3(1, 2, 3);
    scene.markerRadius      = 0.5;
    double tips             = 0; // farthest corner of the HIP [m]
    for (const ShapeCorner& corner : shapesOf(scene)) {
        const double away = glm::distance(corner.position, *scene.proxy);
        EXPECT_NEAR(glm::length(corner.normal), 1, 1e-12);
        if (corner.colour == kProxyColour)
            EXPECT_NEAR(away, 0.5, 1e-12);
        else
            tips = std::max(tips, away);
    }
    EXPECT_GT(tips, 0.6) << "the HIP's tips stand out of the proxy";
    EXPECT_LT(tips / std::sqrt(3.0), 0.5) << "and the proxy shows in its faces";
}

TEST(ViewShapes, NormalsOfAllTrianglesPointOutward)
{
    ViewScene scene;
    scene.proxy = scene.hip = glm::dvec3(0);
    scene.markerRadius      = 1;
    for (const ShapeCorner& corner : shapesOf(scene)) EXPECT_GT(glm::dot(corner.normal, corner.position), 0);
}

TEST(ViewShapes, AnArrowReachesFromItsFootToItsTipAndAnEmptyOneIsNotDrawn)
{
    ViewScene scene;
    scene.arrowRadius = 0.01;
    scene.force       = ViewSegment{{0, 0, 1}, {0, 0, 3}};
    scene.normal      = ViewSegment{{5, 5, 5}, {5, 5, 5}};
    double low = 10, high = -10, wide = 0; // [m]
    for (const ShapeCorner& corner : shapesOf(scene)) {
        EXPECT_EQ(corner.colour, kForceColour);
        low  = std::min(low, corner.position.z);
        high = std::max(high, corner.position.z);
        wide = std::max(wide, std::hypot(corner.position.x, corner.position.y));
    }
    EXPECT_NEAR(low, 1, 1e-12);
    EXPECT_NEAR(high, 3, 1e-12);
    EXPECT_GT(wide, 0.02) << "the head is wider than the shaft";
}

TEST(ViewShapes, AnArrowShorterThanItsHeadIsAHead)
{
    ViewScene scene;
    scene.arrowRadius = 1;
    scene.force       = ViewSegment{{0, 0, 0}, {0, 0, 0.5}};
    for (const ShapeCorner& corner : shapesOf(scene)) {
        EXPECT_GE(corner.position.z, -1e-12);
        EXPECT_LE(corner.position.z, 0.5 + 1e-12);
    }
}

TEST(ViewShapes, TheStylusReachesFromItsTipAlongItsAxisAndShowsHowItIsRolled)
{
    ViewScene scene;
    scene.stylus = ViewStylus{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}, 0.1, 0.004};
    double low = 10, high = -10, button = 0; // [m]
    for (const ShapeCorner& corner : shapesOf(scene)) {
        EXPECT_EQ(corner.colour, kStylusColour);
        EXPECT_NEAR(glm::length(corner.normal), 1, 1e-12);
        low    = std::min(low, corner.position.z);
        high   = std::max(high, corner.position.z);
        button = std::max(button, corner.position.y);
        EXPECT_GT(corner.position.y, -0.0041) << "on one side only";
    }
    EXPECT_NEAR(low, 0, 1e-12) << "the tip is where the hand is";
    EXPECT_NEAR(high, 0.1, 1e-12);
    EXPECT_GT(button, 0.006) << "the button stands out on its side";
}

} // namespace
} // namespace palp
