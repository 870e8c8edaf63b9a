#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string_view>
#include <vector>

#include "engine/core/latest.h"
#include "engine/session/recording.h"
#include "engine/session/tick_stream.h"

namespace palp {

/// All that leaves a session while it runs: a recording, streams, and the markers that both get.
/// \thread  begin(), push(), pushWaiting(): the session's one thread, and as those of Recording; mark(), lose(): any
///          other
class SessionTap {
public:
    /// \param recording  may be null; it and the streams outlive this
    SessionTap(Recording* recording, std::vector<TickStream*> streams);

    /// Takes the instant of the session's time 0. A later call moves it for what is streamed from then on, after a
    /// pause that is no time of the session; a recording keeps the first.
    void begin(std::chrono::steady_clock::time_point start) noexcept;
    void push(const TickRecord& record) noexcept;
    /// Waits where there is no room: for the virtual clock.
    void pushWaiting(const TickRecord& record) noexcept;
    /// Marks the newest tick with a text from anywhere, which markerText() makes harmless. Before time 0 has come, the
    /// marker is of time 0, and is streamed with the clocks of its own moment.
    void mark(std::string_view text);
    /// Counts markers as lost that were sent and did not come: a recording's report and a gap in a stream's numbers
    /// tell of them.
    void lose(std::uint64_t markers);

    [[nodiscard]] std::uint64_t marked() const noexcept { return marked_; } ///< markers so far

private:
    Recording*                 recording_;
    std::vector<TickStream*>   streams_;
    std::mutex                 mutex_;     ///< of who marks
    Latest<SessionClocks>      clocks_;    ///< of time 0: from the session's thread to who marks
    std::atomic<double>        newest_{0}; ///< [s] of the newest tick
    std::atomic<std::uint64_t> marked_{0};
    bool                       begun_ = false; ///< of the session's thread
};
static_assert(std::atomic<double>::is_always_lock_free, "the servo writes one");

} // namespace palp
