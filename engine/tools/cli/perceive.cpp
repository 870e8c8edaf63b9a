#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/perception/scene_perception.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/hand_source.h"
#include "engine/tools/cli/scene_source.h"
#include "engine/tools/cli/solver_choice.h"
#include "engine/tools/paper/perception_figures.h"
#include "engine/tools/paper/section.h"

// palpate perceive: predicts what a person would notice of an object's stiffness.

namespace palp {
namespace {

using namespace report;

struct PerceiveOptions {
    SceneSource scene;
    std::string along, reach, out, picture;
    int         places = 41, mapPlaces = 500;
    bool        json = false;
};

/// The scene's object, made once.
struct Felt {
    explicit Felt(const PerceiveOptions& o)
        : scene(o.scene.load()), loaded(o.scene.loadObject(scene)), object(loaded.object),
          solver(openSolver(scene.solver)), told(solver.counts().takeovers)
    {
        scene.patch = settledFor(object, scene.patch);
        warn(cloudWarnings(scene, object.cloud(), loaded.report), said);
    }
    Scene             scene;
    LoadedObject      loaded;
    const SoftObject& object;
    PlateSolver       solver;
    int               told; ///< takeovers, see sayTakeovers()

    std::string              takeover{};
    std::vector<std::string> said{}; ///< warnings
};

/// Returns the length of the path to either side of the middle [m].
double eachSide(const PerceiveOptions& o, const Scene& scene, const SoftObject& object)
{
    constexpr double kShare = 1.0 / 3; // of what bends, beyond which the middle is not felt [1]
    return o.reach.empty() ? kShare * bentSize(object, scene.patch)
                           : reachOf(o.reach, metresPerPlainNumber(o.scene, scene));
}

void write(const std::string& file, const std::string& text)
{
    writeFileWhole(file, [&](std::ostream& stream) { stream << text; });
}

nlohmann::ordered_json jsonOf(const std::array<NoticedSteps, 3>& noticed)
{
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const NoticedSteps& n : noticed)
        rows.push_back({{"weber_fraction", n.weber},
                        {"steps", n.whole},
                        {"steps_in_passing", n.passing},
                        {"floor", n.floor},
                        {"right_answers", n.right}});
    return rows;
}

nlohmann::ordered_json jsonOf(const PerceiveOptions& o, const Felt& felt, const ScenePerception& p,
                              const std::optional<FeltMap>& map)
{
    nlohmann::ordered_json all;
    all["scene"]      = o.scene.name;
    all["prediction"] = true;
    all["force_law"]  = name(felt.scene.patch.forceLaw);
    all["solved_on"]  = felt.solver.name();
    all["takeover"]   = orNull(felt.takeover);
    all["path"]       = {{"middle", {p.line.middle.point.x, p.line.middle.point.y, p.line.middle.point.z}},
                         {"direction", {p.line.direction.x, p.line.direction.y, p.line.direction.z}},
                         {"reach", p.line.reach},
                         {"passing", kPassing}};
    for (const FeltPlace& place : p.places)
        all["places"].push_back({{"along", place.along},
                                 {"at", {place.place.x, place.place.y, place.place.z}},
                                 {"contact_stiffness", place.contactStiffness},
                                 {"compliance", place.compliance},
                                 {"felt_stiffness", place.felt(felt.scene.patch.forceLaw)}});
    all["at_rest"]      = jsonOf(p.atRest);
    all["sliding"]      = jsonOf(p.sliding);
    all["most_floor"]   = kMostFloor;
    all["floor_is_low"] = p.floorIsLow();
    all["held"]         = p.held();
    all["warnings"]     = felt.said;
    if (!map) return all;
    all["map"] = {{"places", map->places.size()}, {"left_out", map->leftOut}, {"typical_stiffness", map->typical}};
    for (const double weber : kWeberFractions) {
        std::size_t told = 0;
        for (const double stiffness : map->stiffness) told += noticeableSteps(stiffness, map->typical, weber) >= 1;
        all["map"]["told_apart"][fixed(weber, 2)] = double(told) / double(map->stiffness.size());
    }
    return all;
}

void print(const PerceiveOptions& o, const Felt& felt, const ScenePerception& p, const std::optional<FeltMap>& map)
{
    const ForceLaw law = felt.scene.patch.forceLaw;
    const auto [softest, hardest] =
        std::minmax_element(p.places.begin(), p.places.end(),
                            [&](const FeltPlace& a, const FeltPlace& b) { return a.felt(law) < b.felt(law); });
    std::printf("%s: a prediction, not a study with people\n", o.scene.name.c_str());
    std::printf("felt stiffness along %s: %s to %s\n\n", formatQuantity(2 * p.line.reach, "m").c_str(),
                formatQuantity(softest->felt(law), "N/m").c_str(), formatQuantity(hardest->felt(law), "N/m").c_str());
    std::printf("%-26s%14s%14s%14s\n", "smallest change noticed", "7 %", "15 %", "22 %");
    const auto row = [](const char* what, const std::array<NoticedSteps, 3>& noticed, double NoticedSteps::*number) {
        std::printf("%-26s", what);
        for (const NoticedSteps& n : noticed) {
            const double value = n.*number;
            std::printf("%14s", (std::isnan(value) ? "-"
                                 : value < 0.1     ? formatNumber(value)
                                                   : fixed(value, 2))
                                    .c_str());
        }
        std::printf("\n");
    };
    row("steps J, sliding", p.sliding, &NoticedSteps::whole);
    row("  within 5 mm", p.sliding, &NoticedSteps::passing);
    row("  floor (artefacts)", p.sliding, &NoticedSteps::floor);
    row("steps J, at rest", p.atRest, &NoticedSteps::whole);
    row("  within 5 mm", p.atRest, &NoticedSteps::passing);
    row("  floor (artefacts)", p.atRest, &NoticedSteps::floor);
    row("right answers, sliding", p.sliding, &NoticedSteps::right);
    std::printf("\nJ counts just noticeable steps; one step is told right in 3 of 4 trials.\n");
    if (map)
        std::printf("map: %zu places, typically %s\n", map->places.size(), formatQuantity(map->typical, "N/m").c_str());
}

/// Returns what keeps the numbers from being those of the object, in sentences.
std::vector<std::string> doubts(const ScenePerception& p)
{
    if (p.held() > 0)
        return {"in " + fixed(100 * p.held(), 1) +
                " % of the slide a wall or a fold of the surface holds the hand up; J leaves that out, and counts what "
                "is felt as the hand comes free; try another --along or a shorter --reach"};
    if (p.floorIsLow()) return {};
    return {"on the same points with one stiffness J is " + formatNumber(p.sliding.front().floor) +
            " for a finger that notices 7 %, and should be below 0.5: part of the felt stiffness is an artefact; try a "
            "wider --window, more --cells or a shorter --reach"};
}

void perceive(const PerceiveOptions& o)
{
    demandSvg("--out", o.out);
    demandSvg("--picture", o.picture);
    refuseSameTarget("--out", o.out, "--picture", o.picture);
    Felt felt(o);
    refuseSourcesAsTarget(o.scene, felt.scene, "--out", o.out);
    refuseSourcesAsTarget(o.scene, felt.scene, "--picture", o.picture);
    const FeltLine         line = feltLine(felt.scene, felt.object,
                                   o.along.empty() ? std::optional<glm::dvec3>() : parsePoint(o.along, "--along"),
                                           eachSide(o, felt.scene, felt.object));
    Progress               progress("feeling");
    const auto             onStep = [&](std::size_t done, std::size_t total) { progress.at(done, total); };
    const ScenePerception  found  = perceive(felt.scene, felt.object, line, o.places, felt.solver, onStep);
    std::optional<FeltMap> map;
    if (!o.picture.empty()) map = feltMap(felt.object, felt.scene.patch, std::size_t(o.mapPlaces), felt.solver, onStep);
    felt.takeover = sayTakeovers(felt.solver, felt.told, found.takeover);
    if (!o.out.empty())
        write(o.out, pathSvg(found, felt.scene.patch.forceLaw, "Felt stiffness along the path: " + o.scene.title()));
    constexpr double kTypicalWeber = kWeberFractions[1];
    FigureRenderer   renderer;
    if (map)
        write(o.picture, mapSvg(felt.object.cloud(), *map, kTypicalWeber, line.middle.outward,
                                "What is noticed if 15 % is the smallest change: " + o.scene.title(), renderer));
    warn(renderer.warnings(), felt.said);
    warn(doubts(found), felt.said);
    if (o.json)
        std::cout << jsonText(jsonOf(o, felt, found, map));
    else
        print(o, felt, found, map);
}

} // namespace

void addPerceiveCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("perceive", "predicts what a person would notice of an object");
    const auto o       = std::make_shared<PerceiveOptions>();
    o->scene.addTo(*command, SceneKey::Group::session);
    command->add_option("--along", o->along, "direction of the path through the place, X,Y,Z [the chart's east]");
    command->add_option(
        "--reach", o->reach,
        "length of the path to either side, such as 10mm [a third of the window, or of the object that it spans]");
    command->add_option("--places", o->places, "number of places at rest along the path")
        ->check(CLI::Range(3, 1001))
        ->capture_default_str();
    command->add_option("--out", o->out, "SVG file for felt stiffness along the path");
    command->add_option("--picture", o->picture, "SVG file for the object, coloured by what is noticed");
    command->add_option("--picture-places", o->mapPlaces, "approximate number of touches of the map")
        ->check(CLI::Range(8, 20'000))
        ->capture_default_str();
    command->add_flag("--json", o->json, "machine-readable, SI units");
    command->footer("Examples:\n"
                    "  palpate perceive sample:skin --out path.svg\n"
                    "  palpate perceive samples/scenes/palm.json --along 1,0,0 --reach 20mm --json\n"
                    "  palpate perceive samples/scenes/skin_wart.json --picture wart.svg\n"
                    "J is the number of just noticeable steps between two stiffnesses, for people whose\n"
                    "smallest noticed change is 7, 15 or 22 %. The floor is J on the same points with one stiffness.");
    command->callback([command, o] {
        demandOwner(*command, "--picture", {"--picture-places"});
        perceive(*o);
    });
}

} // namespace palp
