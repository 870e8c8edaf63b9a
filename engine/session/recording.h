#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "device/haptic_device.h"
#include "engine/core/enum_names.h"
#include "engine/session/marker.h"
#include "engine/session/scene.h"
#include "engine/session/session_clocks.h"
#include "engine/session/tick_record.h"

namespace palp {

enum class SessionClock {
    real,       ///< a tick a millisecond
    virtualTime ///< "virtual": as fast as it goes, deterministic
};
constexpr auto namesOf(SessionClock)
{
    using enum SessionClock;
    return std::to_array<NamedValue<SessionClock>>({{real, "real"}, {virtualTime, "virtual"}});
}

/// The description of a session in session.json.
struct SessionInfo {
    Scene                              scene;
    std::map<std::string, std::string> versions; ///< such as {"palpate", "0.1.0"}, {"driver", "llvmpipe 15"}
    std::string                        solver;   ///< of the plate, as it is called
    SessionClock                       clock = SessionClock::real;
    std::string                        command; ///< line by which the session was started
    std::string                        cloud{}; ///< fingerprint() of what is touched
    HapticDeviceInfo                   hand{};  ///< the device's model, and its limits, which bound the force
    std::optional<glm::dvec3>          from{};  ///< [m] SessionParts::from
};

/// The result of a recording.
struct RecordingReport {
    std::uint64_t ticks      = 0;         ///< on disk
    std::uint64_t lost       = 0;         ///< pushed and not on disk: the ring was full, or writing had stopped
    double        longestGap = 0;         ///< [s] between two visits of the writer: what a kill would have cost at most
    std::optional<std::string> stopped{}; ///< why writing stopped early: a sentence
    std::uint64_t              markers     = 0; ///< on disk
    std::uint64_t              markersLost = 0; ///< came too fast, were too many, or writing had stopped; and lose()
};

/// Writes a session while it runs: a folder with session.json, ticks.npy with a row for each tick, and markers.jsonl
/// with a line for each marker. recordings.md describes them; what the format calls a sample is the record of a tick.
///
///     servo ---push()---> ring of 4096 records (4 s) ---writer thread, every 2 ms---> rows, then the header
///     others --mark()---> list behind a lock -------------'
///
/// The header of ticks.npy has room for any count and is written again after the rows that it counts, so that numpy
/// reads the file at every moment, also after kill -9: then the records since the writer's last visit are missing, some
/// 2 ms (longer where the machine does not schedule the writer for longer; see RecordingReport::longestGap).
///
/// When a file cannot be written (a full disk, a limit on sizes) the rows end at a whole record, one sentence gives the
/// reason, and pushing goes on without effect: the touch does not depend on the disk.
/// \thread  begin(), push(), pushWaiting(): one thread; wait-free but for the last, no allocation, lock or throw;
///          mark(), lose(): any other; all else: the thread that made it
class Recording {
public:
    using Complain = std::function<void(const std::string&)>;

    /// The most markers of a recording, and the most between two visits of the writer [1].
    static constexpr std::size_t kMostMarkers = 100'000, kMostMarkersAtOnce = 256;

    /// \param folder    is made; it must not exist or be empty: sessions are never overwritten
    /// \param complain  is called, at most once and on the writer's thread or in finish(), with why recording stopped
    ///                  or how many ticks were lost; empty: standard error
    /// \throws Error naming the folder and the reason
    Recording(const std::filesystem::path& folder, const SessionInfo& info, Complain complain = {});
    ~Recording(); ///< as finish()
    Recording(const Recording&)            = delete;
    Recording& operator=(const Recording&) = delete;

    /// Takes the clocks of time 0. Without it the first record does: it is of that moment, so time 0 was its time ago.
    /// \pre no record has been pushed
    void begin(const SessionClocks& clocks) noexcept;

    /// Takes one record; if the ring is full it is counted as lost.
    void push(const TickRecord& record) noexcept;

    /// Takes one record and waits for room: for the virtual clock, which is faster than any disk.
    void pushWaiting(const TickRecord& record) noexcept;

    /// Takes a marker whose text markerText() made; if there are too many it is counted as lost.
    void mark(const Marker& marker);
    /// Counts markers as lost that were sent and did not reach this.
    void lose(std::uint64_t markers);

    /// Writes what is left, marks session.json as finished, and ends the writer. Later calls return the same.
    RecordingReport finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
