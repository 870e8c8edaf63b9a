
#include <gtest/gtest.h>

#include "engine/session/deformation.h"
#include "engine/session/scripted_hand.h"
#include "engine/session/virtual_session.h"
#include "engine/tools/gui/panel_frame.h"
#include "engine/tools/gui/panels.h"
#include "engine/tools/render/annotation.h"
#include "engine/tools/render/surface_renderer.h"
#include "tests/support/golden_picture.h"
#include "tests/support/shader_fixture.h"

// Whole windows without a window, panels included, compared as tests/support/golden_picture.h says.

namespace palp {
namespace {

/// A hand that has pressed a palm for a while, on the virtual clock.
struct Pressed {
    Scene        scene  = parseScene(R"({"cloud": "sample:palm", "points": 6000, "solver": "host"})", "a test", ".");
    SoftObject   object = loadObject(scene).object;
    Deformation  deformation{object, scene};
    HandPlace    place = handPlace(scene, object);
    HandPath     path{{{0, place.point + 2e-3 * place.outward},
                       {0.5, place.point - 1.5e-3 * place.outward},
                       {3, place.point - 1e-3 * place.outward}}};
    ScriptedHand device{path};
    TouchHistory history;
    std::optional<Patch> patch;
    TouchView            view{object, scene.patch};

    Pressed()
    {
        const PatchSolver solves = [this](const Touch& touch, double period) {
            DeformationAnswer answer = deformation.solve(touch, period);
            if (answer.patch) patch = answer.patch;
            return answer;
        };
        runVirtual({scene, object, solves, device, {}}, 2, [this](const TickRecord& s) { history.add(s); });
    }

    [[nodiscard]] PanelContent content() const
    {
        PanelContent content{scene, object.cloud(), history};
        content.patch           = patch ? &*patch : nullptr;
        content.force           = glm::length(history.newest().force);
        content.loopPeriod      = 1.02e-3;
        content.solveTime       = 4.1e-3;
        content.frameTime       = 28e-3;
        content.hand            = "mouse";
        content.solvedOn        = "host (AVX2)";
        content.drawnOn         = "llvmpipe (LLVM 15.0.6, 256 bits)";
        content.drawnInSoftware = true;
        content.touching        = true;
        content.title           = "sample:palm";
        return content;
    }
};

class PanelsGoldenTest : public ShaderTest {
protected:
    void SetUp() override
    {
        if (onHost()) GTEST_SKIP() << "the host does not draw";
        ShaderTest::SetUp();
    }
};

/// What a picture of the window shows.
struct Shown {
    PictureSize size{1280, 720, 1, Detail::fast};
    double      scale = 1;
    ViewState   state{};
    glm::dvec2  pointer{-1, -1}; ///< [px]
    int         kept = 1280;     ///< of its width, from the left [px]
};

/// The left part of a picture.
Image leftOf(const Image& image, int width)
{
    Image column(width, image.height, {});
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < width; ++x) column.at(x, y) = image.at(x, y);
    return column;
}

class PanelsGolden : public PanelsGoldenTest {
protected:
    Image pictureOf(Shown shown, const PanelContent& now, SurfaceRenderer& renderer, PanelFrame& frame)
    {
        const PictureSize& size = shown.size;
        shown.state.camera      = cameraAt(*pressed_.patch, double(size.width) / size.height);
        frame.setDark(shown.state.look.ground == Ground::dark);
        pressed_.view.show(now.patch, now.force, shown.state.look);
        for (int n = 0; n < 3; ++n) { // panels settle their sizes in two frames
            frame.beginWithoutWindow({size.width, size.height}, {shown.pointer, false});
            static_cast<void>(drawPanels(shown.state, now, shown.scale));
            frame.end();
        }
        renderer.takePanels();
        const Overlay texts = annotations(pressed_.view.scene(), shown.state.camera, size.width, size.height);
        return renderer.draw(pressed_.view.scene(), shown.state.camera, size, &texts);
    }

    /// Presses and lets go of the pointer.
    static void click(const glm::dvec2& at, Shown& shown, const PanelContent& now, PanelFrame& frame)
    {
        for (const bool down : {false, true, false}) { // ImGui counts a press where the pointer already was
            frame.beginWithoutWindow({shown.size.width, shown.size.height}, {at, down});
            static_cast<void>(drawPanels(shown.state, now, shown.scale));
            frame.end();
        }
    }

    void expectGolden(const std::string& name, const Shown& shown, const PanelContent& now)
    {
        PanelFrame      frame(shown.scale);
        SurfaceRenderer renderer({.processor = processorOfTests(), .validation = validation()});
        const Image     image = pictureOf(shown, now, renderer, frame);
        palp::expectGolden(PALPATE_GOLDEN, name + ".png", leftOf(image, shown.kept), renderer);
    }

    Pressed pressed_;
};

TEST_F(PanelsGolden, AWindowWhileAHandPresses)
{
    Shown shown;
    shown.state.look.paint = ViewPaint::stiffness;

    expectGolden("panels", shown, pressed_.content());
}

/// Begun at scale 1, as a window that is moved from one display to another.
TEST_F(PanelsGolden, DarkAndLargeAtTwiceTheScale)
{
    Shown shown{{1920, 1080, 1, Detail::fast}, 2};
    shown.state.look.ground = Ground::dark;
    shown.state.look.map    = ColourMap::cividis;
    shown.kept              = 960;
    PanelContent now        = pressed_.content();
    now.recording           = "recordings/2016-05-20";

    PanelFrame      frame;
    SurfaceRenderer renderer({.processor = processorOfTests(), .validation = validation()});
    Shown           before = shown;
    before.size            = {960, 540, 1, Detail::fast};
    before.scale           = 1;
    static_cast<void>(pictureOf(before, now, renderer, frame));
    frame.setScale(shown.scale);
    const Image image = pictureOf(shown, now, renderer, frame);

    palp::expectGolden(PALPATE_GOLDEN, "panels-dark.png", leftOf(image, shown.kept), renderer);
}

TEST_F(PanelsGolden, TheOtherSectionsOpenAtAClick)
{
    constexpr int    kColumn = 300;                                                     // [px]
    constexpr double kView = 39, kTouch = 60, kChart = 81, kTiming = 102, kScene = 123; // headers while all are closed
    Shown            shown;
    PanelContent     now   = pressed_.content();
    Patch            mixed = *pressed_.patch; // bent as it was: this is how sides are drawn
    mixed.plate.edges      = {Edge::clamped, Edge::free, Edge::supported, Edge::clamped};
    now.patch              = &mixed;
    PanelFrame      frame;
    SurfaceRenderer renderer({.processor = processorOfTests(), .validation = validation()});
    const auto      at = [&](double y) { click({60, y}, shown, now, frame); };

    static_cast<void>(pictureOf(shown, now, renderer, frame));
    at(kView);
    at(kTouch);
    at(kTiming);
    at(kChart);
    shown.pointer     = {100, 150};
    const Image chart = pictureOf(shown, now, renderer, frame);
    shown.pointer     = {25, 574};
    at(kChart);
    at(kTiming);
    at(kScene);
    const Image scene = pictureOf(shown, now, renderer, frame);

    palp::expectGolden(PALPATE_GOLDEN, "panels-chart.png", leftOf(chart, kColumn), renderer);
    palp::expectGolden(PALPATE_GOLDEN, "panels-scene.png", leftOf(scene, kColumn + 100), renderer);
}

TEST_F(PanelsGolden, ABrushAndTheSheetOfKeys)
{
    Shown shown;
    shown.kept             = 980;
    shown.state.tool       = Tool::paint;
    shown.state.keys       = true;
    shown.state.look.paint = ViewPaint::stiffness;
    PanelContent now       = pressed_.content();
    now.painted = now.canUndo = true;
    now.message               = "saved as palm.ply";

    expectGolden("panels-paint", shown, now);
}

TEST_F(PanelsGolden, NothingFeltYetAndAFault)
{
    Shown      shown;
    TickRecord record;
    shown.kept    = 460;
    record.time   = 1;
    record.faults = static_cast<std::uint32_t>(GovernorFault::tooFast);
    pressed_.history.clear();
    pressed_.history.add(record);
    PanelContent now = pressed_.content();
    now.patch        = nullptr;
    now.force = now.solveTime = now.loopPeriod = 0;
    now.faults = {"The cloud ends within the window: the patch is free there. Take a smaller window."};

    expectGolden("panels-fault", shown, now);
}

} // namespace
} // namespace palp
