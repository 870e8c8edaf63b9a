#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/haptic_device.h"
#include "engine/session/marker.h"
#include "engine/session/recording.h"
#include "engine/session/scene.h"
#include "engine/session/session_clocks.h"
#include "engine/session/tick_record.h"
#include "engine/session/tick_source.h"

namespace palp {

/// A session that was read from its folder.
struct RecordedSession {
    std::filesystem::path        folder;
    SessionClock                 clock = SessionClock::real;
    std::string                  solver;           ///< of the plate, as it was called then
    std::string                  command;          ///< that recorded it
    std::string                  scene;            ///< JSON for parseScene()
    std::string                  cloud;            ///< fingerprint() of what was touched
    HapticDeviceInfo             hand;             ///< its model and limits
    std::optional<glm::dvec3>    from;             ///< [m] SessionParts::from
    bool                         finished = false; ///< false: killed, or still running
    std::string                  whyIncomplete;    ///< what is missing, as the end of a sentence; empty: nothing
    std::optional<std::uint64_t> counted;          ///< ticks that session.json counts, once it is finished
    std::vector<TickRecord>      records;
    std::uint64_t                columns = ~std::uint64_t(0); ///< that were recorded: bit k is sessionColumns()[k]
    std::vector<Marker>          markers;
    std::optional<SessionClocks> clocks; ///< of time 0; empty: an older recording, or it ended before
    std::vector<std::string>     doubts; ///< TickSource::doubts() of all records
};

/// The number of the format that Recording writes: recordings.md describes it. Format 1, of version 0.1.0, had a file
/// per column, fewer of them, and other names of three keys of the scene and of the solver. Between the versions
/// sessions were recorded as format 2 in files like those of format 1. readSession() reads all of them.
inline constexpr int kSessionFormat = 2;

/// The description of a recorded session without its ticks: session.json and markers.jsonl.
/// \throws Error naming the file, what was expected and found
[[nodiscard]] RecordedSession readDescription(const std::filesystem::path& folder);

/// Reads what Recording wrote. Of a session that was killed it reads the ticks that are whole.
/// \throws Error naming the file, what was expected and found
[[nodiscard]] RecordedSession readSession(const std::filesystem::path& folder);

/// Opens its ticks, to be read part by part.
/// \throws Error naming the file, also if session.json counts another number of ticks
[[nodiscard]] std::unique_ptr<TickSource> openTicks(const RecordedSession& session);

/// Reads the scene as it was run.
/// \param toolKeys  see SceneOverrides
/// \throws Error, also if its cloud is not where it was
[[nodiscard]] Scene sceneOf(const RecordedSession& session, const std::vector<SceneKey>* toolKeys = nullptr);

/// The first place where two sessions differ.
struct SessionDifference {
    std::size_t tick = 0;      ///< counted from 0
    double      time = 0;      ///< of that record [s]
    std::string column;        ///< empty: one session ends here
    std::size_t component = 0; ///< of a vector: 0, 1, 2
    std::string first;         ///< value in the first session; its bits too where the values print alike
    std::string second;
};

/// Compares tick by tick and, within one, column by column, bit for bit: NaN equals the same NaN, and 0 is not -0.
/// Numbers are compared as they are stored, and only columns that both sessions have; those measured by the wall clock
/// (SessionColumn::measured) are omitted. Empty if nothing differs.
[[nodiscard]] std::optional<SessionDifference> compareSessions(const RecordedSession& a, const RecordedSession& b);

/// Describes a difference in one sentence: "tick 412 (0.412 s): force z is 0.8312 in run1 and 0.8313 in run2".
[[nodiscard]] std::string describe(const SessionDifference& difference, const RecordedSession& a,
                                   const RecordedSession& b);

} // namespace palp
