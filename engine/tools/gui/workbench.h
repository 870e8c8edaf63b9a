#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "engine/tools/gui/controls.h"
#include "engine/tools/gui/input.h"
#include "engine/tools/gui/panel_layer.h"
#include "engine/tools/gui/workbench_settings.h"

namespace palp {

/// Joins the input of a window, the touch, and the picture in the window. It knows no window: run() takes the source of
/// its input. Invariant: whatever ends a session or the window, the last force is zero, and no paint is lost.
/// \thread the window's
class Workbench {
public:
    /// \param screen  outlives this
    Workbench(WorkbenchSettings settings, Screen& screen);

    /// Returns what happened since the last picture; may wait for something to happen for at most `patience` [s].
    using Poll = std::function<WindowInput(double patience)>;
    /// Opens, touches and shows until the window is closed. Work that takes long, such as reading a cloud, is done on
    /// another thread, and the window says so meanwhile.
    /// \param panels  outlives the call; null: there are none
    /// \throws Error as WorkbenchSettings::open, Stage and WorkbenchSettings::hand do, before the first session
    WorkbenchReport run(const Poll& poll, PanelFrame* panels);

    /// Sets values of the scene from the next session on, which begins at once; the object stays if it can. Values
    /// that a scene refuses change nothing and show a fault. Must be called from `poll`, or as a panel does.
    void change(const SceneValues& values) { controls_.change(values); }

    /// Marks the newest tick in a recording and in streams with a text from anywhere.
    /// \thread any
    void mark(std::string_view text) { session_.mark(text); }
    /// Counts markers as lost that were sent and did not come.
    /// \thread any
    void loseMarkers(std::uint64_t markers) { session_.loseMarkers(markers); }

private:
    // Between two sessions.
    void                                       openFirst();
    void                                       takeRequests();
    void                                       openOther(const std::string& what);
    void                                       takeValues(const SceneValues& wanted);
    void                                       adopt(OpenedObject opened);
    void                                       useObject();
    void                                       fixScales();
    void                                       tellAssumptions();
    void                                       touch();
    bool                                       keepPaint();
    [[nodiscard]] std::optional<WorkbenchHand> readyHand();
    template <class Work>
    auto meanwhile(const std::string& activity, Work work);

    // One picture.
    void                       frame(const SessionView* view);
    void                       handle();
    void                       settleCamera();
    void                       draw(const SessionView* view);
    void                       drawWords();
    void                       showTouch(const SessionView* view);
    void                       writeTexts(const SessionView* view);
    [[nodiscard]] std::string  note(const SessionView* view) const;
    [[nodiscard]] PanelContent content(const SessionView* view) const;

    const WorkbenchSettings               settings_;
    Screen&                               screen_;
    ViewState                             state_;
    Notices                               notices_;
    ObjectSource                          object_;
    TouchSession                          session_;
    PaintTool                             paint_;
    CameraControl                         camera_;
    PictureLoop                           pictures_;
    PictureTexts                          texts_;
    Controls                              controls_;
    PanelLayer                            panels_{nullptr};
    Latest<std::string>                   handAdvice_; ///< what the user is to do for a hand that gets ready
    std::vector<std::string>              offered_;    ///< objects in the panels
    Poll                                  poll_;
    WindowInput                           input_;
    bool                                  closing_ = false;
    std::chrono::steady_clock::time_point started_;
    std::uint64_t                         noticesDrawn_ = 0; ///< number of their changes
};

} // namespace palp
