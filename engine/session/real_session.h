#pragma once
#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "engine/session/session_parts.h"
#include "engine/session/session_summary.h"

namespace palp {

/// Shows a session while it runs. It is valid during the call that hands it over.
struct SessionView {
    TickRecord    record;          ///< the newest
    double        loopPeriod = 0;  ///< of the servo, a mean over 0.1 s [s]
    double        solveTime  = 0;  ///< of the last patch [s]; 0: none yet
    std::uint32_t buttons    = 0;  ///< of the device
    const char*   words      = ""; ///< of the device about its present fault, see HapticDevice::faultWords()
    const Patch*  patch =
        nullptr;                ///< the last one: displaced(cloud, *patch, drawnLoad(...)) is the surface; may be null
    std::string_view warning{}; ///< the real-time rights that the system refused; empty if none
};

/// The settings of a session in real time, beside its parts.
struct RealSessionSettings {
    double         seconds = 5; ///< [s]
    SessionThreads threads = SessionThreads::servo;
    /// Is given the instant of time 0, on the servo's thread, before the first tick; and again when Ctrl-Z has stopped
    /// the program, which moves it, because a pause is no time of the session. As onTick.
    std::function<void(std::chrono::steady_clock::time_point)> onStart{};
    OnTick onTick{}; ///< on the servo's thread, every tick: must neither wait nor allocate; may be empty
    std::function<void(const SessionView&)> onView{};         ///< on the calling thread, every viewPeriod; may be empty
    double                                  viewPeriod = 0.1; ///< [s]
    const std::atomic<bool>*                stop       = nullptr; ///< ends the session once it is true; may be null
    const std::atomic<bool>*                clutch     = nullptr; ///< holds the Clutch while it is true; may be null
};

/// Runs a whole session in real time: servo and deformation have threads of their own, and the caller watches.
///
///     servo 1 ms --Touch--> deformation 1/rate --PatchUpdate--> servo     each a hand-off in slots, newest wins
///       \--TickRecord--> caller <--Patch--/                          read in place, nothing is copied out
///
///     paper:  force 1 ms --Hand--> proxy 1 ms --Touch--> deformation; the force takes the proxy's latest answer, a
///     tick old
///
/// A deformation that fails or stalls leaves the servo with its last patch, flagged as stale; after a quarter of a
/// second of contact the force fades within 20 ms, and engages anew once there are patches. A solver that throws has
/// failed to solve one patch; SessionSummary::why has the reason. A device that is unplugged, or whose link is lost,
/// ends the session. However a session ends, also by an exception of onView, the device is given zero force.
/// \param warning  the real-time rights that the system refused; empty if none
/// \throws anything that onView or onTick threw, once all threads have ended
/// \differs the paper has a thread each for proxy and force, which makes the force a tick or two late; here one thread
///          does both, and SessionThreads::paper keeps two
SessionSummary runReal(const SessionParts& parts, const RealSessionSettings& settings, std::string& warning);

} // namespace palp
