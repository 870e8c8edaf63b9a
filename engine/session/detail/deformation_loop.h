#pragma once
#include <atomic>
#include <chrono>
#include <optional>

#include "engine/core/latest.h"
#include "engine/session/deformation.h"
#include "engine/session/session_summary.h"

namespace palp {

/// The deformation's output for whoever watches.
struct ShownPatch {
    std::optional<Patch> patch;
    double               solveTime = 0; ///< [s]
};

/// The deformation of a session in real time, which solves for the newest touch once a period.
///
///     servo --touch--> run() --update--> servo     each a three-slot hand-off, newest wins
///                        \--patch--> watcher
/// \thread run(): one; touch's writer and update's reader: the servo; patch's reader: the watcher
class DeformationLoop {
public:
    /// \param rate  [Hz]
    DeformationLoop(PatchSolver solver, double rate) : solver_(std::move(solver)), period_(1 / rate) {}

    /// Solves until `over`.
    /// \param stopped  time for which the servo had the program stopped, which is no time of a solve; may be null
    void run(const std::atomic<bool>& over, const std::atomic<std::chrono::steady_clock::rep>* stopped = nullptr);

    Latest<Touch>       touch;
    Latest<PatchUpdate> update;
    Latest<ShownPatch>  patch;

    SessionSummary slow; ///< patches, and how long they took: of the thread that runs, until it has ended

private:
    [[nodiscard]] DeformationAnswer solved(const Touch& wanted, double lead);

    PatchSolver solver_;
    double      period_; ///< [s]
};

} // namespace palp
