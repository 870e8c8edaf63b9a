#pragma once
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/real_session.h"
#include "engine/session/recorded_session.h"
#include "engine/session/recording.h"
#include "engine/session/replay_device.h"
#include "engine/session/tick_ring.h"
#include "engine/tools/gui/input.h"
#include "engine/tools/gui/panels.h"
#include "engine/tools/gui/pointer_hand.h"
#include "engine/tools/gui/screen.h"
#include "engine/tools/gui/workbench_settings.h"

namespace palp {

class PanelFrame;

/// Everything between what happens in a window and the picture in it: camera, pointer, paint, session, panels. It knows
/// no window: run() is called with where input comes from. \thread the window's
class Workbench {
public:
    /// \param screen  outlives this
    Workbench(WorkbenchSettings settings, Screen& screen);
    ~Workbench();

    /// What happened since the last picture; may wait so long [s] for something to happen.
    using Poll = std::function<WindowInput(double patience)>;
    /// Opens, touches and shows until the window is closed. What takes long, such as reading a cloud, goes on on a
    /// thread of its own, and the window says so meanwhile.
    /// \param panels  outlives it; null: there are none
    /// \throws Error as WorkbenchSettings::open, Stage and WorkbenchSettings::hand do, before the first session
    WorkbenchReport run(const Poll& poll, PanelFrame* panels);

    /// Other values of the scene, from the next session on, which begins at once; the object stays if it can. What a
    /// scene does not take changes nothing and is complained of. Call it from `poll`, or as a panel does.
    void change(const SceneValues& values);

private:
    using Clock = std::chrono::steady_clock;
    struct Opened;

    // workbench_open.cpp
    void                                       openFirst();
    void                                       openOther(const std::string& what);
    void                                       takeValues(const SceneValues& wanted);
    [[nodiscard]] std::function<Opened()>      opener(const std::string& what, const SceneValues& values) const;
    void                                       adopt(const std::string& what, Opened opened);
    void                                       useObject();
    void                                       tellAssumptions();
    void                                       showNothing(const std::string& what);
    void                                       takeChanges();
    [[nodiscard]] Scene                        sceneWith(const SceneValues& values) const;
    [[nodiscard]] bool                         mayDiscard();
    [[nodiscard]] std::optional<WorkbenchHand> readyHand();
    template <class Work>
    auto meanwhile(const std::string& doing, Work work);

    // workbench.cpp
    void                             session();
    void                             ended(const SessionSummary& summary);
    void                             frame(const SessionView* view);
    void                             beginPanels();
    void                             rest();
    void                             drawFrame(const SessionView* view);
    void                             showTouch(const SessionView* view);
    void                             addBrush();
    [[nodiscard]] double             patience() const;
    [[nodiscard]] PanelContent       content(const SessionView* view) const;
    [[nodiscard]] bool               panelsShown() const { return panels_ && state_.panels && !state_.blind; }
    void                             writeTexts(const SessionView* view);
    void                             count(bool touching, double period);
    void                             perform(const PanelWishes& wishes);
    void                             aim();
    [[nodiscard]] PatchSolver        solver();
    [[nodiscard]] const Overlay*     textsFor(const PictureSize& size) const;
    void                             goOn();
    void                             restart() { stop_ = true; }
    void                             say(const std::string& message) { message_ = message; }
    [[nodiscard]] const std::string& saying() const { return doing_.empty() ? message_ : doing_; }
    void                             complain(const std::string& sentence);

    // workbench_input.cpp
    void                             handle(const WindowInput& input);
    void                             handleKey(const KeyPress& press);
    void                             handlePointer(const WindowInput& input);
    void                             touch(const WindowInput& input);
    void                             paintWith(const WindowInput& input);
    void                             undo();
    void                             redo();
    void                             moveByCap();
    void                             showKeys();
    void                             mark();
    void                             letGo();
    void                             open(const std::filesystem::path& path);
    void                             frameAll();
    void                             resetCamera();
    void                             lookAlong(const glm::dvec3& axis);
    [[nodiscard]] std::optional<Hit> hitAt(const WindowInput& input) const;

    // workbench_files.cpp
    void screenshot(bool withPanels);
    void toggleRecording();
    void startRecording();
    void endRecording();
    void savePaint();

    WorkbenchSettings              settings_;
    Screen&                        screen_;
    ViewState                      state_;
    SceneValues                    values_; ///< that panels have changed
    std::string                    what_;
    std::unique_ptr<Stage>         stage_;
    std::optional<PointerHand>     pointer_;
    std::optional<Hit>             beginAt_; ///< where the pointer's hand is to begin anew
    std::optional<RecordedSession> replayed_;
    std::unique_ptr<ReplayDevice>  replay_;

    Poll              poll_;
    PanelFrame*       panels_            = nullptr;
    bool              panelsDue_         = false; ///< a frame of ImGui has begun
    bool              panelsTakePointer_ = false, panelsTakeKeys_ = false, leftBefore_ = false; ///< as of the last one
    Clock::time_point panelsAt_{};
    WindowInput       input_;
    std::atomic<bool> stop_    = false; ///< the session ends, and the next one begins
    bool              closing_ = false;
    bool              begun_   = false;    ///< a session has: what goes wrong now is shown, and not thrown
    std::string       doing_;              ///< what goes on on another thread; empty: nothing, and one may paint
    Latest<std::string> handSays_;         ///< what the user is to do for it
    bool                failed_   = false; ///< no session can run until something changes
    bool                painting_ = false; ///< a stroke has begun
    glm::dvec3          lastDab_{};        ///< of it [m]
    bool                recordingWanted_ = false;
    bool                toFrame_         = true;   ///< once the size of the picture is known
    bool                letGo_           = false;  ///< until Space is pressed anew
    bool      paintSaved_ = true, warned_ = false; ///< the last stroke is on disk; the user knows that it is not
    ViewPaint paintBefore_ = ViewPaint::stiffness; ///< that the brush was taken
    Latest<std::string> unsolved_;                 ///< why the last patch was not; empty: it was
    SceneValues         wanted_;                   ///< for the next session
    std::string         toOpen_;                   ///< the same
    WorkbenchHand       hand_;                     ///< of the session that runs, or ran
    glm::ivec2          drawnSize_{};              ///< [px]
    double              capTime_ = 0;              ///< when the SpaceMouse was asked last [s]

    TickRing<TickRecord>       ring_{4096}; ///< from the servo: four seconds
    TouchHistory               history_;
    std::unique_ptr<Recording> recording_;
    std::string                recordFolder_, lastRecording_;
    double                     deepest_ = 0, strongest_ = 0; ///< ends of the scales of colours and arrows [m], [N]

    Overlay           texts_;
    std::string       textsOf_; ///< what they say
    Clock::time_point textsAt_{}, lastFrame_{}, lastBegin_{}, lastChange_{}, started_{};
    Clock::time_point markedAt_{};                                  ///< when a place was declared last
    double            frameTime_ = 0, drawTime_ = 0, fineTime_ = 0; ///< [s]
    bool              stillFine_ = false;                           ///< the picture is a fine one of what is there
    WorkbenchReport   report_;

    std::vector<std::string> faults_;
    std::string              message_;
};

} // namespace palp
