#pragma once
#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "engine/session/recording.h"
#include "engine/session/session_summary.h"
#include "engine/session/tick_stream.h"
#include "engine/session/udp_address.h"
#include "engine/tools/cli/hand_source.h"

namespace palp {

/// The options of a session apart from the scene, shared by run, hunt and study.
struct SessionOptions {
    HandOptions              hand;
    std::string              clock = name(SessionClock::real), threads = name(SessionThreads::servo);
    std::string              record;              ///< a new folder; empty: nothing is recorded
    std::vector<std::string> streams{};           ///< outlets that get each tick, see openOutlet()
    std::string              markers{};           ///< an address where markers are awaited; empty: none
    std::string              command;             ///< the command line, quoted for a shell
    bool                     json        = false; ///< prints JSON, and so no live line
    bool                     blind       = false; ///< tells nothing about what is touched: neither warnings nor numbers
    bool                     handIsKnown = false; ///< with blind: what there is to say of the hand was said before
};

/// Adds --hand and its options, --clock and --threads.
void addSessionOptions(CLI::App& command, SessionOptions& options);

/// Adds --stream, which may be repeated.
void addStreamOption(CLI::App& command, std::vector<std::string>& outlets);

/// Adds --markers.
void addMarkersOption(CLI::App& command, std::string& address);

/// Reads the address of --markers; without a host it is this machine's, so that nobody else is heard.
/// \throws Error naming the option
[[nodiscard]] UdpAddress markerAddress(const std::string& text);

/// Adds --record, --stream and --markers.
void addOutputOptions(CLI::App& command, SessionOptions& options);

/// Checks --clock, --threads and --markers.
/// \throws Error naming the option
void demandGood(const SessionOptions& options);

/// The result of a session.
struct SessionRun {
    SessionSummary                 summary;
    std::string                    solver;     ///< of the plate, at the end
    std::string                    takeover{}; ///< who took over from another solver last, and why; may be empty
    std::string                    hand;
    std::vector<std::string>       warnings;
    std::vector<std::string>       notes; ///< what the hand's user should know
    std::optional<RecordingReport> recorded;
    std::string                    folder; ///< of the recording
    std::vector<StreamReport>      streams{};
    std::uint64_t                  unheard     = 0;     ///< ticks that onTick did not get: it was four seconds late
    bool                           interrupted = false; ///< by the user
};

/// Runs a session from the first tick to the last, which leaves the device at zero force.
/// \param onTick  is given every record, on the calling thread; may be empty
/// \throws Error as handFor(), Deformation and Recording do
[[nodiscard]] SessionRun runSession(const Scene& scene, const LoadedObject& loaded, const SessionOptions& options,
                                    const OnTick& onTick = {});

/// Runs a session in virtual time, with a line on a terminal.
/// \param stop  ends it once it is true; may be null
SessionSummary playVirtual(const SessionParts& parts, double seconds, const OnTick& also,
                           const std::atomic<bool>* stop = nullptr);

/// Returns what became of a stream: "5000 ticks sent to udp:127.0.0.1:9870, 0 dropped".
[[nodiscard]] std::string    sentenceOf(const StreamReport& stream);
[[nodiscard]] nlohmann::json jsonOf(const SessionRun& run);
void                         printText(const SessionRun& run);

/// Checks that the session and its recording are whole.
/// \throws CheckFailed if the force was stopped, or records are missing in the recording or in what onTick got
void demandWhole(const SessionRun& run);

} // namespace palp
