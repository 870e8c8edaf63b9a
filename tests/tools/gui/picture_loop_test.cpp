#include "engine/tools/gui/picture_loop.h"

#include <chrono>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"
#include "tests/tools/gui/blank_screen.h"

namespace palp {
namespace {

/// A screen that shows nothing and takes no time.
class QuickScreen final : public BlankScreen {
public:
    bool  show(const ViewScene&, const Camera&, const PictureSize&, const Overlay*) override { return true; }
    Image draw(const ViewScene& scene, const Camera& camera, const PictureSize& size, const Overlay* texts) override
    {
        still = camera;
        rim   = scene.brush.size();
        return BlankScreen::draw(scene, camera, size, texts);
    }

    Camera      still;   ///< that saw the last one
    std::size_t rim = 0; ///< lines of the brush in it
};

TEST(PictureLoop, ARestIsNoTimeFromPictureToPicture)
{
    QuickScreen screen;
    PictureLoop loop(screen);
    const auto  picture = [&] {
        loop.begin({64, 48});
        loop.show({}, {}, nullptr, true);
    };
    picture();
    picture();
    EXPECT_EQ(loop.report().frameTimes.size(), 2U);
    const double before = loop.frameTime();

    loop.rest();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    picture();
    EXPECT_EQ(loop.frameTime(), before);
    EXPECT_EQ(loop.report().frameTimes.size(), 2U);
    EXPECT_EQ(loop.report().frames, 3U) << "it is shown all the same";
    picture();
    EXPECT_EQ(loop.report().frameTimes.size(), 3U);
}

TEST(PictureLoop, AStillHasItsTargetInTheMiddleAndNoBrush)
{
    const TemporaryFolder folder;
    const auto            before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path()); // where pictures go
    QuickScreen screen;
    PictureLoop loop(screen);
    loop.begin({64, 48});
    Camera camera;
    camera.centre = {0.3, -0.1}; // beside the panels
    ViewScene scene;
    scene.brush = {{{0, 0, 0}, {1, 0, 0}}};
    screen.rim  = 1;
    loop.saveStill(scene, camera, "a title");
    std::filesystem::current_path(before);

    EXPECT_EQ(screen.still.centre, glm::dvec2(0));
    EXPECT_EQ(screen.rim, 0U);
}

} // namespace
} // namespace palp
