#pragma once
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/hid/space_mouse.h"
#include "engine/session/real_session.h"
#include "engine/session/recorded_session.h"
#include "engine/session/recording.h"
#include "engine/session/replay_device.h"
#include "engine/session/sample_ring.h"
#include "engine/viewer/annotation.h"
#include "engine/viewer/surface_renderer.h"
#include "engine/window/input.h"
#include "engine/window/panels.h"
#include "engine/window/pointer_hand.h"
#include "engine/window/stage.h"
#include "engine/window/view_state.h"

namespace palp {

class PanelFrame;

/// Values of scene keys that the user has set, as flags take them.
using SceneValues = std::map<std::string, std::string, std::less<>>;

/// A hand that is not the pointer: a script or a device. All of it outlives the workbench's use.
struct WorkbenchHand {
    HapticDevice* device = nullptr; ///< open
    DeviceFrame   frame;
    double        seconds = 5; ///< how long it goes [s]
};

/// What the program gives to a workbench.
struct WorkbenchSettings {
    std::string what;   ///< scene file, cloud file, sample or recorded session
    SceneValues values; ///< over the scene's
    ViewState   state;
    double      seconds = 0; ///< closes by itself after so long [s]; 0: when it is told to

    /// A scene from what the user names. \throws Error
    std::function<Scene(const std::string& what, const SceneValues& values)> open;
    /// The hand for a scene; empty: the pointer. \throws Error
    std::function<WorkbenchHand(const Stage& stage)> hand;
    /// What a new recording says of itself. May be empty: nothing is recorded.
    std::function<SessionInfo(const Stage& stage, const HapticDevice& device)> recorded;

    /// Sees the samples of the object that was named first, on the window's thread. May be empty.
    OnSample onSample;

    const std::atomic<bool>* stop   = nullptr; ///< closes the window once it is true; may be null
    SpaceMouse*              camera = nullptr; ///< moves the camera; may be null
};

/// How the window did.
struct WorkbenchReport {
    std::uint64_t       frames = 0, touchingFrames = 0; ///< [1]
    std::vector<double> frameTimes; ///< of the frames while something was touched: from one to the next [s]
    std::string         said;       ///< what the user must still know; may be empty
    std::vector<double> drawTimes;  ///< of the same: making the picture [s]
};

/// Everything between what happens in a window and the picture in it: camera, pointer, paint, session, panels. It knows
/// no window: run() is called with where input comes from. \thread the window's
class Workbench {
public:
    /// \param renderer  with a window; outlives this
    /// \throws Error as WorkbenchSettings::open and Stage do
    Workbench(WorkbenchSettings settings, SurfaceRenderer& renderer);

    /// What happened since the last picture; may wait so long [s] for something to happen.
    using Poll = std::function<WindowInput(double patience)>;
    /// Touches and shows until the window is closed.
    /// \param panels  outlives it; null: there are none
    WorkbenchReport run(const Poll& poll, PanelFrame* panels);

private:
    using Clock = std::chrono::steady_clock;

    // workbench.cpp
    void                         openWhat(const std::string& what);
    void                         session();
    void                         ended(const SessionSummary& summary);
    void                         frame(const SessionView* view);
    void                         beginPanels();
    void                         rest();
    void                         drawFrame(const SessionView* view);
    void                         showTouch(const SessionView* view);
    void                         addBrush();
    [[nodiscard]] double         patience() const;
    [[nodiscard]] PanelContent   content(const SessionView* view) const;
    [[nodiscard]] bool           panelsShown() const { return panels_ && state_.panels && !state_.blind; }
    void                         writeTexts(const SessionView* view);
    void                         count(bool touching, double period);
    void                         perform(const PanelWishes& wishes);
    void                         change(const SceneValues& values);
    void                         takeChanges();
    void                         useObject();
    [[nodiscard]] Scene          sceneWith(const SceneValues& values) const;
    [[nodiscard]] bool           mayDiscard();
    [[nodiscard]] PatchSolver    solver();
    [[nodiscard]] const Overlay* textsFor(const PictureSize& size) const;
    void                         goOn();
    void                         restart() { stop_ = true; }
    void                         say(const std::string& message) { message_ = message; }
    void                         complain(const std::string& sentence);

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
    void startReplay(const std::filesystem::path& folder);
    void savePaint();

    WorkbenchSettings              settings_;
    SurfaceRenderer&               renderer_;
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
    std::atomic<bool> stop_     = false; ///< the session ends, and the next one begins
    bool              closing_  = false;
    bool              failed_   = false; ///< no session can run until something changes
    bool              painting_ = false; ///< a stroke has begun
    glm::dvec3        lastDab_{};        ///< of it [m]
    bool              recordingWanted_ = false;
    bool              letGo_           = false;    ///< until Space is pressed anew
    bool      paintSaved_ = true, warned_ = false; ///< the last stroke is on disk; the user knows that it is not
    ViewPaint paintBefore_ = ViewPaint::stiffness; ///< that the brush was taken
    Latest<std::string> unsolved_;                 ///< why the last patch was not; empty: it was
    SceneValues         wanted_;                   ///< for the next session
    std::string         toOpen_;                   ///< the same
    WorkbenchHand       hand_;                     ///< of the session that runs, or ran
    glm::ivec2          drawnSize_{};              ///< [px]
    double              capTime_ = 0;              ///< when the SpaceMouse was asked last [s]

    SampleRing<SessionSample>  ring_{4096}; ///< from the servo: four seconds
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
