#include "engine/tools/gui/controls.h"

#include <algorithm>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/tools/gui/key_bindings.h"

namespace palp {
namespace {

constexpr const char* kPainted = "its object is being painted";

} // namespace

void Controls::resetView()
{
    parts_.camera.resetView(parts_.object.stage().place());
}

void Controls::exaggerateMore()
{
    double& factor = parts_.state.look.exaggeration;
    factor         = factor >= 8 ? 1 : 2 * factor;
    say("displacement \u00d7 " + std::to_string(int(factor)));
}

void Controls::switchTool()
{
    ViewState& state  = parts_.state;
    const bool paints = state.tool == Tool::touch;
    state.tool        = paints ? Tool::paint : Tool::touch;
    if (paints) paintBefore_ = state.look.paint;
    state.look.paint = paints ? ViewPaint::stiffness : paintBefore_; // the paint is visible
    say(paints ? "brush: the left button paints, [ and ] change its size, Ctrl+Z undoes"
               : "hold Space and move: touch");
}

void Controls::resizeBrush(double factor)
{
    double& radius = parts_.state.brush.radius;
    radius         = std::clamp(radius * factor, BrushChoice::kSmallest, BrushChoice::kLargest);
    say("brush of " + formatQuantity(radius, "m"));
}

void Controls::undo()
{
    if (parts_.paint.undo(parts_.object.stage())) endRecording(kPainted);
}

void Controls::redo()
{
    if (parts_.paint.redo(parts_.object.stage())) endRecording(kPainted);
}

/// Releases the object, whichever hand is in use; never quits.
void Controls::letGo()
{
    parts_.state.keys = false;
    parts_.session.letGo();
}

void Controls::replayLast()
{
    const std::string& last = parts_.session.recorder().lastFolder();
    last.empty() ? say("nothing has been recorded yet: F5 starts a recording") : open(last);
}

void Controls::goOn()
{
    parts_.notices.clearFaults();
    parts_.paint.forgetWarning();
    parts_.session.resume();
    endRecording("the session begins anew");
    parts_.session.end();
}

void Controls::reset()
{
    resetView();
    if (parts_.session.forceIsStopped()) return goOn();
    parts_.notices.clearFaults(); // of something else, for which no session or recording ends
    parts_.paint.forgetWarning();
}

void Controls::savePicture(Shot shot)
{
    try {
        ViewScene&    scene  = parts_.object.stage().view().scene();
        const Camera& camera = parts_.state.camera;
        const auto*   texts  = parts_.state.texts ? parts_.texts.of(parts_.pictures.size()) : nullptr;
        say("saved " + (shot == Shot::window ? parts_.pictures.saveWindow(scene, camera, texts)
                                             : parts_.pictures.saveStill(scene, camera, parts_.object.stem())));
    } catch (const Error& error) {
        parts_.notices.complain(error.what());
    }
}

void Controls::toggleKeySheet()
{
    ViewState& state = parts_.state;
    state.keys       = !state.keys;
    if (state.blind || !panelsExist_) say(state.keys ? keyLine(state.blind) : "");
}

void Controls::open(const std::filesystem::path& what)
{
    if (parts_.state.blind) return say("nothing else is opened while something is hidden: the hunt would end");
    parts_.object.request(what);
    parts_.session.resume();
    parts_.session.end();
}

void Controls::change(const SceneValues& values)
{
    try { // a value that no scene takes ends no session; while the window is busy, another thread reads a scene
        if (!parts_.notices.busy())
            static_cast<void>(parts_.object.sceneWith(parts_.object.valuesWith(values)));
    } catch (const Error& error) {
        return parts_.notices.complain(error.what());
    }
    parts_.object.request(values);
    parts_.session.resume();
    parts_.session.end();
}

void Controls::perform(const PanelWishes& wishes)
{
    if (wishes.frame) frameObject();
    if (wishes.reset) resetView();
    if (wishes.screenshot) savePicture(Shot::still);
    if (wishes.record) toggleRecording();
    if (wishes.tool) switchTool();
    if (wishes.undo) undo();
    if (wishes.redo) redo();
    if (wishes.save) savePaint();
    if (wishes.resetFault) goOn();
    if (!wishes.open.empty()) open(wishes.open);
    if (!wishes.values.empty()) change(wishes.values);
}

void Controls::followPointer(const WindowInput& input)
{
    std::optional<Hit> hit;
    if (input.touch || input.doubleClick || parts_.state.tool == Tool::paint) // hitAt() looks at every point
        hit = parts_.object.stage().hitAt(parts_.state.camera, input.pointer, input.size);
    parts_.session.followPointer(input, hit, parts_.state.pressDepth);
    if (input.panelsTakePointer) return parts_.paint.endStroke(parts_.object.stage());
    paintWith(input, hit);
    parts_.camera.followPointer(input, parts_.state.tool == Tool::paint && !input.shift, hit);
}

void Controls::paintWith(const WindowInput& input, const std::optional<Hit>& hit)
{
    Stage&     stage  = parts_.object.stage();
    const bool paints = parts_.state.tool == Tool::paint && input.left && !input.shift && !parts_.notices.busy();
    if (!paints) return parts_.paint.endStroke(stage);
    if (!hit || (parts_.paint.inStroke() && input.moved == glm::dvec2(0))) return;
    try {
        parts_.paint.stroke(stage, parts_.state.brush, hit->point);
    } catch (const Error& error) { // too long a way for so small a brush
        parts_.paint.endStroke(stage);
        return parts_.notices.complain(error.what());
    }
    endRecording(kPainted);
}

/// Ends the recording, if there is one, with its session.
void Controls::endRecording(const std::string& because)
{
    if (!parts_.session.recorder().recording()) return;
    parts_.session.end();
    say("the recording has ended, because " + because);
}

} // namespace palp
