#include "engine/tools/gui/panel_layout.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

/// Where a place comes out in a picture, from its upper left corner [px].
glm::dvec2 seen(const Camera& camera, const glm::dvec3& place, const glm::ivec2& size)
{
    const CameraMatrices matrices = matricesOf(camera, {}, 10, double(size.x) / size.y);
    const glm::dvec4     clip     = matrices.clipFromView * (matrices.viewFromWorld * glm::dvec4(place, 1));
    return glm::dvec2(size) * (0.5 + 0.5 * glm::dvec2(clip) / clip.w);
}

bool inside(const PictureArea& area, const glm::dvec2& at)
{
    const glm::dvec2 from = at - area.corner;
    return from.x > 0 && from.y > 0 && from.x < area.size.x && from.y < area.size.y;
}

TEST(PanelLayout, ABallIsFramedWithinWhatThePanelsLeaveFree)
{
    constexpr double kRadius = 0.05; // [m]
    for (const glm::ivec2& size : {glm::ivec2(1280, 720), {640, 480}, {480, 900}, {2560, 1440}})
        for (const double scale : {1.0, 2.0})
            for (const bool panels : {true, false}) {
                ViewState state;
                state.panels           = panels;
                const PictureArea area = freeArea(state, size, scale);
                Camera            camera;
                camera.toEye  = glm::normalize(glm::dvec3(1, -2, 1));
                camera.up     = {0, 0, 1};
                camera.centre = centreOf(area, size);
                camera        = framed(camera, {0.3, 0.1, -0.2}, kRadius, std::min(area.size.x, area.size.y) / size.y);
                const glm::dvec2 middle = seen(camera, camera.target, size);
                EXPECT_NEAR(glm::distance(middle, area.corner + 0.5 * area.size), 0, 1e-9) << "rounding of pixels";
                double farthest = 0;            // [px]
                for (int n = 0; n < 720; ++n) { // its outline, nearly
                    const double     angle = n * 3.14159265358979 / 360;
                    const glm::dvec3 rim   = camera.target + kRadius * (std::cos(angle) * camera.right() +
                                                                      std::sin(angle) * camera.upwards());
                    ASSERT_TRUE(inside(area, seen(camera, rim, size)))
                        << size.x << " x " << size.y << " at " << scale << (panels ? " with panels" : "");
                    farthest = std::max(farthest, glm::distance(seen(camera, rim, size), middle));
                }
                EXPECT_GT(farthest, 0.4 * std::min(area.size.x, area.size.y)) << "and it fills the room";
            }
}

TEST(PanelLayout, AHuntHasAllOfThePicture)
{
    ViewState state;
    state.blind            = true; // and no panels, although nobody has hidden them
    const PictureArea area = freeArea(state, {1280, 720}, 1);
    EXPECT_EQ(area.corner, glm::dvec2(0));
    EXPECT_EQ(area.size, glm::dvec2(1280, 720));
}

TEST(PanelLayout, TwiceTheScaleIsTwiceTheSize)
{
    ViewState state;
    for (const glm::ivec2& size : {glm::ivec2(1280, 720), {400, 300}}) {
        const PictureArea once = freeArea(state, size, 1), twice = freeArea(state, 2 * size, 2);
        EXPECT_EQ(twice.corner, 2.0 * once.corner);
        EXPECT_EQ(twice.size, 2.0 * once.size);
        EXPECT_EQ(centreOf(once, size), centreOf(twice, 2 * size));
    }
}

} // namespace
} // namespace palp
