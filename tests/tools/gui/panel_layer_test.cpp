#include "engine/tools/gui/panel_layer.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include "tests/tools/gui/blank_screen.h"
#include "tests/tools/gui/unseen_font.h"

// Who takes the pointer, the panels or the object, from picture to picture.

namespace palp {
namespace {

constexpr glm::dvec2 kOnAPanel{100, 60}, kOnTheObject{800, 400}; ///< in a window of 1280 x 720

/// A screen that nobody looks at.
class UnseenScreen final : public BlankScreen {
public:
    bool show(const ViewScene&, const Camera&, const PictureSize&, const Overlay*) override { return true; }
};

class PanelLayerTest : public ::testing::Test {
protected:
    PanelLayerTest()
    {
        makeUnseenFont();
        input_.size = {1280, 720};
        for (int n = 0; n < 3; ++n) { // panels settle their sizes
            input_.keys = {{'F', false, false}};
            look(kOnTheObject, false);
        }
        input_.keys = {};
    }

    /// One picture with the pointer there.
    /// \return whether the panels were due
    bool look(const glm::dvec2& at, bool down)
    {
        input_.moved       = at - input_.pointer;
        input_.pointer     = at;
        input_.leftPressed = down && !input_.left;
        input_.left        = down;
        const auto given   = layer_.begin(input_, false, false);
        taken_             = given.panelsTakePointer;
        const bool due     = layer_.due();
        static_cast<void>(layer_.draw(state_, content_, 1, screen_));
        return due;
    }

    Scene        scene_  = parseScene(R"({"cloud": "sample:palm", "points": 500})", "a test", ".");
    LoadedCloud  loaded_ = loadCloud(scene_);
    TouchHistory history_;
    ViewState    state_;
    PanelContent content_{scene_, loaded_.cloud, history_};
    UnseenScreen screen_;
    PanelFrame   frame_;
    PanelLayer   layer_{&frame_};
    WindowInput  input_;
    bool         taken_ = false; ///< the pointer, by the panels
};

TEST_F(PanelLayerTest, APressThatComesWithItsMotionGoesWhereItIs)
{
    ASSERT_FALSE(taken_);
    look(kOnAPanel, true);
    EXPECT_TRUE(taken_) << "a press on a panel";
    look(kOnAPanel, false);
    EXPECT_TRUE(taken_);
    look(kOnTheObject, true);
    EXPECT_FALSE(taken_) << "a press on the object";
    EXPECT_FALSE(look(kOnTheObject + 5.0, true)) << "what orbits waits for no panels";
    EXPECT_FALSE(taken_);
}

TEST_F(PanelLayerTest, EveryNotchOfTheWheelOverAPanelIsGivenToIt)
{
    look(kOnAPanel, false);
    input_.wheel = -1;
    for (int notch = 0; notch < 5; ++notch) EXPECT_TRUE(look(kOnAPanel, false)) << notch;
    input_.wheel = 0;
    EXPECT_FALSE(look(kOnAPanel, false)) << "at rest they are drawn seldom";
    look(kOnTheObject, false);
    input_.wheel = -1;
    EXPECT_FALSE(look(kOnTheObject, false)) << "the object zooms without them";
}

} // namespace
} // namespace palp
