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
        recording_ = std::make_unique<Recording>(folder_, info(), [this](const std::string& fault) {
            fault_.draft() = fault;
            fault_.publish();
        });
        notices_.say("recording " + folder_);
    } catch (const Error& error) {
        notices_.complain(error.what());
    }
}

void SessionRecorder::end()
{
    if (!recording_) return;
    static_cast<void>(recording_->finish()); // what it lacks is a fault
    recording_.reset();
    lastFolder_ = folder_;
    tell();
}

void SessionRecorder::tell()
{
    if (!fault_.take()) return;
    hasLost_ = true;
    notices_.complain(*fault_.held());
}

} // namespace palp
