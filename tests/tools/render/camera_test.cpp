#include "engine/tools/render/camera.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "engine/tools/render/touch_view.h"

namespace palp {
namespace {

constexpr double kRounding = 1e-12;

Camera someCamera()
{
    Camera camera;
    camera.target   = {0.1, -0.2, 0.3};
    camera.toEye    = glm::normalize(glm::dvec3(1, -2, 1.5));
    camera.up       = {0, 0, 1};
    camera.distance = 0.4;
    return camera;
}

/// Where a place of the world comes out: -1 to 1, y down, depth 0 to 1.
glm::dvec3 seen(const CameraMatrices& matrices, const glm::dvec3& place, const glm::dvec3& origin)
{
    const glm::dvec4 clip = matrices.clipFromView * (matrices.viewFromWorld * glm::dvec4(place - origin, 1));
    return glm::dvec3(clip) / clip.w;
}

TEST(Camera, TheTargetIsSeenAtTheCentreWhereverThatIs)
{
    for (Camera camera : {someCamera(), otherProjection(someCamera())}) {
        camera.centre                 = {0.4, -0.25};
        const CameraMatrices matrices = matricesOf(camera, {}, 0.2, 1.5);
        const glm::dvec3     at       = seen(matrices, camera.target, {});
        EXPECT_NEAR(at.x, 0.4 / 1.5, kRounding) << "of half the width";
        EXPECT_NEAR(at.y, 0.25, kRounding) << "downwards";
        const glm::dvec3 middle = seen(matrices, camera.middle(), {});
        EXPECT_NEAR(middle.x, 0, kRounding);
        EXPECT_NEAR(middle.y, 0, kRounding);
        EXPECT_NEAR(glm::distance(camera.eye(), camera.middle()), camera.distance, kRounding);
    }
}

TEST(Camera, TheTargetIsInTheMiddleAndUpIsUp)
{
    for (const Camera& camera : {someCamera(), otherProjection(someCamera())}) {
        const glm::dvec3     origin(1, 2, 3);
        const CameraMatrices matrices = matricesOf(camera, origin, 0.2, 1.5);
        const glm::dvec3     middle   = seen(matrices, camera.target, origin);
        EXPECT_NEAR(middle.x, 0, kRounding);
        EXPECT_NEAR(middle.y, 0, kRounding);
        EXPECT_LT(seen(matrices, camera.target + 0.01 * camera.up, origin).y, -1e-3) << "Vulkan's y points down";
        EXPECT_GT(seen(matrices, camera.target + 0.01 * camera.right(), origin).x, 1e-3);
    }
}

TEST(Camera, HalfHeightIsWhatTheUpperEdgeShowsInBothProjections)
{
    for (const Camera& camera : {someCamera(), otherProjection(someCamera())}) {
        const CameraMatrices matrices = matricesOf(camera, {}, 0.2, 1.5);
        const glm::dvec3     edge     = camera.target + camera.halfHeight() * camera.upwards();
        const glm::dvec3     side     = camera.target + 1.5 * camera.halfHeight() * camera.right();
        EXPECT_NEAR(seen(matrices, edge, {}).y, -1, 1e-9);
        EXPECT_NEAR(seen(matrices, side, {}).x, 1, 1e-9);
    }
}

TEST(Camera, DepthsRiseFromTheEyeAndStayInRange)
{
    for (const Camera& camera : {someCamera(), otherProjection(someCamera())}) {
        const double         reach    = 0.2; // [m]
        const CameraMatrices matrices = matricesOf(camera, {}, reach, 1);
        double               last     = 2;
        for (double along = -reach; along <= reach + 1e-9; along += reach / 4) {
            const double depth = seen(matrices, camera.target + along * camera.toEye, {}).z;
            EXPECT_GE(depth, -1e-9);
            EXPECT_LT(depth, last) << "nearer is less";
            last = depth;
        }
    }
}

TEST(Camera, HalfAtOneLeadsFromPixelsBackToPlaces)
{
    const Camera         camera   = someCamera();
    const CameraMatrices matrices = matricesOf(camera, camera.target, 0.2, 1.25);
    const glm::dvec3     place(0.02, -0.03, 0.04); // about the target [m]
    const glm::dvec3     at    = seen(matrices, place, {});
    const glm::dvec3     view  = glm::dvec3(matrices.viewFromWorld * glm::dvec4(place, 1));
    const double         depth = -view.z;
    EXPECT_NEAR(at.x * matrices.halfAtOne.x * depth, view.x, 1e-9);
    EXPECT_NEAR(-at.y * matrices.halfAtOne.y * depth, view.y, 1e-9);
}

TEST(Camera, OrbitKeepsTargetAndDistanceAndNeverTipsOver)
{
    Camera camera = someCamera();
    for (int n = 0; n < 400; ++n) {
        camera = orbited(camera, {0.1, 0.05});
        ASSERT_NEAR(glm::length(camera.toEye), 1, 1e-9);
        ASSERT_GT(glm::dot(camera.upwards(), camera.up), 0) << "upside down after " << n << " steps";
    }
    EXPECT_EQ(camera.target, someCamera().target);
    EXPECT_EQ(camera.distance, someCamera().distance);
    EXPECT_GT(glm::dot(camera.toEye, camera.up), 0.99) << "upwards brings the eye above";
}

TEST(Camera, OrbitUpwardsByAnAngleRaisesTheEyeByIt)
{
    const Camera before = someCamera(), after = orbited(before, {0, 0.2});
    const auto   height = [](const Camera& c) { return std::asin(glm::dot(c.toEye, c.up)); };
    EXPECT_NEAR(height(after) - height(before), 0.2, 1e-9);
    const Camera around = orbited(before, {2 * glm::pi<double>(), 0});
    EXPECT_NEAR(glm::distance(around.toEye, before.toEye), 0, 1e-9);
}

TEST(Camera, PanMovesThePictureWithTheHand)
{
    const Camera     before = someCamera(), after = panned(before, {0.5, -0.25});
    const glm::dvec3 now = seen(matricesOf(after, {}, 0.2, 1), before.target, {});
    EXPECT_NEAR(now.x, 0.5, 1e-9);
    EXPECT_NEAR(now.y, 0.25, 1e-9);
}

TEST(Camera, FramedShowsTheWholeBallAndFillsThePicture)
{
    for (const double aspect : {0.5, 1.0, 2.0})
        for (const Camera& start : {someCamera(), otherProjection(someCamera())}) {
            const double         radius = 0.07; // [m]
            const glm::dvec3     centre(0.5, 0.6, 0.7);
            const Camera         camera   = framed(start, centre, radius, aspect);
            const CameraMatrices matrices = matricesOf(camera, {}, radius, aspect);
            double               widest   = 0;
            for (int n = 0; n < 360; ++n) {
                const double     angle = n * glm::pi<double>() / 180;
                const glm::dvec3 edge =
                    centre + radius * (std::cos(angle) * camera.right() + std::sin(angle) * camera.upwards());
                const glm::dvec3 at = seen(matrices, edge, {});
                widest              = std::max({widest, std::abs(at.x), std::abs(at.y)});
            }
            EXPECT_LT(widest, 1);
            EXPECT_GT(widest, 0.85);
        }
}

/// Or pictures of one object, touched here and there, could not be compared.
TEST(Camera, LooksTheSameWayHoweverTheWindowStands)
{
    Patch patch;
    patch.window          = PatchWindow::square(40e-3, 16);
    patch.chart.frame     = Frame::about(glm::normalize(glm::dvec3(0.1, 0.2, 1)));
    const Camera straight = cameraAt(patch, 1.5);
    patch.chart.frame     = patch.chart.frame.turned(0.7);
    EXPECT_LT(glm::distance(cameraAt(patch, 1.5).toEye, straight.toEye), kRounding);
}

TEST(Camera, DollyByZeroIsAMistake)
{
    EXPECT_NEAR(dollied(someCamera(), 0.5).distance, 0.2, kRounding);
    EXPECT_ANY_THROW((void)dollied(someCamera(), 0));
}

} // namespace
} // namespace palp
