#pragma once
#include <functional>
#include <string>

#include "engine/session/deformation.h"
#include "engine/session/hand_path.h"
#include "engine/session/session_summary.h"

namespace palp {

/// What the caller may show while a session runs.
struct SessionView {
    double time  = 0; ///< [s]
    double force = 0; ///< [N]
    double depth = 0; ///< [m]
};

/// What a session in real time needs beside its scene.
struct RealSessionSettings {
    double   seconds = 5; ///< [s]
    OnSample onSample{};  ///< on the servo's thread, every tick: must neither wait nor allocate; may be empty
    std::function<void(const SessionView&)> onView{}; ///< on the calling thread, ten times a second; may be empty
};

/// A whole session in real time: the servo and the deformation on threads of their own, the caller looks on.
///
///     servo 1 ms --Touch--> deformation 1/rate --PatchNews--> servo        each a three-slot hand-off, newest wins
///
/// A deformation that fails or stalls leaves the servo with its last patch, flagged as stale.
/// \param warning  what the system refused of real-time rights; empty if nothing
/// \param deformation  of the same scene and cloud
SessionSummary runReal(const Scene& scene, const PointCloud& cloud, const NeighbourIndex& index,
                       Deformation& deformation, const HandPath& hand, const RealSessionSettings& settings,
                       std::string& warning);

} // namespace palp
