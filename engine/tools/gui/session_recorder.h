#pragma once
#include <functional>
#include <memory>
#include <string>

#include "engine/core/latest.h"
#include "engine/session/recording.h"
#include "engine/tools/gui/notices.h"

namespace palp {

/// Records sessions on demand. Invariant: one session has one recording at most, which ends with it, and folders are
/// never overwritten.
/// \thread the window's
class SessionRecorder {
public:
    explicit SessionRecorder(Notices& notices) : notices_(notices) {}
    ~SessionRecorder() { end(); }
    SessionRecorder(const SessionRecorder&)            = delete;
    SessionRecorder& operator=(const SessionRecorder&) = delete;

    /// Requests that the next session be recorded.
    void request() { requested_ = true; }
    /// Starts the requested recording; shows its folder, or why it could not start.
    /// \pre no session runs
    void begin(const std::function<SessionInfo()>& info);
    /// Ends the recording, if there is one, and shows a fault if it lacks something.
    /// \pre no session runs
    void end();
    /// Shows why the recording has stopped, also while its session goes on.
    void tell();

    /// Returns null while nothing is recorded. Only the servo's thread may push while a session runs.
    [[nodiscard]] Recording*         recording() const noexcept { return recording_.get(); }
    [[nodiscard]] const std::string& folder() const noexcept { return folder_; } ///< of the newest recording, or empty
    /// Returns an empty text until a recording has ended.
    [[nodiscard]] const std::string& lastFolder() const noexcept { return lastFolder_; }
    [[nodiscard]] bool hasLost() const noexcept { return hasLost_; } ///< a recording of this window lacks something

private:
    Notices&                   notices_;
    bool                       requested_ = false, hasLost_ = false;
    Latest<std::string>        fault_; ///< from the recording's thread, or from end() once that has ended
    std::unique_ptr<Recording> recording_;
    std::string                folder_, lastFolder_;
};

} // namespace palp
