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
#include "engine/session/scene.h"
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

/// What session.json says of a session.
struct SessionInfo {
    Scene                              scene;
    std::map<std::string, std::string> versions; ///< such as {"palpate", "0.1.0"}, {"driver", "llvmpipe 15"}
    std::string                        solver;   ///< of the plate, as it is called
    SessionClock                       clock = SessionClock::real;
    std::string                        command; ///< line by which the session was started
    std::string                        cloud{}; ///< fingerprint() of what is touched
    HapticDeviceInfo                   hand{};  ///< the device's model, and its limits, which bound the force
};

/// What became of a recording.
struct RecordingReport {
    std::uint64_t samples    = 0;         ///< on disk
    std::uint64_t lost       = 0;         ///< were pushed and are not: the ring was full, or writing had stopped
    double        longestGap = 0;         ///< [s] between two visits of the writer: what a kill would have cost at most
    std::optional<std::string> stopped{}; ///< why writing stopped early: a sentence
};

/// Writes a session while it runs: a folder with session.json, a .npy file per column, and samples.csv.
///
///     servo ---push()---> ring of 4096 samples (4 s) ---writer thread, every 2 ms---> data, then headers
///
/// Each .npy header has room for any count and is written again after the data that it counts, so that numpy reads
/// every file at every moment, also after kill -9: then the samples since the writer's last visit are missing, some 2
/// ms (a machine that does not schedule the writer for longer loses longer; RecordingReport::longestGap says so). A
/// kill between two headers leaves columns whose lengths differ by one visit; readSession() takes the shortest.
///
/// When a file cannot be written (a full disk, a limit on sizes) all columns end at the same, last whole sample, one
/// sentence says why, and pushing goes on without effect: the touch does not depend on the disk.
/// \thread  push(): one thread, wait-free, no allocation, lock or throw; all else: the thread that made it
class Recording {
public:
    using Complain = std::function<void(const std::string&)>;

    /// \param folder    is made; it must not exist or be empty: sessions are never overwritten
    /// \param complain  hears, at most once and on the writer's thread, why recording stopped; empty: standard error
    /// \throws Error naming the folder and the reason
    Recording(const std::filesystem::path& folder, const SessionInfo& info, Complain complain = {});
    ~Recording(); ///< as finish()
    Recording(const Recording&)            = delete;
    Recording& operator=(const Recording&) = delete;

    /// Takes one sample; if the ring is full it is counted as lost.
    void push(const TickRecord& sample) noexcept;

    /// Takes one sample and waits for room: for the virtual clock, which outruns any disk.
    void pushWaiting(const TickRecord& sample) noexcept;

    /// Writes what is left, says so in session.json, and ends the writer. Later calls return the same.
    RecordingReport finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
