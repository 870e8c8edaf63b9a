#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "engine/session/real_session.h"
#include "engine/session/recorded_session.h"
#include "engine/session/replay_device.h"
#include "engine/session/session_tap.h"
#include "engine/session/tick_ring.h"
#include "engine/tools/gui/notices.h"
#include "engine/tools/gui/pointer_touch.h"
#include "engine/tools/gui/session_recorder.h"
#include "engine/tools/gui/touch_history.h"
#include "engine/tools/gui/workbench_settings.h"

namespace palp {

/// Runs one session after the other on the stage, with the pointer, a device or a replay as the hand.
/// Invariant: a session that was halted leaves no force, and none runs until resume().
/// \thread the window's, except for givenUp()
class TouchSession {
public:
    /// \param settings  outlive this
    TouchSession(const WorkbenchSettings& settings, Notices& notices);

    /// Takes another object, or other values of its scene: the pointer's hand begins anew over it.
    void setStage(Stage& stage);
    /// Forgets what a solver of the plate has said; must be called once the stage has opened another one.
    /// \pre no session runs
    void forgetSolver();

    using ReadyHand = std::function<std::optional<WorkbenchHand>()>;
    using OnView    = std::function<void(const SessionView&)>;
    /// Runs a session in real time until it ends: the replay if there is one, or else the hand's.
    /// \pre there is a stage
    /// \param readyHand  makes the settings' hand ready, if they have one; returns nothing if no session is wanted now
    /// \param onView     is called between two looks at the session
    /// \throws Error as readyHand and runReal() do; the recording has ended then
    void run(const ReadyHand& readyHand, const OnView& onView);

    /// Ends the session that runs; the next one begins unless this is halted.
    void end() { ended_ = true; }
    /// Ends the session that runs; the next one begins after resume().
    void halt();
    void resume();
    /// Must be called before each session.
    void               rearm() { ended_ = false; }
    [[nodiscard]] bool halted() const { return state_ == State::halted; }
    /// Returns whether there is no force until the user goes on: halted, or a fault of the governor.
    [[nodiscard]] bool                     forceIsStopped() const;
    [[nodiscard]] bool                     neverRan() const { return state_ == State::neverRan; }
    [[nodiscard]] const std::atomic<bool>& givenUp() const { return ended_; } ///< \thread any

    /// Replays a session from the next session on.
    /// \param session  outlives its replay
    void               startReplay(const RecordedSession& session);
    void               stopReplay() { replay_.reset(); }
    [[nodiscard]] bool replaying() const { return replay_ != nullptr; }
    [[nodiscard]] bool byPointer() const { return !settings_.hand && !replay_; }

    /// Begins a recording with a new session, or ends the one that runs.
    void toggleRecording();
    /// Marks the newest tick in the recording and in the settings' streams.
    void mark();
    /// Does the same with a text from anywhere, and says nothing; nothing takes it where nothing is recorded or sent.
    /// \thread any
    void mark(std::string_view text);
    /// Counts markers as lost that were sent and did not come, in the recording and in the settings' streams.
    /// \thread any
    void                                 loseMarkers(std::uint64_t markers);
    [[nodiscard]] const SessionRecorder& recorder() const { return recorder_; }
    void                                 endRecording() { recorder_.end(); }

    /// Follows the pointer, and begins another session where the hand cannot move in a straight line.
    void followPointer(const WindowInput& input, const std::optional<Hit>& hit, double& depth);
    /// Releases the object, whichever hand is in use.
    void letGo();
    /// Holds the device's clutch, or lets go of it.
    void toggleClutch();
    /// Declares the place that the pointer's hand is on.
    void declare();

    /// Collects what the session's threads have handed over since the last call.
    void                              collect(const OnTick& onTick);
    [[nodiscard]] const TouchHistory& history() const { return history_; }
    [[nodiscard]] std::string         unsolved() const; ///< why the last patch could not be solved; empty: it was
    [[nodiscard]] std::string takeover() const; ///< who took over from another solver last, and why; may be empty
    [[nodiscard]] std::string handModel() const { return hand_.device->info().model; }
    [[nodiscard]] bool        handTurns() const { return hand_.device->info().rotates; } ///< its stylus is drawn
    [[nodiscard]] const std::string& realTime() const { return realTime_; } ///< as WorkbenchReport::realTime
    void                             noteRealTime(std::string_view warning);

private:
    enum class State { neverRan, ready, halted };

    [[nodiscard]] PatchSolver solver();
    void                      runWith(const WorkbenchHand& hand, const OnView& onView);
    void                      closeTap();
    void                      conclude(const SessionSummary& summary);

    const WorkbenchSettings&      settings_;
    Notices&                      notices_;
    Stage*                        stage_ = nullptr;
    std::optional<PointerTouch>   pointer_;
    SessionRecorder               recorder_;
    std::mutex                    tapMutex_; ///< of whether there is a tap, and of its markers
    std::optional<SessionTap>     tap_;      ///< of the session that runs
    std::unique_ptr<ReplayDevice> replay_;
    WorkbenchHand                 hand_;       ///< of the session that runs, or ran last
    std::optional<glm::dvec3>     replayFrom_; ///< [m] SessionParts::from
    std::optional<glm::dvec3>     heldAt_;     ///< [m] where the last session with the settings' hand left its tool
    State                         state_    = State::neverRan;
    std::atomic<bool>             ended_    = false;
    std::atomic<bool>             clutched_ = false;
    std::string                   realTime_;
    TickRing<TickRecord>          ring_{4096}; ///< from the servo: four seconds
    TouchHistory                  history_;
    Latest<std::string>           unsolved_, takeover_; ///< from the deformation
};

} // namespace palp
