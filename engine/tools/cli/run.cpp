#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/session/recorded_session.h"
#include "engine/session/replay_device.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/session_report.h"
#include "engine/tools/cli/session_run.h"

// palpate run and palpate replay: a hand feels a scene, and a recorded session is felt again.

namespace palp {
namespace {

struct RunOptions {
    SessionOptions                                  session;
    std::string                                     scene;
    std::map<std::string, std::string, std::less<>> flags; ///< of the scene's keys, as given
    bool                                            printConfig = false, json = false;
};

struct ReplayOptions {
    std::string folder, device;
    bool        compare = false, json = false;
};

void run(const RunOptions& o)
{
    const Scene scene = readScene(o.scene, {o.flags, processEnvironment()});
    demandGood(o.session);
    if (o.printConfig) {
        std::cout << printConfig(scene, o.json ? ConfigFormat::json : ConfigFormat::text);
        return;
    }
    const SessionRun run = runSession(scene, loadObject(scene), o.session);
    if (o.json)
        std::cout << jsonText(jsonOf(run));
    else
        printText(run);
    demandWhole(run);
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
    const SoftObject object = loadObject(scene).object;
    if (!session.cloud.empty() && session.cloud != fingerprint(object.cloud()))
        warn({"the cloud is not the one that was recorded: " + scene.cloud + " has changed"});
    Deformation deformation(object, scene);

    RecordedSession again = session;
    again.folder          = "the replay";
    again.samples.clear();
    const double         seconds = double(session.samples.size()) * 1e-3;
    ReplayDevice         hand(session.samples, session.hand);
    const SessionSummary summary = playVirtual({scene, object, deformation.solver(), hand, {}}, seconds,
                                               [&](const TickRecord& sample) { again.samples.push_back(sample); });
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
    addSessionOptions(*run_, o->session);
    run_->add_option("--record", o->session.record, "a new folder for the session");
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
        o->session.command = commandOf(*run_);
        o->session.json    = o->json;
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
