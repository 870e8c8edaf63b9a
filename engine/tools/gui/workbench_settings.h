#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "device/hid/space_mouse.h"
#include "engine/session/recording.h"
#include "engine/session/session_parts.h"
#include "engine/session/session_summary.h"
#include "engine/session/tick_stream.h"
#include "engine/tools/gui/stage.h"
#include "engine/tools/gui/view_state.h"

namespace palp {

/// Values of scene keys that the user has set, as flags take them.
using SceneValues = std::map<std::string, std::string, std::less<>>;

/// A hand that is not the pointer: a script or a device. All of it outlives the workbench's use.
struct WorkbenchHand {
    HapticDevice* device = nullptr; ///< open
    DeviceFrame   frame;
    double        seconds = 5; ///< how long it goes [s]

    std::optional<glm::dvec3> from{}; ///< [m] SessionParts::from of the first session with it
};

/// What the thread that makes a hand ready may use.
struct HandWait {
    const std::atomic<bool>&                       givenUp; ///< the hand is not wanted any more: end soon, by an Error
    std::function<void(const std::string& advice)> tell;    ///< shows what the user must do, such as homing, or nothing
};

/// The settings that the program gives to a workbench.
struct WorkbenchSettings {
    std::string what;   ///< scene file, cloud file, sample or recorded session
    SceneValues values; ///< over the scene's
    ViewState   state;
    double      seconds = 0; ///< time after which it closes by itself [s]; 0: not by itself

    /// Keys that a tool adds to scenes, for the scenes of recordings; null: none.
    const std::vector<SceneKey>* toolKeys = nullptr;

    /// Makes a scene from the name that the user gives.
    /// \thread any, one at a time
    /// \throws Error if it cannot be read
    std::function<Scene(const std::string& what, const SceneValues& values)> open;
    /// Returns the hand for a scene, homed; empty: the pointer. May take as long as a person needs.
    /// \thread as open
    /// \throws Error if the hand cannot be used
    std::function<WorkbenchHand(const Stage& stage, const HandWait& wait)> hand;
    /// Returns the description of a new recording. May be empty: nothing is recorded.
    std::function<SessionInfo(const Stage& stage, const HapticDevice& device)> recorded;
    /// Is called with each fault, a sentence that the window shows too. May be empty.
    std::function<void(const std::string& sentence)> complained;
    /// Is called with each object that is shown, as the user named it. May be empty.
    std::function<void(const std::string& what)> opened;
    /// Returns the objects that the panels offer. Is called after opened. May be empty: none.
    std::function<std::vector<std::string>()> offered;
    std::string                               welcome{}; ///< a first message to the user, not in hunts; may be empty
    /// Is called with the name of each object that is shown. May be empty.
    std::function<void(const std::string& name)> titled;
    /// Returns, in sentences, what was assumed of a cloud because nothing states it. May be empty.
    std::function<std::vector<std::string>(const Scene& scene, const CloudFileReport& report)> assumed;

    /// Is given the records of the object that was opened first, on the window's thread. May be empty.
    OnTick onTick;

    /// Get every tick and marker of all sessions. They outlive the window's use.
    std::vector<TickStream*> streams{};

    const std::atomic<bool>* stop   = nullptr; ///< closes the window once it is true; may be null
    SpaceMouse*              camera = nullptr; ///< moves the camera; may be null
};

/// The statistics of a window's run.
struct WorkbenchReport {
    std::uint64_t       frames = 0, touchingFrames = 0;
    std::vector<double> frameTimes;      ///< time from frame to frame, while something was touched [s]
    std::string         said;            ///< a last message for the user; may be empty
    bool                hasLost = false; ///< paint or ticks that it should have kept; it has complained of that
    std::vector<double> drawTimes;       ///< of the same frames: making the picture [s]
    std::string         realTime;        ///< real-time rights that the system refused; empty if none
};

} // namespace palp
