#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/session/recorded_session.h"
#include "engine/session/replay_device.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/scene_source.h"
#include "engine/tools/cli/session_report.h"
#include "engine/tools/cli/session_run.h"
#include "engine/tools/cli/solver_choice.h"
#include "engine/tools/study/hunt_scene.h"

// palpate run and palpate replay: a hand feels a scene, and a recorded session is computed again.

namespace palp {
namespace {

struct RunOptions {
    SceneSource    scene;
    SessionOptions session;
    bool           printConfig = false, json = false;
};

struct ReplayOptions {
    std::string folder, solver;
    bool        compare = false, json = false;
};

void run(RunOptions o)
{
    const Scene scene                   = o.scene.load();
    o.session.hand.metresPerPlainNumber = metresPerPlainNumber(o.scene, scene);
    demandGood(o.session);
    if (o.printConfig) {
        warn(unusedVariables());
        std::cout << printConfig(scene, o.json ? ConfigFormat::json : ConfigFormat::text);
        return;
    }
    const LoadedObject loaded = o.scene.loadObject(scene);
    warn(huntNote(scene, loaded.object.cloud()));
    const SessionRun run = runSession(scene, loaded, o.session);
    if (o.json)
        std::cout << jsonText(jsonOf(run));
    else
        printText(run);
    demandWhole(run);
}

void replay(const ReplayOptions& o)
{
    const RecordedSession session = readSession(o.folder);
    if (session.clock != SessionClock::virtualTime)
        throw Error(o.folder + ": recorded in real time, which no replay can repeat; expected clock \"virtual\"");
    Scene scene  = sceneOf(session, &study::huntKeys());
    scene.solver = o.solver.empty() ? session.solver : o.solver;
    if (session.records.empty()) throw Error(o.folder + ": it has no ticks, so there is nothing to replay");
    if (!session.whyIncomplete.empty())
        warn({o.folder + " is not complete: " + session.whyIncomplete + "; what it has is replayed, " +
              counted(session.records.size(), "tick")});
    warn(session.doubts);
    const SoftObject object = loadObject(scene).object;
    if (!session.cloud.empty() && session.cloud != fingerprint(object.cloud()))
        warn({"the cloud is not the recorded one: " + scene.cloud + " has changed"});
    Deformation deformation(object, scene);

    RecordedSession again = session;
    again.folder          = "the replay";
    again.records.clear();
    const double         seconds = double(session.records.size()) * 1e-3;
    ReplayDevice         hand(session.records, session.hand);
    const SessionSummary summary =
        playVirtual({scene, object, deformation.solver(), hand, {}, deformation.firstLaw(), session.from}, seconds,
                    [&](const TickRecord& record) { again.records.push_back(record); });
    const std::string takeover = deformation.plateSolver().takeoverSince(0);
    sayTakeover(takeover);
    if (!o.compare) {
        nlohmann::json all = jsonOf(summary);
        all["takeover"]    = orNull(takeover);
        o.json ? void(std::cout << jsonText(all))
                  : printText(summary, deformation.plateSolver().name(), hand.info().model);
        return;
    }
    const auto difference = compareSessions(session, again);
    const auto sentence   = difference ? describe(*difference, session, again) : "all ticks are equal to the bit";
    if (o.json) // "samples" is the word of session.json
        std::cout << jsonText(nlohmann::json{{"equal", !difference},
                                             {"samples", again.records.size()},
                                             {"takeover", orNull(takeover)},
                                             {"says", sentence}});
    else
        std::cout << counted(again.records.size(), "tick") << ": " << sentence << "\n";
    if (difference) throw CheckFailed(sentence);
}

} // namespace

void addRunCommand(CLI::App& app)
{
    auto* run_ = app.add_subcommand("run", "touches a scene with a hand, in real or virtual time");
    auto  o    = std::make_shared<RunOptions>();
    addSessionOptions(*run_, o->session);
    addOutputOptions(*run_, o->session);
    run_->add_flag("--print-config", o->printConfig,
                   "prints every value of the scene and its source, and touches nothing");
    run_->add_flag("--json", o->json, "machine-readable");
    o->scene.addTo(*run_, SceneKey::Group::session);
    run_->footer("Examples:\n"
                 "  palpate run samples/scenes/palm_wart.json --hand scan --seconds 5\n"
                 "  palpate run samples/scenes/palm_wart.json --clock virtual --record session --max-force '4 N'\n"
                 "  palpate run samples/scenes/palm_wart.json --record session --markers udp:9871 --stream "
                 "udp:127.0.0.1:9870\n"
                 "  palpate run scan.ply --length-unit mm --stiffness-property quality --stiffness-range 20kPa,2MPa\n"
                 "  palpate run samples/scenes/skin_wart.json --print-config");
    run_->callback([run_, o] {
        std::vector<std::string> ofScenes{"SCENE", "--flat", "--json"};
        for (const SceneKey* key : sceneKeysWith(&study::huntKeys())) ofScenes.push_back(flagOf(key->name));
        allowOnlyWith(*run_, "--print-config", ofScenes);
        o->session.command = commandOf(*run_);
        o->session.json    = o->json;
        run(*o);
    });

    auto* again = app.add_subcommand("replay", "computes a recorded session again");
    auto  r     = std::make_shared<ReplayOptions>();
    again->add_option("DIR", r->folder, "folder of a session that was recorded in virtual time")->required();
    again->add_option("--solver", r->solver, "where the plate is solved [as in the session]");
    again->add_flag("--compare", r->compare,
                    "compares both sessions; exit code 1 and the first tick that differs, if one does");
    again->add_flag("--json", r->json, "machine-readable");
    again->footer("Examples:\n  palpate replay session --compare\n  palpate replay session --json");
    again->callback([r] { replay(*r); });
}

} // namespace palp
