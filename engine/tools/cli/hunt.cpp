#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/session/recorded_session.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/hunt_report.h"
#include "engine/tools/cli/scene_source.h"
#include "engine/tools/cli/session_run.h"
#include "engine/tools/study/hunt_picture.h"

// palpate hunt: a hand looks for hidden nodules, and its search is scored.

namespace palp {
namespace {

constexpr const char* kDefaultScene = "samples/scenes/nodule_hunt.json";

struct HuntOptions {
    SceneSource    scene{kDefaultScene, {}};
    SessionOptions session;
    std::string    score, out;
    bool           json = false;
};

void draw(const HuntOptions& o, const Scene& scene, const SoftObject& object, const study::HuntScore& score)
{
    if (o.out.empty()) return;
    const HandPlace   place = handPlace(scene, object);
    const std::string svg =
        study::huntSvg(score, object.cloud(), place.point, place.outward, study::hiddenIn(scene)->hunt.ground);
    writeFileWhole(o.out, [&](std::ostream& file) { file << svg; });
}

void tell(const HuntOptions& o, const Scene& scene, const SoftObject& object, const study::HuntScore& score,
          const std::optional<SessionRun>& run)
{
    draw(o, scene, object, score);
    if (o.json) {
        nlohmann::json all = jsonOf(score);
        if (run) all["session"] = jsonOf(*run);
        std::cout << jsonText(all);
        return;
    }
    if (run) printText(*run);
    printText(score, study::hiddenIn(scene)->hunt);
}

/// Checks that the default scene exists, which only a checkout has.
void demandScene(const HuntOptions& o)
{
    if (o.scene.name == kDefaultScene && !std::filesystem::exists(kDefaultScene))
        throw Error(
            std::string("SCENE: ") + kDefaultScene +
            " was not found here; name a scene file with a \"hunt\", or run the command from Palpate's checkout");
}

/// Scores a recorded session.
void scoreRecorded(const HuntOptions& o)
{
    const RecordedSession session = readSession(o.score);
    const Scene           scene   = sceneOf(session, &study::huntKeys());
    const SoftObject      object  = loadObject(scene).object;
    study::HuntScorer     scorer(scene, object.cloud());
    if (!session.whyIncomplete.empty()) warn({o.score + " is not complete: " + session.whyIncomplete});
    warn(session.doubts);
    if (!session.cloud.empty() && session.cloud != fingerprint(object.cloud()))
        throw Error(o.score + ": expected the cloud of the recording, found another one: " + scene.cloud +
                    " has changed");
    for (const TickRecord& record : session.records) scorer.add(record);
    tell(o, scene, object, scorer.score(), {});
}

void hunt(HuntOptions o)
{
    demandSvg("--out", o.out);
    if (!o.score.empty()) return scoreRecorded(o);
    demandGood(o.session);
    demandScene(o);
    const Scene scene = o.scene.load();
    refuseSourcesAsTarget(o.scene, scene, "--out", o.out);
    const LoadedObject loaded           = o.scene.loadObject(scene);
    o.session.hand.metresPerPlainNumber = metresPerPlainNumber(o.scene, scene);
    study::HuntScorer scorer(scene, loaded.object.cloud());
    const SessionRun  run = runSession(scene, loaded, o.session, [&](const TickRecord& record) { scorer.add(record); });
    tell(o, scene, loaded.object, scorer.score(), run);
    demandWhole(run);
}

} // namespace

void addHuntCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("hunt", "scores a hand's search for hidden nodules");
    const auto o       = std::make_shared<HuntOptions>();
    o->scene.addTo(*command, SceneKey::Group::session);
    command->add_option("--score", o->score, "folder of a recorded session, which is scored without touching anything")
        ->excludes(command->get_option("SCENE"));
    addSessionOptions(*command, o->session);
    addOutputOptions(*command, o->session);
    command->add_option("--out", o->out, "a picture from above of hidden, found, missed and declared places (.svg)");
    command->add_flag("--json", o->json, "machine-readable, SI units");
    command->footer(
        "A button of the device, held for 20 ms, declares the touched place. In a hand's file the column \"buttons\"\n"
        "does. Without a device use palpate view SCENE, where M declares.\n"
        "Examples:\n"
        "  palpate hunt samples/scenes/nodule_hunt.json --hand falcon --seconds 60 --hunt-seed 7 --out hunt.svg\n"
        "  palpate hunt samples/scenes/nodule_hunt.json --hand samples/scenes/nodule_hunt_hand.csv --clock "
        "virtual\n"
        "  palpate hunt --score session --json");
    command->callback([command, o] {
        o->session.command = commandOf(*command);
        o->session.json    = o->json;
        allowOnlyWith(*command, "--score", {"--out", "--json"});
        hunt(*o);
    });
}

} // namespace palp
