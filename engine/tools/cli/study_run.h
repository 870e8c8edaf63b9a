#pragma once
#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/tools/cli/session_run.h"
#include "engine/tools/study/study_order.h"

namespace palp {

/// One participant's way through a study.
struct StudyRun {
    std::string           plan; ///< its file
    std::string           participant;
    std::filesystem::path out;          ///< folder of the study; a participant has one in it
    SessionOptions        session;      ///< hand, clock
    bool                  json = false; ///< what participants read goes to standard error
};

/// How far it went.
struct StudyProgress {
    std::size_t           done = 0, trials = 0; ///< [1]
    bool                  paused = false;
    std::filesystem::path table;
};

/// Goes on where the participant's table ends: touches, asks at the keyboard, appends a row, until the last trial or a
/// pause (q, the end of the input, Ctrl-C).
/// \throws Error if the plan or the table is not the one that was begun with, CheckFailed if a device's force was
/// stopped
[[nodiscard]] StudyProgress runStudy(const StudyRun& run, const study::StudyPlan& plan);

/// What a participant's folder says of its study. \throws Error naming the file
[[nodiscard]] nlohmann::json readStudyFile(const std::filesystem::path& participantFolder);

} // namespace palp
