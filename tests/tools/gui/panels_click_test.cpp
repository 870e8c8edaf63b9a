#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "engine/tools/gui/panel_frame.h"
#include "engine/tools/gui/panels.h"
#include "tests/tools/gui/unseen_font.h"

// Real presses and drags on panels that nobody draws. Places are those of tests/tools/gui/golden/*.png, 1280 x 720.

namespace palp {
namespace {

constexpr glm::ivec2 kSize{1280, 720};

class PanelsClick : public ::testing::Test {
protected:
    PanelsClick()
    {
        makeUnseenFont();
        settle();
    }

    /// One frame with the pointer there; what it wished is added to the wishes.
    void frame(const glm::dvec2& at, bool down)
    {
        frame_.beginWithoutWindow(kSize, {at, down});
        PanelWishes now = drawPanels(state_, content_, 1);
        frame_.end();
        wishes_.values.merge(now.values);
        if (!now.open.empty()) wishes_.open = now.open;
        for (bool PanelWishes::*one :
             {&PanelWishes::frame, &PanelWishes::reset, &PanelWishes::screenshot, &PanelWishes::record,
              &PanelWishes::tool, &PanelWishes::undo, &PanelWishes::redo, &PanelWishes::save, &PanelWishes::resetFault})
            wishes_.*one |= now.*one;
    }
    /// One frame of a window of another size.
    void frameOf(const glm::ivec2& size)
    {
        frame_.beginWithoutWindow(size, {});
        static_cast<void>(drawPanels(state_, content_, 1));
        frame_.end();
    }
    void settle()
    {
        for (int n = 0; n < 3; ++n) frame({-1, -1}, false);
        wishes_ = {};
    }
    void click(const glm::dvec2& at)
    {
        for (const bool down : {false, true, false, false}) frame(at, down);
    }
    /// Presses at one place and lets go at another. \param between  looks on while the button is still down
    void drag(
        const glm::dvec2& from, const glm::dvec2& to, const std::function<void()>& between = [] {})
    {
        frame(from, false);
        frame(from, true);
        frame(0.5 * (from + to), true);
        frame(to, true);
        between();
        frame(to, false);
        frame(to, false);
    }
    void type(const char* text)
    {
        ImGui::GetIO().AddInputCharactersUTF8(text);
        frame({-1, -1}, false);
    }
    void pressEnter()
    {
        for (const bool down : {true, false}) {
#if IMGUI_VERSION_NUM < 18700
            ImGui::GetIO().KeyMap[ImGuiKey_Enter] = 1;
            ImGui::GetIO().KeysDown[1]            = down;
#else
            ImGui::GetIO().AddKeyEvent(ImGuiKey_Enter, down);
#endif
            frame({-1, -1}, false);
        }
    }
    /// Closes the two sections that are open at first, and opens the one of the scene below them.
    void openScene()
    {
        click({60, 39});
        click({60, 60});
        click({60, 123});
    }

    Scene        scene_  = parseScene(R"({"cloud": "sample:palm", "points": 500})", "a test", ".");
    LoadedCloud  loaded_ = loadCloud(scene_);
    TouchHistory history_;
    ViewState    state_;
    PanelContent content_{scene_, loaded_.cloud, history_};
    PanelWishes  wishes_;
    PanelFrame   frame_;
};

TEST_F(PanelsClick, WhileSomethingIsHiddenNoPanelIsThereToTell)
{
    const auto drawn = [this] {
        settle();
        return ImGui::GetDrawData()->TotalVtxCount;
    };
    EXPECT_GT(drawn(), 100);
    state_.blind = true;
    EXPECT_EQ(drawn(), 0) << "also those that were there before";
    state_.keys = true;
    EXPECT_EQ(drawn(), 0) << "the sheet has keys that do not work now";
}

TEST_F(PanelsClick, TheViewChangesAtOnce)
{
    click({205, 60});
    EXPECT_EQ(state_.look.paint, ViewPaint::stiffness);
    click({200, 81});
    EXPECT_EQ(state_.look.map, ColourMap::cividis);
    click({147, 124});
    EXPECT_TRUE(state_.look.overlays.ghost);
    click({16, 124});
    EXPECT_FALSE(state_.look.overlays.outline);
    click({16, 187});
    EXPECT_EQ(state_.look.ground, Ground::dark);
    click({147, 187});
    EXPECT_EQ(state_.camera.projection, Projection::orthographic);
    click({240, 229});
    EXPECT_TRUE(wishes_.tool) << "as the key B, which also shows what is painted";
    EXPECT_TRUE(wishes_.values.empty());
    EXPECT_FALSE(wishes_.frame || wishes_.reset || wishes_.screenshot || wishes_.record);
}

TEST_F(PanelsClick, AnObjectIsChosenFromTheList)
{
    content_.offered = {"sample:palm", "sample:skin", "/tmp/scan.ply"};
    settle();
    click({200, 60}); // where the colours are without a list
    click({200, 101});
    EXPECT_EQ(wishes_.open, "sample:skin");
    EXPECT_EQ(state_.look.paint, ViewPaint::deflection) << "the rows below have moved";
}

TEST_F(PanelsClick, ASliderGoesAsFarAsItIsDragged)
{
    drag({106, 103}, {196, 103});
    EXPECT_NEAR(state_.look.exaggeration, std::sqrt(20.0), 0.2) << "half way on a logarithmic scale, in pixels";
    drag({196, 103}, {700, 103});
    EXPECT_EQ(state_.look.exaggeration, 20);
    drag({200, 250}, {700, 250});
    EXPECT_NEAR(state_.pressDepth, 3 * scene_.material.thickness, 1e-9) << "so deep at most; rounding to mm";
}

TEST_F(PanelsClick, ButtonsAreWishes)
{
    click({32, 208});
    EXPECT_TRUE(wishes_.frame && !wishes_.reset);
    click({84, 208});
    EXPECT_TRUE(wishes_.reset && !wishes_.screenshot);
    click({152, 208});
    EXPECT_TRUE(wishes_.screenshot && !wishes_.record);
    click({224, 208});
    EXPECT_TRUE(wishes_.record);
}

TEST_F(PanelsClick, AValueOfTheSceneIsAWishOnceItsSliderIsLetGo)
{
    openScene();
    drag({239, 188}, {700, 188}, [this] { EXPECT_TRUE(wishes_.values.empty()) << "while it is dragged"; });

    ASSERT_EQ(wishes_.values.size(), 1U);
    EXPECT_EQ(wishes_.values.begin()->first, "thickness");
    EXPECT_EQ(wishes_.values.begin()->second, "20 mm");
}

TEST_F(PanelsClick, ASliderThatComesBackToItsValueWishesNothing)
{
    openScene();
    const glm::dvec2 value{273, 209}, elsewhere{150, 209};
    frame(value, false);
    for (const glm::dvec2& at : {value, elsewhere, value}) frame(at, true);
    frame(value, false);
    frame(value, false);

    EXPECT_TRUE(wishes_.values.empty()) << wishes_.values.begin()->second;
}

TEST_F(PanelsClick, AnotherMapIsAWish)
{
    openScene();
    click({200, 340});
    click({200, 401}); // the third of the list below

    ASSERT_TRUE(wishes_.values.contains("map"));
    EXPECT_EQ(wishes_.values.at("map"), "gall-peters");
}

TEST_F(PanelsClick, AnotherEdgeOfOneSideIsAWish)
{
    openScene();
    click({250, 424});
    click({250, 464}); // the second of the list below

    ASSERT_TRUE(wishes_.values.contains("edges"));
    EXPECT_EQ(wishes_.values.at("edges"), "x0=clamped,x1=supported,z0=clamped,z1=clamped");
}

TEST_F(PanelsClick, ALawToStartFromIsAWish)
{
    openScene();
    click({104, 165});

    ASSERT_TRUE(wishes_.values.contains("stiffness"));
    EXPECT_TRUE(wishes_.values.at("stiffness").starts_with("linear:from=")) << wishes_.values.at("stiffness");
}

TEST_F(PanelsClick, ALawThatIsTypedIsAWishOnceEnterIsPressed)
{
    openScene();
    click({200, 145});
    type("constant:value=3e5");
    EXPECT_TRUE(wishes_.values.empty());
    pressEnter();

    ASSERT_TRUE(wishes_.values.contains("stiffness"));
    EXPECT_EQ(wishes_.values.at("stiffness"), "constant:value=3e5");
}

TEST_F(PanelsClick, ALawIsLeftByItsButtonOrByTypingNothing)
{
    openScene();
    click({278, 145});
    EXPECT_TRUE(wishes_.values.empty()) << "there is no law to be left";
    scene_.stiffness = "constant:value=3e5";
    settle();
    click({278, 145});

    ASSERT_TRUE(wishes_.values.contains("stiffness"));
    EXPECT_EQ(wishes_.values.at("stiffness"), "own");
}

/// Corners of all that is drawn: left, top, right, foot [px].
std::array<float, 4> extentOfWhatIsDrawn()
{
    std::array<float, 4>    extent{1e9F, 1e9F, -1e9F, -1e9F};
    const ImDrawData* const data = ImGui::GetDrawData();
    for (int n = 0; n < data->CmdListsCount; ++n)
        for (const ImDrawVert& corner : data->CmdLists[n]->VtxBuffer) {
            extent[0] = std::min(extent[0], corner.pos.x);
            extent[1] = std::min(extent[1], corner.pos.y);
            if (corner.pos.y > 30 * ImGui::GetFontSize() / 15)
                extent[2] = std::max(extent[2], corner.pos.x); // the column's
            extent[3] = std::max(extent[3], corner.pos.y);
        }
    return extent;
}

TEST_F(PanelsClick, OnADisplayOfTwiceTheScalePanelsAreTwiceAsLargeAndBackAsBefore)
{
    std::array<std::array<float, 4>, 3> extents;
    for (std::size_t k = 0; k < 3; ++k) {
        const int scale = k == 1 ? 2 : 1;
        frame_.setScale(scale);
        makeUnseenFont();
        for (int n = 0; n < 3; ++n) {
            frame_.beginWithoutWindow(scale * kSize, {});
            EXPECT_EQ(ImGui::GetFontSize(), 15.0F * float(scale));
            static_cast<void>(drawPanels(state_, content_, scale));
            frame_.end();
        }
        extents[k] = extentOfWhatIsDrawn();
    }
    EXPECT_EQ(extents[2], extents[0]);
    for (std::size_t side = 0; side < 4; ++side)
        EXPECT_NEAR(extents[1][side], 2 * extents[0][side], 12) << "a dozen lines, each rounded to a pixel";
    EXPECT_GT(extents[0][3], 300);
    EXPECT_NEAR(extents[0][2], 300, 1) << "the column";
}

TEST_F(PanelsClick, AFaultIsLeftByItsButton)
{
    TickRecord record;
    record.faults = static_cast<std::uint32_t>(GovernorFault::tooFast);
    history_.add(record);
    settle();
    click({48, 347});

    EXPECT_TRUE(wishes_.resetFault);
}

TEST_F(PanelsClick, AComplaintIsLeftByTheSameButton)
{
    content_.faults = {"a fault"};
    settle();
    click({48, 309});

    EXPECT_TRUE(wishes_.resetFault);
}

TEST_F(PanelsClick, ABrushHasItsSectionWhileItIsTheTool)
{
    state_.tool      = Tool::paint;
    content_.painted = content_.canUndo = true;
    settle();
    click({208, 60});
    EXPECT_TRUE(state_.brush.smooths);
    click({29, 145});
    EXPECT_TRUE(wishes_.undo);
    click({160, 145});
    EXPECT_FALSE(wishes_.redo) << "there is nothing to do again";
    click({50, 166});
    EXPECT_TRUE(wishes_.save);
}

TEST_F(PanelsClick, TheSheetOfKeysCloses)
{
    state_.keys = true;
    settle();
    click({950, 157});

    EXPECT_FALSE(state_.keys);
}

TEST_F(PanelsClick, TheSheetOfKeysFitsIntoANarrowWindowAndScrollsInALowOne)
{
    state_.keys = true;
    for (const glm::ivec2& size : {kSize, glm::ivec2(640, 720), glm::ivec2(400, 320)}) {
        for (int n = 0; n < 3; ++n) frameOf(size);
        const ImGuiWindow* const sheet = ImGui::FindWindowByName("Keys");
        ASSERT_TRUE(sheet);
        EXPECT_LE(sheet->ContentSize.x, sheet->InnerRect.GetWidth()) << size.x << ": nothing is cut";
        EXPECT_TRUE(sheet->ContentSize.y <= sheet->InnerRect.GetHeight() || sheet->ScrollbarY) << size.y;
    }
}

TEST_F(PanelsClick, SectionsThatASmallWindowClosedComeBackWhenItGrows)
{
    const auto height = [this](const glm::ivec2& size) {
        for (int n = 0; n < 3; ++n) frameOf(size);
        return ImGui::FindWindowByName("panels")->Size.y;
    };
    constexpr glm::ivec2 kSmall(480, 360);
    const float          first = height(kSize);
    EXPECT_LT(height(kSmall), first / 3);
    EXPECT_EQ(height(kSize), first);
    click({60, 39}); // the view
    const float less = height(kSize);
    EXPECT_LT(less, first);
    static_cast<void>(height(kSmall));
    EXPECT_EQ(height(kSize), less) << "what the user has closed stays closed";
    state_.tool          = Tool::paint;
    const float painting = height(kSize);
    EXPECT_GT(painting, less + 50) << "its heading alone takes 21";
    static_cast<void>(height(kSmall));
    EXPECT_EQ(height(kSize), painting) << "the section of the brush, too";
}

TEST_F(PanelsClick, AWindowThatIsSmallAtFirstOpensItsSectionsWhenItGrows)
{
    const float first = ImGui::FindWindowByName("panels")->Size.y;
    ImGui::FindWindowByName("panels")->StateStorage.Clear(); // as if nothing had been drawn yet
    for (int n = 0; n < 3; ++n) frameOf({480, 360});
    settle();

    EXPECT_EQ(ImGui::FindWindowByName("panels")->Size.y, first);
}

TEST_F(PanelsClick, ASmallWindowKeepsItsMiddleFree)
{
    for (int n = 0; n < 3; ++n) frameOf({480, 360});
    frame_.beginWithoutWindow({480, 360}, {{240, 200}, false});
    EXPECT_FALSE(ImGui::GetIO().WantCaptureMouse) << "all sections are closed";
    static_cast<void>(drawPanels(state_, content_, 1));
    frame_.end();
    frame_.beginWithoutWindow({480, 360}, {{100, 60}, false});
    EXPECT_TRUE(ImGui::GetIO().WantCaptureMouse);
    static_cast<void>(drawPanels(state_, content_, 1));
    frame_.end();
}

TEST_F(PanelsClick, NothingIsThereWithoutPanelsButAFault)
{
    state_.panels = false;
    settle();
    frame_.beginWithoutWindow(kSize, {{60, 10}, false});
    EXPECT_FALSE(ImGui::GetIO().WantCaptureMouse);
    frame_.end();
    const auto lineTakesPointer = [this] {
        settle();
        frame({60, 10}, false);
        frame_.beginWithoutWindow(kSize, {{60, 10}, false});
        const bool takes = ImGui::GetIO().WantCaptureMouse;
        frame_.end();
        return takes;
    };
    content_.faults = {"a fault"};
    EXPECT_FALSE(lineTakesPointer()) << "the picture's note says so, and nothing covers it";
    state_.texts = false;
    EXPECT_TRUE(lineTakesPointer()) << "the line that says so";
    state_.panels = state_.blind = true;
    EXPECT_TRUE(lineTakesPointer()) << "in a hunt too";
}

} // namespace
} // namespace palp
