#include "engine/tools/cli/session_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include <unistd.h>

#include "engine/core/contract.h"
#include "engine/core/nearest_name.h"
#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/patch_warnings.h"
#include "engine/session/interrupt.h"
#include "engine/session/real_session.h"
#include "engine/session/session_line.h"
#include "engine/session/tick_ring.h"
#include "engine/session/virtual_session.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/scene_source.h"
#include "engine/tools/cli/session_report.h"
#include "engine/tools/study/hunt_scene.h"

namespace palp {
namespace {

/// Returns warnings on variables of the environment that were likely meant for a key.
std::vector<std::string> strangeVariables()
{
    std::vector<std::string> variables, said;
    for (const SceneKey* key : sceneKeysWith(&study::huntKeys())) variables.push_back(variableOf(key->name));
    const std::vector<std::string_view> known(variables.begin(), variables.end());
    for (char** entry = environ; *entry; ++entry) {
        const std::string_view name = std::string_view(*entry).substr(0, std::string_view(*entry).find('='));
        if (!name.starts_with("PALPATE_") || std::ranges::find(known, name) != known.end()) continue;
        if (const auto meant = nearestName(name, known))
            said.push_back("the environment's " + std::string(name) + " is not used; did you mean " +
                           std::string(*meant) + "?");
    }
    return said;
}

/// Returns warnings before touching, from the plate at the scene's place, solved on the host, which needs no GPU.
std::vector<std::string> warningsOf(const Scene& scene, const SoftObject& object)
{
    try {
        const HandPlace place = handPlace(scene, object);
        PlateSolver     host("host");
        const Patch     patch = deform(object, {place.point, place.outward}, scene.patch, host);
        return warnings(patch, scene.patch, 0);
    } catch (const Error& error) { // a hand from a file may work elsewhere
        return {std::string("nothing can be felt at the scene's place: ") + error.what()};
    }
}

/// Shows on a terminal how much of the time has passed, while a participant is told nothing else.
void showTime(Progress& progress, double time, double seconds)
{
    progress.at(std::size_t(std::llround(1000 * time)), std::size_t(std::llround(1000 * seconds)));
}

/// Runs a session in real time, with a line that shows what the hand feels.
SessionSummary playLive(const SessionOptions& o, double seconds, const SessionParts& parts, Recording* recording,
                        const OnTick& also)
{
    const bool           line = isatty(STDERR_FILENO) != 0 && !o.json && !o.blind;
    Progress             progress("touching");
    TickRing<TickRecord> ring(also ? 4096 : 1); // four seconds; from the servo to this thread
    const auto           drain = [&] {
        for (auto samples = ring.front(); !samples.empty(); samples = ring.front()) {
            for (const TickRecord& sample : samples) also(sample);
            ring.pop(samples.size());
        }
    };
    RealSessionSettings settings;
    settings.seconds = seconds;
    settings.threads = *valueNamed<SessionThreads>(o.threads);
    settings.stop    = &catchInterrupts();
    settings.onTick  = [&, heard = bool(also)](const TickRecord& sample) {
        if (recording) recording->push(sample);
        if (heard) static_cast<void>(ring.push(sample)); // a reader that stops for four seconds has a gap
    };
    settings.onView = [&, heard = bool(also)](const SessionView& view) {
        if (heard) drain();
        if (line) showLine(view);
        if (o.blind) showTime(progress, view.sample.time, seconds);
    };
    std::string          warning;
    const SessionSummary summary = runReal(parts, settings, warning);
    if (also) drain();
    if (line) clearLine();
    if (!warning.empty() && !o.blind) warn({warning});
    return summary;
}

SessionClock clockNamed(const std::string& text)
{
    for (const SessionClock clock : {SessionClock::real, SessionClock::virtualTime})
        if (text == name(clock)) return clock;
    throw Error("--clock: expected real or virtual, found \"" + text + "\"");
}

std::unique_ptr<Recording> recordingOf(const SessionOptions& o, const SessionParts& parts, SessionClock clock,
                                       const std::string& solver)
{
    if (o.record.empty()) return nullptr;
    SessionInfo info;
    info.scene    = parts.scene;
    info.versions = {{"palpate", PALPATE_VERSION}, {"compiler", __VERSION__}, {"libraries", PALPATE_LIBRARIES}};
    info.solver   = solver;
    info.clock    = clock;
    info.command  = o.command;
    info.cloud    = fingerprint(parts.object.cloud());
    info.hand     = parts.device.info();
    return std::make_unique<Recording>(o.record, info);
}

} // namespace

void warn(const std::vector<std::string>& sentences)
{
    for (const std::string& sentence : sentences) std::cerr << "palpate: warning: " << sentence << "\n";
}

SessionSummary playVirtual(const SessionParts& parts, double seconds, const OnTick& also, const std::atomic<bool>* stop)
{
    Progress    progress("touching");
    const auto  total = std::size_t(std::llround(1000 * seconds));
    std::size_t done  = 0;
    return runVirtual(
        parts, seconds,
        [&](const TickRecord& sample) {
            if (also) also(sample);
            progress.at(++done, total);
        },
        stop);
}

nlohmann::json jsonOf(const SessionRun& run)
{
    nlohmann::json all = jsonOf(run.summary);
    all["hand"]        = run.hand;
    all["solver"]      = run.solver;
    all["warnings"]    = run.warnings;
    if (run.recorded)
        all["recorded"] = {{"folder", run.folder}, {"samples", run.recorded->samples}, {"lost", run.recorded->lost}};
    return all;
}

void printText(const SessionRun& run)
{
    printText(run.summary, run.solver, run.hand);
    if (run.recorded) std::cout << "  " << run.recorded->samples << " samples in " << run.folder << "\n";
}

void demandWhole(const SessionRun& run)
{
    if (run.summary.fault != GovernorFault::none || run.summary.deviceFault == DeviceFault::unplugged)
        throw CheckFailed("the force was stopped");
    if (run.recorded && run.recorded->lost > 0)
        throw CheckFailed(run.folder + ": " + std::to_string(run.recorded->lost) + " samples were lost");
}

SessionRun runSession(const Scene& scene, const LoadedObject& loaded, const SessionOptions& o, const OnTick& onTick)
{
    demandGood(o);
    const SessionClock clock = clockNamed(o.clock);
    Deformation        deformation(loaded.object, scene); // what can fail fails before a folder is made
    SessionHand        hand = handFor(o.hand, scene, loaded.object);
    if (hand.isHeldByPerson() && clock != SessionClock::real)
        throw Error("--hand " + o.hand.hand + ": a person holds it, in real time; omit --clock virtual");

    SessionRun run;
    run.solver   = deformation.plateSolver().name();
    run.folder   = o.record;
    run.warnings = assumptions(scene, loaded.report);
    for (const auto& more : {strangeVariables(), warningsOf(scene, loaded.object), hand.warnings})
        run.warnings.insert(run.warnings.end(), more.begin(), more.end());
    const std::atomic<bool>& stop = catchInterrupts();
    waitForHoming(*hand.device, stop);

    const SessionParts parts{scene, loaded.object, deformation.solver(), *hand.device, hand.frame};
    const auto         recording = recordingOf(o, parts, clock, run.solver);
    if (!o.blind) warn(run.warnings);
    const OnTick each = [&](const TickRecord& sample) {
        if (recording) recording->pushWaiting(sample);
        if (onTick) onTick(sample);
    };
    run.summary = clock == SessionClock::real ? playLive(o, hand.seconds, parts, recording.get(), onTick)
                                              : playVirtual(parts, hand.seconds, each, &stop);
    if (recording) run.recorded = recording->finish();
    run.hand         = hand.device->info().model;
    run.interrupted  = stop;
    const auto after = warningsOf(run.summary);
    if (!o.blind) warn(after);
    run.warnings.insert(run.warnings.end(), after.begin(), after.end());
    return run;
}

void demandGood(const SessionOptions& options)
{
    const SessionClock clock   = clockNamed(options.clock);
    const auto         threads = valueNamed<SessionThreads>(options.threads);
    if (!threads)
        throw Error("--threads: expected " + wordsOf<SessionThreads>() + ", found \"" + options.threads + "\"");
    if (*threads == SessionThreads::paper && clock != SessionClock::real)
        throw Error("--threads paper: a virtual clock has no threads; omit one of the two");
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
