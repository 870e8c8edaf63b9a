#pragma once
#include "engine/tools/gui/camera_control.h"
#include "engine/tools/gui/object_source.h"
#include "engine/tools/gui/paint_tool.h"
#include "engine/tools/gui/panels.h"
#include "engine/tools/gui/picture_loop.h"
#include "engine/tools/gui/touch_session.h"

namespace palp {

/// The parts of a workbench. They outlive the Controls that act on them.
struct WorkbenchParts {
    ViewState&     state;
    Notices&       notices;
    ObjectSource&  object;
    TouchSession&  session;
    PaintTool&     paint;
    CameraControl& camera;
    PictureLoop&   pictures;
    PictureTexts&  texts;
};

/// Does what a user asks for by a key, in a panel or with the pointer. Invariant: nothing that takes long happens
/// here; it is requested, and the session ends for it.
/// \thread the window's
class Controls {
public:
    explicit Controls(const WorkbenchParts& parts) : parts_(parts) {}

    [[nodiscard]] ViewState& state() { return parts_.state; }

    void frameObject() { parts_.camera.frameObject(); }
    void resetView();
    void lookFrom(const glm::dvec3& toEye) { parts_.camera.lookFrom(toEye); }
    void exaggerateMore();

    void switchTool();
    void resizeBrush(double factor);
    void undo();
    void redo();
    void savePaint() { parts_.paint.save(parts_.object.stage()); }

    void letGo();
    void declare() { parts_.session.declare(); }
    void toggleClutch() { parts_.session.toggleClutch(); }
    void toggleRecording() { parts_.session.toggleRecording(); }
    void replayLast();
    void mark() { parts_.session.mark(); }
    /// Takes the object again after a fault or letting go.
    void goOn();
    /// Resets the view, and goes on if a fault or letting go has stopped the forces, or a fault is shown.
    void reset();

    enum class Shot { still, window };
    void savePicture(Shot shot);
    /// Shows or hides the sheet of keys; without panels, shows the keys in a line.
    void toggleKeySheet();
    void setPanels(bool exist) { panelsExist_ = exist; }

    void open(const std::filesystem::path& what);
    void change(const SceneValues& values);
    void perform(const PanelWishes& wishes);

    /// Moves camera and hand, and paints.
    void followPointer(const WindowInput& input);

    void say(const std::string& message) { parts_.notices.say(message); }

private:
    void paintWith(const WindowInput& input, const std::optional<Hit>& hit);
    void endRecording(const std::string& because);

    WorkbenchParts parts_;
    ViewPaint      paintBefore_ = ViewPaint::stiffness; ///< colours shown before the brush was taken
    bool           panelsExist_ = false;
};

} // namespace palp
