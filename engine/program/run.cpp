#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "engine/core/contract.h"
#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/program/commands.h"
#include "engine/program/hand_source.h"
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
    std::map<std::string, std::string, std::less<>> flags; ///< of the scene's keys, as given
    bool                                            printConfig = false, json = false;
};

struct ReplayOptions {
    std::string folder, device;
    bool        compare = false, json = false;
};

nlohmann::json durations(const DurationHistogram& of)
{
    return {{"count", of.count()},
            {"p50_s", of.quantile(0.5)},
            {"p99_s", of.quantile(0.99)},
            {"p99.9_s", of.quantile(0.999)},
            {"max_s", of.most()}};
}

nlohmann::json jsonOf(const SessionSummary& s)
{
    return {{"ticks", s.ticks},
            {"contact_ticks", s.contactTicks},
            {"patches", s.patches},
            {"failed_patches", s.failedPatches},
            {"stale_ticks", s.staleTicks},
            {"ticks_beyond_table", s.beyondTable},
            {"ticks_beyond_theory", s.beyondTheory},
            {"max_force_N", s.mostForce},
            {"max_depth_m", s.mostDepth},
            {"compliance_min_m_per_N", s.leastCompliance},
            {"compliance_max_m_per_N", s.mostCompliance},
            {"fault", name(s.fault)},
            {"device_fault", name(s.deviceFault)},
            {"tick", durations(s.tick)},
            {"period", durations(s.period)},
            {"solve", durations(s.solve)}};
}

void warn(const std::string& sentence)
{
    std::cerr << "palpate: warning: " << sentence << "\n";
}

void printText(const SessionSummary& s, const std::string& device)
{
    const auto seconds = [](double t) { return formatQuantity(t, "s"); };
    std::cout << s.ticks << " ticks, " << s.contactTicks << " in contact; " << s.patches << " patches on " << device
              << "\n";
    if (s.contactTicks > 0)
        std::cout << "  force at most " << formatQuantity(s.mostForce, "N") << ", depth at most "
                  << formatQuantity(s.mostDepth, "m") << ", compliance " << formatQuantity(s.leastCompliance, "m/N")
                  << " to " << formatQuantity(s.mostCompliance, "m/N") << "\n";
    std::cout << "  a tick computes " << seconds(s.tick.quantile(0.5)) << " (p99 " << seconds(s.tick.quantile(0.99))
              << ", p99.9 " << seconds(s.tick.quantile(0.999)) << ", most " << seconds(s.tick.most()) << "), a patch "
              << seconds(s.solve.quantile(0.5)) << " (most " << seconds(s.solve.most()) << ")\n";
    if (s.period.count() > 0)
        std::cout << "  a tick comes every " << seconds(s.period.quantile(0.5)) << " (p99 "
                  << seconds(s.period.quantile(0.99)) << ", p99.9 " << seconds(s.period.quantile(0.999)) << ", most "
                  << seconds(s.period.most()) << ")\n";
    if (s.fault != GovernorFault::none) warn(std::string("the governor stopped the force: ") + name(s.fault));
    if (s.deviceFault != DeviceFault::none) warn(std::string("the device was not well: ") + name(s.deviceFault));
    if (s.beyondTheory > 0)
        warn("the deflection exceeded half the thickness in " + std::to_string(s.beyondTheory) +
             " ticks: Kirchhoff plate theory does not hold there");
    if (s.beyondTable > 0)
        warn("the contact left the table's reach in " + std::to_string(s.beyondTable) +
             " ticks: a larger table_size or deformation_rate follows faster hands");
    if (s.failedPatches > 0) warn(std::to_string(s.failedPatches) + " patches could not be solved: " + s.why);
}

/// Plays the hand through the scene, with a line on a terminal and a recording if one is wanted.
SessionSummary play(const SessionParts& parts, double seconds, const OnSample& also)
{
    Progress    progress("touching");
    const auto  total = std::size_t(std::llround(1000 * seconds));
    std::size_t done  = 0;
    return runVirtual(parts, seconds, [&](const SessionSample& sample) {
        if (also) also(sample);
        progress.at(++done, total);
    });
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

/// Ctrl-C ends the session in order: zero force, a recording that is complete. A second one ends the program.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

void onInterrupt(int signal)
{
    interrupted = true;
    std::signal(signal, SIG_DFL);
}

/// One line that is written over and over: what the hand feels, and how fast.
void showLine(const SessionView& view)
{
    const SessionSample& s = view.sample;
    std::fprintf(stderr, "\r%6.1f s  %8s  %8s deep  a tick every %8s  a patch in %8s\033[K", s.time,
                 formatQuantity(glm::length(s.force), "N").c_str(),
                 formatQuantity(glm::length(s.proxy - s.hip), "m").c_str(),
                 formatQuantity(view.loopPeriod, "s").c_str(), formatQuantity(view.solveTime, "s").c_str());
}

/// The same in real time; the line shows what the hand feels.
SessionSummary playLive(const RunOptions& o, SessionThreads threads, const SessionParts& parts, Recording* recording)
{
    const bool          line = isatty(STDERR_FILENO) != 0 && !o.json;
    RealSessionSettings settings;
    settings.seconds = o.hand.seconds;
    settings.threads = threads;
    settings.stop    = &interrupted;
    if (recording) settings.onSample = [recording](const SessionSample& sample) { recording->push(sample); };
    if (line) settings.onView = showLine;
    std::string          warning;
    const SessionSummary summary = runReal(parts, settings, warning);
    if (line) std::fprintf(stderr, "\r\033[K");
    if (!warning.empty()) warn(warning);
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

std::unique_ptr<Recording> recordingOf(const RunOptions& o, const Scene& scene, SessionClock clock,
                                       const std::string& device)
{
    if (o.record.empty()) return nullptr;
    SessionInfo info;
    info.scene    = scene;
    info.versions = {{"palpate", PALPATE_VERSION}};
    info.device   = device;
    info.clock    = clock;
    info.command  = "palpate run " + o.scene + " --hand " + o.hand.hand;
    return std::make_unique<Recording>(o.record, info);
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
    if (!(o.hand.seconds > 0 && o.hand.seconds <= 86400))
        throw Error("--seconds: expected a time above 0 and up to 86400");
    const LoadedCloud    cloud = loadCloud(scene);
    const NeighbourIndex index(cloud.cloud.positions());
    Deformation          deformation(cloud.cloud, index, scene); // what can fail fails before a folder is made
    const std::string    device = deformation.device().name();
    const auto           known  = warningsOf(scene, cloud.cloud, index);
    for (const std::string& sentence : known) warn(sentence);
    const HandSource hand = handFor(o.hand, scene, cloud.cloud, index);
    if (hand.isHeld() && clock != SessionClock::real)
        throw Error("--hand " + o.hand.hand + ": somebody holds it, in real time; leave out --clock virtual");
    std::signal(SIGINT, onInterrupt);
    std::signal(SIGTERM, onInterrupt);
    waitForHoming(*hand.device, interrupted);
    const SessionParts             parts{scene, cloud.cloud, index, deformation.solver(), *hand.device, hand.frame};
    const auto                     recording = recordingOf(o, scene, clock, device);
    const SessionSummary           summary   = clock == SessionClock::real
                                                   ? playLive(o, threads, parts, recording.get())
                                                   : play(parts, o.hand.seconds, [&](const SessionSample& sample) {
                                             if (recording) recording->pushWaiting(sample);
                                         });
    std::optional<RecordingReport> report;
    if (recording) report = recording->finish();
    if (o.json) {
        nlohmann::json all = jsonOf(summary);
        all["warnings"]    = known;
        if (report) all["recorded"] = {{"folder", o.record}, {"samples", report->samples}, {"lost", report->lost}};
        std::cout << jsonText(all);
        return;
    }
    printText(summary, device);
    if (report) std::cout << "  " << report->samples << " samples in " << o.record << "\n";
}

void replay(const ReplayOptions& o)
{
    const RecordedSession session = readSession(o.folder);
    if (session.clock != "virtual")
        throw Error(o.folder + ": recorded in real time, which no replay can repeat; expected clock \"virtual\"");
    Scene scene = sceneOf(session);
    if (!o.device.empty()) scene.device = o.device;
    const LoadedCloud    cloud = loadCloud(scene);
    const NeighbourIndex index(cloud.cloud.positions());
    Deformation          deformation(cloud.cloud, index, scene);

    RecordedSession again = session;
    again.folder          = "the replay";
    again.samples.clear();
    const double         seconds = double(session.samples.size()) * 1e-3;
    ReplayDevice         hand(session.samples);
    const SessionSummary summary = play({scene, cloud.cloud, index, deformation.solver(), hand, {}}, seconds,
                                        [&](const SessionSample& sample) { again.samples.push_back(sample); });
    if (!o.compare) {
        o.json ? void(std::cout << jsonText(jsonOf(summary))) : printText(summary, deformation.device().name());
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
                     "falcon, bridge, spacemouse, arm, falcon-emulator (palpate devices tells which there are)")
        ->capture_default_str();
    run_->add_option("--seconds", o->hand.seconds, "how long")->capture_default_str();
    run_->add_option("--speed", o->hand.speed, "of press, circle and scan, at most")->capture_default_str();
    run_->add_option("--press-depth", o->hand.depth,
                     "of the hand below the surface [40 % of the thickness, within plate theory]");
    run_->add_option("--reach", o->hand.reach, "radius of the circle, half the length of the scan")
        ->capture_default_str();
    run_->add_option(
        "--arm", o->hand.grip,
        "the hand holds a simulated arm with a grip of this stiffness (relaxed '150 N/m', firm '500 N/m'), "
        "so that forces move it");
    run_->add_option("--falcon-firmware", o->hand.firmware,
                     "image that a Falcon needs after it was plugged in [FALCON_FIRMWARE]");
    run_->add_option("--falcon-counts", o->hand.countsPerTorque,
                     "counts per N m of a Falcon's motors, see palpate calibrate")
        ->capture_default_str()
        ->check(CLI::Range(500.0, 50000.0));
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
