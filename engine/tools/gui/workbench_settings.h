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
};

/// What getting a hand ready may ask for, from a thread of its own.
struct HandWait {
    const std::atomic<bool>&                       givenUp; ///< nobody wants the hand any more: end soon, by an Error
    std::function<void(const std::string& advice)> tell;    ///< what the user is to do, such as homing; empty: nothing
};

/// What the program gives to a workbench.
struct WorkbenchSettings {
    std::string what;   ///< scene file, cloud file, sample or recorded session
    SceneValues values; ///< over the scene's
    ViewState   state;
    double      seconds = 0; ///< closes by itself after so long [s]; 0: when it is told to

    /// Keys that a tool adds to scenes, for the scenes of recordings; null: none.
    const std::vector<SceneKey>* toolKeys = nullptr;

    /// A scene from what the user names. \thread any, one at a time \throws Error
    std::function<Scene(const std::string& what, const SceneValues& values)> open;
    /// The hand for a scene, homed; empty: the pointer. May take as long as a person needs. \thread as open
    /// \throws Error
    std::function<WorkbenchHand(const Stage& stage, const HandWait& wait)> hand;
    /// What a new recording says of itself. May be empty: nothing is recorded.
    std::function<SessionInfo(const Stage& stage, const HapticDevice& device)> recorded;
    /// Is told what goes wrong, each a sentence that the window shows too. May be empty.
    std::function<void(const std::string& sentence)> complained;
    /// Is told the name of what is shown from now on. May be empty.
    std::function<void(const std::string& name)> titled;
    /// What was assumed of a cloud because nobody said so, in sentences. May be empty.
    std::function<std::vector<std::string>(const Scene& scene, const CloudFileReport& report)> assumed;

    /// Sees the samples of the object that was named first, on the window's thread. May be empty.
    OnTick onTick;

    const std::atomic<bool>* stop   = nullptr; ///< closes the window once it is true; may be null
    SpaceMouse*              camera = nullptr; ///< moves the camera; may be null
};

/// How the window did.
struct WorkbenchReport {
    std::uint64_t       frames = 0, touchingFrames = 0; ///< [1]
    std::vector<double> frameTimes; ///< of the frames while something was touched: from one to the next [s]
    std::string         said;       ///< what the user must still know; may be empty
    std::vector<double> drawTimes;  ///< of the same: making the picture [s]
    std::string         realTime;   ///< what the system refused of real-time rights; empty if nothing
};

} // namespace palp
