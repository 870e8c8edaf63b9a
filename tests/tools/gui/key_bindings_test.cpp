#include "engine/tools/gui/key_bindings.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/tools/gui/controls.h"

// The one table of keys: what handles, explains and documents them.

namespace palp {
namespace {

/// The parts of a workbench with an object, but without pictures and sessions that run.
class KeyBindings : public ::testing::Test {
protected:
    KeyBindings()
    {
        const Scene scene = parseScene(R"({"cloud": "sample:sheet", "points": 300, "solver": "host"})", "a test", ".");
        object_.adopt({"sample:sheet", scene, std::make_unique<Stage>(scene)});
        session_.setStage(object_.stage());
    }
    void press(int key, bool control = false, bool shift = false) { handleKey({key, control, shift}, controls_); }

    class NoScreen final : public Screen {
    public:
        bool  show(const ViewScene&, const Camera&, const PictureSize&, const Overlay*) override { return false; }
        void  present() override {}
        void  takePanels() override {}
        Image draw(const ViewScene&, const Camera&, const PictureSize& size, const Overlay*) override
        {
            return Image(size.width, size.height, {});
        }
        [[nodiscard]] const compute::Processor& processor() const noexcept override { return processor_; }

    private:
        compute::Processor processor_{};
    };

    WorkbenchSettings settings_;
    NoScreen          screen_;
    ViewState         state_;
    Notices           notices_{{}};
    ObjectSource      object_{settings_};
    TouchSession      session_{settings_, notices_};
    PaintTool         paint_{notices_};
    CameraControl     camera_{state_.camera, nullptr};
    PictureLoop       pictures_{screen_};
    PictureTexts      texts_;
    Controls          controls_{{state_, notices_, object_, session_, paint_, camera_, pictures_, texts_}};
};

TEST_F(KeyBindings, NoKeyIsBoundTwice)
{
    std::set<std::pair<int, KeyModifier>> bound;
    for (const KeyBinding& binding : keyBindings()) {
        EXPECT_EQ(binding.key != 0, binding.act != nullptr) << binding.label;
        const bool isNew = binding.key == 0 || bound.insert({binding.key, binding.modifier}).second;
        EXPECT_TRUE(isNew) << binding.label;
    }
    EXPECT_TRUE(keyBindings().front().help) << "or else: no binding before it explains it";
}

TEST_F(KeyBindings, EveryKeyActsOrSaysWhyNot)
{
    for (const bool hidden : {false, true})
        for (const KeyBinding& binding : keyBindings()) {
            if (!binding.act || binding.modifier == KeyModifier::control || binding.key == 'P') continue;
            const bool applies =
                binding.scope == KeyScope::always || (binding.scope == KeyScope::somethingHidden) == hidden;
            state_.blind = hidden;
            notices_.say("");
            press(binding.key);
            const bool refused = notices_.message().find("hidden") != std::string::npos;
            EXPECT_EQ(refused, !applies) << binding.label;
        }
}

TEST_F(KeyBindings, WhileSomethingIsHiddenNoKeyTellsWhere)
{
    state_.blind      = true;
    state_.look.paint = ViewPaint::plain;
    for (const int key : {int('V'), int('J'), int('B')}) press(key);

    EXPECT_EQ(state_.look.paint, ViewPaint::plain);
    EXPECT_FALSE(state_.look.overlays.projected);
    EXPECT_EQ(state_.tool, Tool::touch);
    EXPECT_EQ(notices_.message(), "not while something is hidden: it would show where");
}

TEST_F(KeyBindings, ModifiersTellBindingsApart)
{
    press('S', true);
    EXPECT_EQ(notices_.message(), "nothing is painted; B takes the brush");
    EXPECT_FALSE(state_.look.overlays.sphere) << "S alone shows the sphere";
    press('S', false, true);
    EXPECT_TRUE(state_.look.overlays.sphere) << "Shift changes nothing where it has no binding of its own";
    press('V', true);
    EXPECT_EQ(state_.look.paint, ViewPaint::deflection) << "Ctrl+V is not bound";
}

TEST_F(KeyBindings, TheSheetExplainsWhatApplies)
{
    const auto has = [](bool hidden, const std::string& keys) {
        return std::ranges::any_of(keyLines(hidden), [&](const KeyLine& line) { return line.keys == keys; });
    };
    EXPECT_TRUE(has(false, "1  3  7"));
    EXPECT_TRUE(has(false, "Ctrl+Z  Ctrl+Y"));
    EXPECT_TRUE(has(false, "B"));
    EXPECT_FALSE(has(true, "B"));
    EXPECT_FALSE(has(false, "M"));
    EXPECT_TRUE(has(true, "M"));
    EXPECT_NE(keyLine(false).find("B brush"), std::string::npos);
    EXPECT_EQ(keyLine(true).find("B brush"), std::string::npos);
    EXPECT_NE(keyLine(true).find("M declare"), std::string::npos);
}

TEST_F(KeyBindings, WithoutPanelsTheKeysAreTold)
{
    press(kF1Key);
    EXPECT_EQ(notices_.message(), keyLine(false));
    press(kF1Key);
    EXPECT_EQ(notices_.message(), "");
    controls_.setPanels(true);
    press(kF1Key);
    EXPECT_EQ(notices_.message(), "") << "the sheet is there";
}

TEST_F(KeyBindings, TheReadmeHasTheWholeTable)
{
    std::ifstream     file(PALPATE_GUI_README);
    std::stringstream text;
    text << file.rdbuf();
    std::string wanted = "| key | does |\n|---|---|\n";
    for (const KeyLine& line : keyLines(false)) wanted += "| " + line.keys + " | " + line.help + " |\n";
    for (const KeyLine& line : keyLines(true))
        if (line.keys == "M") wanted += "| " + line.keys + ", in a hunt | " + line.help + " |\n";
    EXPECT_NE(text.str().find(wanted), std::string::npos) << "it should have this:\n" << wanted;
}

} // namespace
} // namespace palp
