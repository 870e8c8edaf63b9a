#pragma once
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>

#include "engine/core/latest.h"
#include "engine/core/latest_pair.h"
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
///     servo --touch--> run() --update--> servo     each a hand-off in slots, newest wins
///                        \--patch--> watcher
/// \thread run(): one; touch's writer and newest(): the servo; patch's reader: the watcher
class DeformationLoop {
public:
    /// \param rate  [Hz]
    DeformationLoop(PatchSolver solver, double rate) : solver_(std::move(solver)), period_(1 / rate) {}

    /// Solves until `over`.
    /// \param stopped  time for which the servo had the program stopped, which is no time of a solve; may be null
    void run(const std::atomic<bool>& over, const std::atomic<std::chrono::steady_clock::rep>* stopped = nullptr);

    /// Returns the newest update, where the solver wrote it; null: none yet. For the servo.
    /// \param inUse  the table that it may go on with: that one stays too; null: none
    [[nodiscard]] const PatchUpdate* newest(const ComplianceTable* inUse) noexcept;

    Latest<Touch>      touch;
    Latest<ShownPatch> patch;

    SessionSummary slow; ///< patches, and how long they took: of the thread that runs, until it has ended

private:
    [[nodiscard]] DeformationAnswer solved(const Touch& wanted, double lead);

    PatchSolver                                    solver_;
    double                                         period_; ///< [s]
    LatestPair<std::shared_ptr<const PatchUpdate>> update_;
};

} // namespace palp
