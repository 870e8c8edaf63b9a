#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/session/recording.h"
#include "engine/session/tick_stream.h"

namespace palp {

/// All that leaves a session while it runs: a recording, streams, and the markers that both get.
/// \thread  begin(), push(), pushWaiting(): the session's one thread, and as those of Recording; mark(): any other
class SessionTap {
public:
    /// \param recording  may be null; it and the streams outlive this
    SessionTap(Recording* recording, std::vector<TickStream*> streams);

    /// Takes the instant of a session's time 0.
    void begin(std::chrono::steady_clock::time_point start) noexcept;
    void push(const TickRecord& record) noexcept;
    /// Waits where there is no room: for the virtual clock.
    void pushWaiting(const TickRecord& record) noexcept;
    /// Marks the newest tick with a text from anywhere, which markerText() makes harmless.
    void mark(std::string_view text);

    [[nodiscard]] std::uint64_t marked() const noexcept { return marked_; } ///< markers so far

private:
    Recording*                 recording_;
    std::vector<TickStream*>   streams_;
    std::atomic<double>        newest_{0}; ///< [s] of the newest tick
    std::atomic<std::uint64_t> marked_{0};
    bool                       begun_ = false; ///< of the session's thread
};
static_assert(std::atomic<double>::is_always_lock_free, "the servo writes one");

} // namespace palp
