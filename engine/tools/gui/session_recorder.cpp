#include "engine/tools/gui/session_recorder.h"

#include <utility>

#include "engine/core/contract.h"
#include "engine/tools/gui/numbered_file.h"

namespace palp {

void SessionRecorder::begin(const std::function<SessionInfo()>& info)
{
    if (!std::exchange(requested_, false)) return;
    try {
        folder_    = unusedPath("session", "").string();
        recording_ = std::make_unique<Recording>(folder_, info(), [](const std::string&) {});
        notices_.say("recording " + folder_);
    } catch (const Error& error) {
        notices_.complain(error.what());
    }
}

void SessionRecorder::end()
{
    if (!recording_) return;
    const RecordingReport report = recording_->finish();
    recording_.reset();
    lastFolder_ = folder_;
    if (report.stopped)
        notices_.complain(*report.stopped);
    else if (report.lost > 0)
        notices_.complain(folder_ + ": " + std::to_string(report.lost) + " ticks were lost");
}

} // namespace palp
