#include "engine/tools/gui/key_bindings.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "engine/tools/gui/controls.h"
#include "tests/tools/gui/blank_screen.h"

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

    class NoScreen final : public BlankScreen {
    public:
        bool show(const ViewScene&, const Camera&, const PictureSize&, const Overlay*) override { return false; }
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
    EXPECT_EQ(notices_.message(), "not while something is hidden: it would show where, or end the hunt");
}

TEST_F(KeyBindings, WhileSomethingIsHiddenNothingElseIsOpened)
{
    state_.blind = true;
    press(kF6Key);
    EXPECT_EQ(notices_.message(), "not while something is hidden: it would show where, or end the hunt");
    controls_.open("sample:palm");
    EXPECT_EQ(object_.takeRequestedObject(), "");
    EXPECT_EQ(notices_.message(), "nothing else is opened while something is hidden: the hunt would end");
}

TEST_F(KeyBindings, AKeyThatIsHeldRepeatsOnlyWhatIsDoneBySteps)
{
    const auto hold = [this](int key, bool control) { handleKey({key, control, false, true}, controls_); };
    hold('S', false);
    EXPECT_FALSE(state_.look.overlays.sphere);
    hold(kF1Key, false);
    EXPECT_FALSE(state_.keys);
    const double before = state_.brush.radius;
    hold(']', false);
    EXPECT_GT(state_.brush.radius, before);
    for (const KeyBinding& binding : keyBindings())
        EXPECT_EQ(binding.repeats, binding.key == '[' || binding.key == ']' || binding.key == 'Z' || binding.key == 'Y')
            << binding.label;
}

TEST_F(KeyBindings, TheBrushStaysWithinTheLimitsOfItsSlider)
{
    for (int n = 0; n < 100; ++n) press('[');
    EXPECT_EQ(state_.brush.radius, BrushChoice::kSmallest);
    for (int n = 0; n < 100; ++n) press(']');
    EXPECT_EQ(state_.brush.radius, BrushChoice::kLargest);
}

TEST_F(KeyBindings, TooLongAWayForASmallBrushIsAComplaintAndEndsTheStroke)
{
    state_.tool         = Tool::paint;
    state_.brush.radius = 1e-9; // a stroke over the sheet has more dabs than are painted at once
    WindowInput input;
    input.size = {640, 480};
    input.left = true;
    controls_.frameObject();
    for (const glm::dvec2 at : {glm::dvec2(300, 240), glm::dvec2(340, 240)}) {
        input.moved   = at - input.pointer;
        input.pointer = at;
        controls_.followPointer(input);
    }
    ASSERT_EQ(notices_.faults().size(), 1U);
    EXPECT_NE(notices_.faults()[0].find("take a larger radius"), std::string::npos) << notices_.faults()[0];
    EXPECT_FALSE(paint_.inStroke());
}

TEST_F(KeyBindings, WhereNothingCanBeRedoneNothingIsUnsaved)
{
    for (const int key : {int('Z'), int('Y')}) press(key, true);
    EXPECT_FALSE(paint_.undo(object_.stage()));
    press('S', true);
    EXPECT_EQ(notices_.message(), "nothing is painted; B takes the brush");
}

TEST_F(KeyBindings, NothingIsDeclaredWhileTheForceIsOff)
{
    state_.blind = true;
    session_.halt();
    press('M');
    EXPECT_EQ(notices_.message(), "nothing is declared, because the force is off: R goes on");
    press('R');
    press('M');
    EXPECT_EQ(notices_.message(), "nothing is touched: hold Space over the place");
}

TEST_F(KeyBindings, RClearsWhatIsShownAsAFault)
{
    notices_.complain("a file cannot be read");
    press('R');
    EXPECT_TRUE(notices_.faults().empty());
}

TEST_F(KeyBindings, ThePanelsButtonIsTheBrushesKey)
{
    state_.look.paint = ViewPaint::deflection;
    PanelWishes wishes;
    wishes.tool = true;
    controls_.perform(wishes);
    EXPECT_EQ(state_.tool, Tool::paint);
    EXPECT_EQ(state_.look.paint, ViewPaint::stiffness) << "the paint is visible";
    controls_.perform(wishes);
    EXPECT_EQ(state_.look.paint, ViewPaint::deflection);
}

TEST(KeyNumber, LettersAreWhereTheLayoutHasThem)
{
    EXPECT_EQ(keyNumber('Y', "z"), 'Z') << "German: Ctrl+Z undoes";
    EXPECT_EQ(keyNumber('Z', "y"), 'Y');
    EXPECT_EQ(keyNumber(';', "m"), 'M') << "French";
    EXPECT_EQ(keyNumber('M', ","), ',') << "and where M is in the US declares nothing";
    EXPECT_EQ(keyNumber('7', "\u00e8"), '7') << "digits stay";
    EXPECT_EQ(keyNumber('1', "&"), '1');
    EXPECT_EQ(keyNumber('[', "\u00fc"), '[') << "a key that writes neither of ours";
    EXPECT_EQ(keyNumber(']', "+"), ']');
    EXPECT_EQ(keyNumber('-', "["), '[');
    EXPECT_EQ(keyNumber('Z', "\u044f"), 'Z') << "Russian";
    EXPECT_EQ(keyNumber(0, "1"), 0) << "a key of the number pad";
    EXPECT_EQ(keyNumber('Z', ""), 'Z');
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
