#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/tools/cli/session_run.h"
#include "engine/tools/study/study_order.h"

namespace palp {

/// The options of one participant's run of a study.
struct StudyRun {
    std::string           plan; ///< its file
    std::string           participant;
    std::filesystem::path out;          ///< folder of the study; a participant has one in it
    SessionOptions        session;      ///< hand, clock
    bool                  json = false; ///< texts for participants go to standard error
};

/// How far a run went.
struct StudyProgress {
    std::size_t                done = 0, trials = 0; ///< numbers of trials
    bool                       paused = false;
    std::filesystem::path      table;
    std::vector<std::string>   warnings{}; ///< of this run's sessions, each with its trial: for who runs the study
    std::vector<std::uint64_t> unfelt{};   ///< trials, from 1, of which a touch was not felt
};

/// Continues where the participant's table ends: touches, asks at the keyboard and appends a row, until the last trial
/// or a pause (q, the end of the input, Ctrl-C).
/// \throws Error if the plan or the table has changed since the participant began, CheckFailed if a device's force was
///         stopped
[[nodiscard]] StudyProgress runStudy(const StudyRun& run, const study::StudyPlan& plan);

} // namespace palp
