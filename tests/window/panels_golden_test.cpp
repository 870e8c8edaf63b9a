#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "engine/cloud/neighbour_index.h"
#include "engine/session/deformation.h"
#include "engine/session/hand_device.h"
#include "engine/session/virtual_session.h"
#include "engine/viewer/annotation.h"
#include "engine/viewer/surface_renderer.h"
#include "engine/window/panel_frame.h"
#include "engine/window/panels.h"
#include "tests/support/shader_fixture.h"

// Whole windows without a window, panels included, to the byte; see tests/viewer/golden_test.cpp for how they are made.

namespace palp {
namespace {

std::string bytesOf(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// A hand that has pressed a palm for a while, on the virtual clock.
struct Pressed {
    Scene          scene  = parseScene(R"({"cloud": "sample:palm", "points": 6000, "device": "host"})", "a test", ".");
    LoadedCloud    loaded = loadCloud(scene);
    NeighbourIndex index{loaded.cloud.positions()};
    Deformation    deformation{loaded.cloud, index, scene};
    HandPlace      place = handPlace(scene, loaded.cloud, index);
    HandPath       path{{{0, place.point + 2e-3 * place.outward},
                         {0.5, place.point - 1.5e-3 * place.outward},
                         {3, place.point - 1e-3 * place.outward}}};
    HandDevice     device{path};
    TouchHistory   history;
    std::optional<Patch> patch;
    TouchView            view{loaded.cloud, index, scene.patch};

    Pressed()
    {
        const PatchSolver solves = [this](const Touch& touch, double period) {
            DeformationAnswer answer = deformation.solve(touch, period);
            if (answer.patch) patch = answer.patch;
            return answer;
        };
        runVirtual({scene, loaded.cloud, index, solves, device, {}}, 2,
                   [this](const SessionSample& s) { history.add(s); });
    }

    [[nodiscard]] PanelContent content() const
    {
        PanelContent content{scene, loaded.cloud, history};
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

    void expectGolden(const std::string& name, const Image& image, SurfaceRenderer& renderer)
    {
        const std::filesystem::path folder = PALPATE_GOLDEN, file = folder / (name + ".png");
        const std::string           driver = renderer.device().name + ", " + renderer.device().driver + "\n";
        const std::string           bytes  = encodePng(image);
        for (const std::string& message : renderer.takeMessages()) ADD_FAILURE() << "validation: " << message;
        if (std::getenv("PALPATE_GOLDEN_WRITE")) {
            std::filesystem::create_directories(folder);
            std::ofstream(file, std::ios::binary) << bytes;
            std::ofstream(folder / "driver.txt") << driver;
        }
        if (bytesOf(folder / "driver.txt") != driver)
            GTEST_SKIP() << "drawn by " << bytesOf(folder / "driver.txt") << "and this is " << driver;
        if (bytesOf(file) != bytes) {
            const auto now = std::filesystem::temp_directory_path() / file.filename();
            std::ofstream(now, std::ios::binary) << bytes;
            FAIL() << file << " differs from " << now;
        }
    }
};

TEST_F(PanelsGoldenTest, AWindowWhileAHandPresses)
{
    constexpr PictureSize kSize{1280, 720, 1, Detail::fast};
    PanelFrame            frame;
    SurfaceRenderer       renderer({.device = deviceOfTests(), .validation = validation()});
    renderer.usePanels();
    Pressed   pressed;
    ViewState state;
    state.camera           = cameraAt(*pressed.patch, double(kSize.width) / kSize.height);
    state.look.paint       = ViewPaint::stiffness;
    const PanelContent now = pressed.content();
    pressed.view.show(now.patch, now.force, state.look);
    for (int n = 0; n < 3; ++n) { // panels settle their sizes in two frames
        frame.beginWithoutWindow({kSize.width, kSize.height});
        static_cast<void>(drawPanels(state, now, 1));
        frame.end();
    }
    const Overlay texts = annotations(pressed.view.scene(), state.camera, kSize.width, kSize.height);
    expectGolden("panels", renderer.draw(pressed.view.scene(), state.camera, kSize, &texts), renderer);
}

} // namespace
} // namespace palp
