#include "engine/tools/cli/session_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/curvature_doubt.h"
#include "engine/pipeline/dent_length.h"
#include "engine/pipeline/patch_warnings.h"
#include "engine/session/failure_teller.h"
#include "engine/session/interrupt.h"
#include "engine/session/marker_input.h"
#include "engine/session/real_session.h"
#include "engine/session/session_line.h"
#include "engine/session/session_tap.h"
#include "engine/session/tick_ring.h"
#include "engine/session/virtual_session.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/named_option.h"
#include "engine/tools/cli/session_report.h"

namespace palp {
namespace {

/// Returns warnings before touching, from the plate at the scene's place, solved on the host, which needs no GPU.
std::vector<std::string> warningsOf(const Scene& scene, const SoftObject& object)
{
    try {
        const HandPlace          place = handPlace(scene, object);
        PlateSolver              host("host");
        const Patch              patch = deform(object, {place.point, place.outward}, scene.patch, host);
        std::vector<std::string> said  = warnings(patch, scene.patch, 0, scene.material);
        for (std::string& line : curvatureDoubts(object, patch, scene.patch)) said.push_back(std::move(line));
        return said;
    } catch (const Error& error) { // a hand from a file may work elsewhere
        return {std::string("nothing can be felt at the scene's place: ") + error.what()};
    }
}

/// Runs a session in real time, with a line that shows what the hand feels.
/// \param clutch   see RealSessionSettings; may be null
/// \param run      gets `unheard`, and a warning where real-time rights are refused
SessionSummary playLive(const SessionOptions& o, double seconds, const SessionParts& parts, SessionTap& tap,
                        const OnTick& also, const std::atomic<bool>* clutch, SessionRun& run)
{
    const bool           line = isatty(STDERR_FILENO) != 0 && !o.json;
    TickRing<TickRecord> ring(also ? 4096 : 1); // four seconds; from the servo to this thread
    const auto           drain = [&] {
        for (auto records = ring.front(); !records.empty(); records = ring.front()) {
            for (const TickRecord& record : records) also(record);
            ring.pop(records.size());
        }
    };
    RealSessionSettings settings;
    settings.seconds = seconds;
    settings.threads = *valueNamed<SessionThreads>(o.threads);
    settings.stop    = &catchInterrupts();
    settings.clutch  = clutch;
    settings.onStart = [&](std::chrono::steady_clock::time_point start) { tap.begin(start); };
    settings.onTick  = [&, heard = bool(also)](const TickRecord& record) {
        tap.push(record);
        if (heard && !ring.push(record)) ++run.unheard;
    };
    settings.onView = [&, heard = bool(also)](const SessionView& view) {
        if (heard) drain();
        if (!line) return;
        o.blind ? showTime(view, seconds) : showLine(view);
    };
    std::string          warning;
    const SessionSummary summary = runReal(parts, settings, warning);
    if (also) drain();
    if (line) clearLine();
    if (!warning.empty()) run.warnings.push_back(warning);
    if (!warning.empty() && !o.blind) warn({warning});
    return summary;
}

/// Returns the solver, which also says on standard error why a hand feels nothing.
PatchSolver telling(PatchSolver solver)
{
    return tellingFailures(std::move(solver), [](const std::string& sentence) {
        if (isatty(STDERR_FILENO) != 0) clearLine(); // which shows what the hand feels
        warn({sentence});
    });
}

/// Opens the outlets that the user names.
std::vector<std::unique_ptr<TickStream>> streamsOf(const SessionOptions& o)
{
    std::vector<std::unique_ptr<TickStream>> streams;
    for (const std::string& outlet : o.streams) streams.push_back(std::make_unique<TickStream>(openOutlet(outlet)));
    return streams;
}

bool takesMarkers(const SessionOptions& o)
{
    return !o.record.empty() || !o.streams.empty();
}

/// Opens the address of markers, if anything takes them, and the keyboard. A participant's keys mean nothing.
/// \param clutch  is held and let go of by the key K; null: there is nothing to hold
std::unique_ptr<MarkerInput> markersOf(const SessionOptions& o, std::atomic<bool>* clutch)
{
    if (!takesMarkers(o) && !clutch) return nullptr;
    MarkerSources sources;
    sources.keys = !o.blind && isatty(STDERR_FILENO) != 0;
    if (!o.markers.empty()) sources.address = markerAddress(o.markers);
    if (clutch)
        sources.onKey = [clutch](std::string_view key) {
            const bool isClutch = key == "k" || key == "K";
            if (isClutch) *clutch = !*clutch;
            return isClutch;
        };
    return std::make_unique<MarkerInput>(sources);
}

/// Says what keys mean, where they are heard.
void sayKeys(const SessionOptions& o, bool hasClutch)
{
    std::cerr << "palpate: "
              << (hasClutch ? "K holds the clutch and lets go of it: no force flows meanwhile, and the tool stays; "
                            : "")
              << (!takesMarkers(o) ? ""
                  : hasClutch      ? "each other key marks its moment; "
                                   : "each key marks its moment; ")
              << "Ctrl-C ends\n";
}

std::unique_ptr<Recording> recordingOf(const SessionOptions& o, const SessionParts& parts, SessionClock clock,
                                       const std::string& solver)
{
    if (o.record.empty()) return nullptr;
    demandFolder("--record", o.record);
    SessionInfo info;
    info.scene    = parts.scene;
    info.versions = {{"palpate", PALPATE_VERSION}, {"compiler", __VERSION__}, {"libraries", PALPATE_LIBRARIES}};
    info.solver   = solver;
    info.clock    = clock;
    info.command  = o.command;
    info.cloud    = fingerprint(parts.object.cloud());
    info.hand     = parts.frame.inScene(parts.device.info());
    info.from     = parts.from;
    return std::make_unique<Recording>(o.record, info);
}

std::string onUnheard(const SessionRun& run)
{
    return counted(run.unheard, "tick") +
           " not counted in, because this program was kept from reading them for four seconds";
}

} // namespace

UdpAddress markerAddress(const std::string& text)
{
    return parseUdpAddress(text, "--markers", "127.0.0.1"); // nobody else's, unless the user says so
}

SessionSummary playVirtual(const SessionParts& parts, double seconds, const OnTick& also, const std::atomic<bool>* stop)
{
    Progress    progress("touching");
    const auto  total = std::size_t(std::llround(1000 * seconds));
    std::size_t done  = 0;
    return runVirtual(
        parts, seconds,
        [&](const TickRecord& record) {
            if (also) also(record);
            progress.at(++done, total);
        },
        stop);
}

std::string sentenceOf(const StreamReport& stream)
{
    std::string sentence =
        counted(stream.sent, "tick") + " sent to " + stream.to + ", " + std::to_string(stream.dropped) + " dropped";
    if (stream.markersLost > 0) sentence += "; " + counted(stream.markersLost, "marker") + " lost";
    return sentence;
}

nlohmann::json jsonOf(const SessionRun& run)
{
    nlohmann::json all = jsonOf(run.summary);
    all["hand"]        = run.hand;
    all["solver"]      = run.solver;
    all["takeover"]    = orNull(run.takeover);
    all["warnings"]    = run.warnings;
    all["notes"]       = run.notes;
    if (run.recorded) // "samples" is the word of session.json
        all["recorded"] = {{"folder", run.folder},
                           {"samples", run.recorded->ticks},
                           {"lost", run.recorded->lost},
                           {"stopped", orNull(run.recorded->stopped.value_or(""))},
                           {"markers", run.recorded->markers},
                           {"markers_lost", run.recorded->markersLost}};
    for (const StreamReport& stream : run.streams)
        all["streams"].push_back({{"to", stream.to},
                                  {"sent", stream.sent},
                                  {"dropped", stream.dropped},
                                  {"markers", stream.markers},
                                  {"markers_lost", stream.markersLost}});
    return all;
}

void printText(const SessionRun& run)
{
    printText(run.summary, run.solver, run.hand);
    if (!run.takeover.empty()) std::cout << "  " << run.takeover << "\n";
    if (run.recorded) {
        std::cout << "  " << counted(run.recorded->ticks, "tick") << " in " << run.folder;
        if (run.recorded->markers > 0) std::cout << ", " << counted(run.recorded->markers, "marker");
        std::cout << "\n";
        if (run.recorded->markersLost > 0)
            std::cout << "  " << counted(run.recorded->markersLost, "marker")
                      << (run.recorded->stopped ? " lost: the recording had stopped\n"
                                                : " lost: they came too fast or were too many\n");
    }
    for (const StreamReport& stream : run.streams) std::cout << "  " << sentenceOf(stream) << "\n";
}

void demandWhole(const SessionRun& run)
{
    if (const std::string why = whyStopped(run.summary); !why.empty()) throw CheckFailed(why);
    if (run.unheard > 0) throw CheckFailed(onUnheard(run));
    if (run.recorded && run.recorded->lost > 0)
        throw CheckFailed(run.folder + ": " + counted(run.recorded->lost, "tick") + " lost");
    if (run.recorded && run.recorded->stopped) throw CheckFailed(run.folder + ": " + *run.recorded->stopped);
}

SessionRun runSession(const Scene& scene, const LoadedObject& loaded, const SessionOptions& o, const OnTick& onTick)
{
    demandGood(o);
    const SessionClock clock = optionNamed<SessionClock>("--clock", o.clock);
    Deformation        deformation(loaded.object, scene); // what can fail fails before a folder is made
    const auto         streams = streamsOf(o);
    SessionHand        hand    = handFor(o.hand, scene, loaded.object);
    if (hand.isHeldByPerson() && clock != SessionClock::real)
        throw Error("--hand " + o.hand.hand + ": a person holds it, in real time; omit --clock virtual");

    SessionRun run;
    run.solver = deformation.plateSolver().name();
    run.folder = o.record;
    run.notes  = hand.notes;
    if (scene.patch.theory == Theory::plate) // shells have auto by themselves, and their patches' warnings
        if (std::string why = whyDentWindow(loaded.object, scene.patch); !why.empty())
            run.notes.push_back("the patch window is " + why);
    run.warnings = assumptions(scene, loaded.report);
    for (const auto& more : {warningsOf(scene, loaded.object), hand.warnings})
        run.warnings.insert(run.warnings.end(), more.begin(), more.end());
    const std::atomic<bool>& stop = catchInterrupts();
    waitForHoming(*hand.device, stop);
    const bool        hasClutch = hand.record && clock == SessionClock::real; // a hand without a device has no middle
    std::atomic<bool> isClutched{false};
    auto              markers = markersOf(o, hasClutch ? &isClutched : nullptr);

    const SessionParts parts{
        scene,        loaded.object, o.blind ? deformation.solver() : telling(deformation.solver()),
        *hand.device, hand.frame,    deformation.firstLaw(),
        hand.from};
    const auto recording = recordingOf(o, parts, clock, run.solver);
    if (!o.blind) warn(run.warnings);
    if (!o.blind) say(run.notes);
    if (o.blind && !o.handIsKnown) { // nothing of the object
        warn(hand.warnings);
    }
    std::vector<TickStream*> outlets;
    for (const auto& stream : streams) outlets.push_back(stream.get());
    SessionTap   tap(recording.get(), std::move(outlets));
    const OnTick each = [&](const TickRecord& record) {
        tap.pushWaiting(record);
        if (onTick) onTick(record);
    };
    if (markers)
        markers->listen([&tap](std::string_view text) { tap.mark(text); },
                        [&tap](std::uint64_t lost) { tap.lose(lost); });
    if (markers && markers->hearsKeys()) sayKeys(o, hasClutch);
    run.summary = clock == SessionClock::real ? playLive(o, hand.seconds, parts, tap, onTick, &isClutched, run)
                                              : playVirtual(parts, hand.seconds, each, &stop);
    markers.reset();
    if (recording) run.recorded = recording->finish();
    for (const auto& stream : streams) run.streams.push_back(stream->finish());
    run.solver      = deformation.plateSolver().name();
    run.takeover    = deformation.plateSolver().takeoverSince(0);
    run.hand        = hand.device->info().model;
    run.interrupted = stop;
    auto after      = warningsOf(run.summary);
    if (run.unheard > 0) after.push_back(onUnheard(run));
    if (!o.blind) warn(after);
    run.warnings.insert(run.warnings.end(), after.begin(), after.end());
    return run;
}

void demandGood(const SessionOptions& options)
{
    const auto clock   = optionNamed<SessionClock>("--clock", options.clock);
    const auto threads = optionNamed<SessionThreads>("--threads", options.threads);
    if (threads == SessionThreads::paper && clock != SessionClock::real)
        throw Error("--threads paper: a virtual clock has no threads; omit one of the two");
    if (options.markers.empty()) return;
    static_cast<void>(markerAddress(options.markers));
    if (options.record.empty() && options.streams.empty())
        throw Error("--markers: nothing takes them; add --record FOLDER or --stream");
}

void addStreamOption(CLI::App& command, std::vector<std::string>& outlets)
{
    command
        .add_option("--stream", outlets,
                    "sends each tick to another program at once: udp:HOST:PORT, or lsl or lsl:NAME for a Lab Streaming "
                    "Layer; may be repeated")
        ->allow_extra_args(false);
}

void addOutputOptions(CLI::App& command, SessionOptions& options)
{
    command.add_option("--record", options.record, "a new folder for the session");
    addStreamOption(command, options.streams);
    addMarkersOption(command, options.markers);
}

void addMarkersOption(CLI::App& command, std::string& address)
{
    command.add_option(
        "--markers", address,
        "takes each datagram of text at udp:PORT of this machine, or at udp:HOST:PORT, as a marker of "
        "its moment; keys pressed in the terminal of run and hunt, and F7 in the window, are markers too (with a "
        "device K is its clutch instead)");
}

void addSessionOptions(CLI::App& command, SessionOptions& options)
{
    command
        .add_option("--hand", options.hand.hand,
                    generatedHands() +
                        ": a generated hand about the scene's place; a file of time [s], x, y, z [m], "
                        "and optionally buttons; or a device: " +
                        deviceHands() + " (palpate devices lists those connected; NAME@PATH selects one of several)")
        ->capture_default_str();
    command.add_option("--seconds", options.hand.seconds, "duration [5 s, or a file's own length]");
    addHandOptions(command, options.hand, deviceRecords());
    command
        .add_option("--clock", options.clock,
                    "real: one tick per millisecond; virtual: as fast as possible, with equal results every time")
        ->capture_default_str();
    command
        .add_option("--threads", options.threads,
                    "servo: one thread from the hand to the force; paper: proxy and force on threads of their own")
        ->capture_default_str();
}

} // namespace palp
