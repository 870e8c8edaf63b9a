#include "engine/tools/gui/picture_loop.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "tests/tools/gui/blank_screen.h"

namespace palp {
namespace {

/// A screen that shows nothing and takes no time.
class QuickScreen final : public BlankScreen {
public:
    bool show(const ViewScene&, const Camera&, const PictureSize&, const Overlay*) override { return true; }
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

} // namespace
} // namespace palp
