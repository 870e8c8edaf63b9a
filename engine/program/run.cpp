#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "engine/core/contract.h"
#include "engine/core/nearest_name.h"
#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/program/commands.h"
#include "engine/program/hand_source.h"
#include "engine/program/interrupt.h"
#include "engine/program/scene_source.h"
#include "engine/program/session_report.h"
#include "engine/session/real_session.h"
#include "engine/session/recorded_session.h"
#include "engine/session/recording.h"
#include "engine/session/replay_device.h"
#include "engine/session/virtual_session.h"

// palpate run and palpate replay: a hand feels a scene, and a recorded session is felt again.

namespace palp {
namespace {

struct RunOptions {
    HandOptions                                     hand;
    std::string                                     scene, record, clock = "real", threads = "servo";
    std::map<std::string, std::string, std::less<>> flags;   ///< of the scene's keys, as given
    std::string                                     command; ///< as a shell would take it again
    bool                                            printConfig = false, json = false;
};

struct ReplayOptions {
    std::string folder, device;
    bool        compare = false, json = false;
};

/// Plays the hand through the scene, with a line on a terminal and a recording if one is wanted.
/// \param stop  ends it once it is true; may be null
SessionSummary play(const SessionParts& parts, double seconds, const OnSample& also,
                    const std::atomic<bool>* stop = nullptr)
{
    Progress    progress("touching");
    const auto  total = std::size_t(std::llround(1000 * seconds));
    std::size_t done  = 0;
    return runVirtual(
        parts, seconds,
        [&](const SessionSample& sample) {
            if (also) also(sample);
            progress.at(++done, total);
        },
        stop);
}

void warn(const std::vector<std::string>& sentences)
{
    for (const std::string& sentence : sentences) std::cerr << "palpate: warning: " << sentence << "\n";
}

/// Variables of the environment that were likely meant for a key.
std::vector<std::string> strangeVariables()
{
    std::vector<std::string> variables, said;
    for (const SceneKey& key : sceneKeys()) variables.push_back(variableOf(key.name));
    const std::vector<std::string_view> known(variables.begin(), variables.end());
    for (char** entry = environ; *entry; ++entry) {
        const std::string_view name = std::string_view(*entry).substr(0, std::string_view(*entry).find('='));
        if (!name.starts_with("PALPATE_") || std::ranges::find(known, name) != known.end()) continue;
        if (const auto meant = nearestName(name, known))
            said.push_back("the environment's " + std::string(name) + " says nothing; did you mean " +
                           std::string(*meant) + "?");
    }
    return said;
}

/// What one must know before touching: the plate at the scene's place, on the host, which needs no device.
std::vector<std::string> warningsOf(const Scene& scene, const PointCloud& cloud, const NeighbourIndex& index)
{
    try {
        const HandPlace place = handPlace(scene, cloud, index);
        PlateDevice     host("host");
        const Patch     patch = deform(cloud, index, {place.point, place.outward}, scene.patch, host);
        return warnings(patch, scene.patch, 0);
    } catch (const Error& error) { // a hand from a file may work elsewhere
        return {std::string("at the scene's place nothing can be felt: ") + error.what()};
    }
}

/// One line that is written over and over: what the hand feels, and how fast.
void showLine(const SessionView& view)
{
    const SessionSample& s     = view.sample;
    const auto           fault = static_cast<GovernorFault>(s.faults & 0xFFU);
    const bool           stale = (s.faults & static_cast<std::uint32_t>(SessionFlag::stalePatch)) != 0;
    std::fprintf(stderr, "\r%6.1f s  %8s  %8s deep  a tick every %8s  a patch in %8s%s%s%s\033[K", s.time,
                 formatQuantity(glm::length(s.force), "N").c_str(),
                 formatQuantity(glm::length(s.proxy - s.hip), "m").c_str(),
                 formatQuantity(view.loopPeriod, "s").c_str(), formatQuantity(view.solveTime, "s").c_str(),
                 stale ? "  stale" : "", fault == GovernorFault::none ? "" : "  no force, button 0 resets: ",
                 fault == GovernorFault::none ? "" : name(fault));
}

/// The same in real time; the line shows what the hand feels.
SessionSummary playLive(const RunOptions& o, double seconds, SessionThreads threads, const SessionParts& parts,
                        Recording* recording)
{
    const bool          line = isatty(STDERR_FILENO) != 0 && !o.json;
    RealSessionSettings settings;
    settings.seconds = seconds;
    settings.threads = threads;
    settings.stop    = &catchInterrupts();
    if (recording) settings.onSample = [recording](const SessionSample& sample) { recording->push(sample); };
    if (line) settings.onView = showLine;
    std::string          warning;
    const SessionSummary summary = runReal(parts, settings, warning);
    if (line) std::fprintf(stderr, "\r\033[K");
    if (!warning.empty()) warn({warning});
    return summary;
}

SessionClock clockNamed(const std::string& text)
{
    for (const SessionClock clock : {SessionClock::real, SessionClock::virtualTime})
        if (text == name(clock)) return clock;
    throw Error("--clock: expected real or virtual, found \"" + text + "\"");
}

SessionThreads threadsOf(const RunOptions& o, SessionClock clock)
{
    const auto threads = sessionThreadsNamed(o.threads);
    if (!threads) throw Error("--threads: expected servo or paper, found \"" + o.threads + "\"");
    if (*threads == SessionThreads::paper && clock != SessionClock::real)
        throw Error("--threads paper: a virtual clock has no threads; leave one of the two out");
    return *threads;
}

std::unique_ptr<Recording> recordingOf(const RunOptions& o, const SessionParts& parts, SessionClock clock,
                                       const std::string& device)
{
    if (o.record.empty()) return nullptr;
    SessionInfo info;
    info.scene    = parts.scene;
    info.versions = {{"palpate", PALPATE_VERSION}, {"compiler", __VERSION__}, {"libraries", PALPATE_LIBRARIES}};
    info.device   = device;
    info.clock    = clock;
    info.command  = o.command;
    info.cloud    = fingerprint(parts.cloud);
    info.hand     = parts.device.info();
    return std::make_unique<Recording>(o.record, info);
}

/// Prints what happened. \throws CheckFailed if the force was stopped, or samples are missing in the recording
void tell(const RunOptions& o, const SessionSummary& summary, const std::string& device, const std::string& hand,
          std::vector<std::string> known, const std::optional<RecordingReport>& report)
{
    const auto after = warningsOf(summary);
    warn(after);
    if (o.json) {
        known.insert(known.end(), after.begin(), after.end());
        nlohmann::json all = jsonOf(summary);
        all["hand"]        = hand;
        all["device"]      = device;
        all["warnings"]    = known;
        if (report) all["recorded"] = {{"folder", o.record}, {"samples", report->samples}, {"lost", report->lost}};
        std::cout << jsonText(all);
    } else {
        printText(summary, device, hand);
        if (report) std::cout << "  " << report->samples << " samples in " << o.record << "\n";
    }
    if (summary.fault != GovernorFault::none || summary.deviceFault == DeviceFault::unplugged)
        throw CheckFailed("the force was stopped");
    if (report && report->lost > 0)
        throw CheckFailed(o.record + ": " + std::to_string(report->lost) + " samples were lost");
}

void run(const RunOptions& o)
{
    const SceneOverrides overrides{o.flags, processEnvironment()};
    const Scene          scene   = readScene(o.scene, overrides);
    const SessionClock   clock   = clockNamed(o.clock);
    const SessionThreads threads = threadsOf(o, clock);
    if (o.printConfig) {
        std::cout << printConfig(scene, o.json ? ConfigFormat::json : ConfigFormat::text);
        return;
    }
    const LoadedCloud    cloud = loadCloud(scene);
    const NeighbourIndex index(cloud.cloud.positions());
    Deformation          deformation(cloud.cloud, index, scene); // what can fail fails before a folder is made
    const std::string    device = deformation.device().name();
    HandSource           hand   = handFor(o.hand, scene, cloud.cloud, index);
    if (hand.isHeld() && clock != SessionClock::real)
        throw Error("--hand " + o.hand.hand + ": somebody holds it, in real time; leave out --clock virtual");

    std::vector<std::string> known = assumptions(scene, cloud.report);
    for (const auto& more : {strangeVariables(), warningsOf(scene, cloud.cloud, index), hand.warnings})
        known.insert(known.end(), more.begin(), more.end());
    const std::atomic<bool>& stop = catchInterrupts();
    waitForHoming(*hand.device, stop);

    const SessionParts parts{scene, cloud.cloud, index, deformation.solver(), *hand.device, hand.frame};
    const auto         recording = recordingOf(o, parts, clock, device);
    warn(known);
    const OnSample record = [&](const SessionSample& sample) {
        if (recording) recording->pushWaiting(sample);
    };
    const auto summary = clock == SessionClock::real ? playLive(o, hand.seconds, threads, parts, recording.get())
                                                     : play(parts, hand.seconds, record, &stop);
    std::optional<RecordingReport> report;
    if (recording) report = recording->finish();
    tell(o, summary, device, hand.device->info().model, known, report);
}

void replay(const ReplayOptions& o)
{
    const RecordedSession session = readSession(o.folder);
    if (session.clock != "virtual")
        throw Error(o.folder + ": recorded in real time, which no replay can repeat; expected clock \"virtual\"");
    Scene scene  = sceneOf(session);
    scene.device = o.device.empty() ? session.device : o.device;
    if (session.samples.empty()) throw Error(o.folder + ": there are no samples in it, so there is nothing to replay");
    if (!session.finished)
        warn({o.folder + " was not finished: its first " + std::to_string(session.samples.size()) +
              " samples are replayed"});
    const LoadedCloud cloud = loadCloud(scene);
    if (!session.cloud.empty() && session.cloud != fingerprint(cloud.cloud))
        warn({"the cloud is not the one that was recorded: " + scene.cloud + " has changed"});
    const NeighbourIndex index(cloud.cloud.positions());
    Deformation          deformation(cloud.cloud, index, scene);

    RecordedSession again = session;
    again.folder          = "the replay";
    again.samples.clear();
    const double         seconds = double(session.samples.size()) * 1e-3;
    ReplayDevice         hand(session.samples, session.hand);
    const SessionSummary summary = play({scene, cloud.cloud, index, deformation.solver(), hand, {}}, seconds,
                                        [&](const SessionSample& sample) { again.samples.push_back(sample); });
    if (!o.compare) {
        o.json ? void(std::cout << jsonText(jsonOf(summary)))
               : printText(summary, deformation.device().name(), hand.info().model);
        return;
    }
    const auto difference = compareSessions(session, again);
    const auto sentence   = difference ? describe(*difference, session, again) : "all samples are equal to the bit";
    if (o.json)
        std::cout << jsonText(
            nlohmann::json{{"equal", !difference}, {"samples", again.samples.size()}, {"says", sentence}});
    else
        std::cout << again.samples.size() << " samples: " << sentence << "\n";
    if (difference) throw CheckFailed(sentence);
}

} // namespace

void addRunCommand(CLI::App& app)
{
    auto* run_ = app.add_subcommand("run", "a hand feels a scene");
    auto  o    = std::make_shared<RunOptions>();
    run_->add_option("SCENE", o->scene, "scene file, see samples/scenes")->required();
    run_->add_option("--hand", o->hand.hand,
                     "press, circle or scan about the scene's place; a file of time [s], x, y, z [m]; or a device: "
                     "falcon, bridge, spacemouse, arm, falcon-emulator (palpate devices tells which are there; of "
                     "several, falcon@PATH)")
        ->capture_default_str();
    run_->add_option("--seconds", o->hand.seconds, "how long [5 s; a file's own length]");
    run_->add_option("--speed", o->hand.speed, "of press, circle and scan, at most")->capture_default_str();
    run_->add_option("--press-depth", o->hand.depth,
                     "of the hand below the surface [40 % of the thickness, within plate theory]");
    run_->add_option("--reach", o->hand.reach, "radius of the circle, half the length of the scan")
        ->capture_default_str();
    run_->add_option(
        "--arm", o->hand.grip,
        "the hand holds a simulated arm with a grip of this stiffness (relaxed '150 N/m', firm '500 N/m'), "
        "so that forces move it");
    addFalconOptions(*run_, o->hand.falcon);
    run_->add_option("--clock", o->clock,
                     "real: a tick a millisecond; virtual: as fast as it goes, the same every time")
        ->capture_default_str();
    run_->add_option("--threads", o->threads,
                     "servo: one thread from the hand to the force; paper: proxy and force on threads of their own")
        ->capture_default_str();
    run_->add_option("--record", o->record, "a new folder for the session");
    run_->add_flag("--print-config", o->printConfig,
                   "every value of the scene, with where it came from, and nothing else");
    run_->add_flag("--json", o->json, "machine-readable");
    for (const SceneKey& key : sceneKeys())
        run_->add_option_function<std::string>(
                flagOf(key.name), [o, name = std::string(key.name)](const std::string& text) { o->flags[name] = text; },
                std::string(key.means) + (key.unit.empty() ? "" : " [" + std::string(key.unit) + "]"))
            ->group("Values of the scene (over PALPATE_<KEY> and the file)");
    run_->footer("Examples:\n"
                 "  palpate run samples/scenes/palm_wart.json --hand scan --seconds 5\n"
                 "  palpate run samples/scenes/palm_wart.json --clock virtual --record session --max-force '4 N'\n"
                 "  palpate run samples/scenes/skin_wart.json --print-config");
    run_->callback([run_, o] {
        refuseEmptyValues(*run_);
        o->command = commandOf(*run_);
        run(*o);
    });

    auto* again = app.add_subcommand("replay", "a recorded session is felt again");
    auto  r     = std::make_shared<ReplayOptions>();
    again->add_option("DIR", r->folder, "folder of a session that was recorded in virtual time")->required();
    again->add_option("--device", r->device, "where the plate is solved; the session's if absent");
    again->add_flag("--compare", r->compare, "exit code 1 and the first sample that differs, if one does");
    again->add_flag("--json", r->json, "machine-readable");
    again->footer("Examples:\n  palpate replay session --compare\n  palpate replay session --json");
    again->callback([again, r] {
        refuseEmptyValues(*again);
        replay(*r);
    });
}

} // namespace palp
