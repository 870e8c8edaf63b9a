#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "engine/cloud/samples.h"
#include "engine/core/counted.h"
#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/session/scene_mesh.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/quality_report.h"
#include "engine/tools/cli/scene_source.h"
#include "engine/tools/study/hunt_scene.h"

namespace palp {
namespace {

struct InfoOptions {
    SceneSource source;
    std::string picture; ///< a file; empty: none
    bool        json = false;
};

std::string span3(const Bounds& bounds)
{
    constexpr double kFar = 100; // diagonals: three digits then say little of where the cloud lies [1]
    std::string      text;
    for (int k = 0; k < 3; ++k) {
        if (std::abs(bounds.low[k]) > kFar * bounds.diagonal())
            return placeText(bounds.low, bounds.diagonal()) + " m to " + placeText(bounds.high, bounds.diagonal()) +
                   " m";
        text += std::string(k ? ", " : "") + "xyz"[k] + " " + formatQuantity(bounds.low[k], "m") + " to " +
                formatQuantity(bounds.high[k], "m");
    }
    return text;
}

/// "30 mm x 20 mm x 5 mm"
std::string sizeText(const Bounds& bounds)
{
    std::string text;
    for (int k = 0; k < 3; ++k)
        text += std::string(k ? " x " : "") + formatQuantity(bounds.high[k] - bounds.low[k], "m");
    return text;
}

/// Returns a number with two digits that count, because it is estimated: "14000".
std::string roundCount(std::size_t count)
{
    std::size_t unit = 1;
    while (count / unit >= 100) unit *= 10;
    return std::to_string((count + unit / 2) / unit * unit);
}

/// "1200 triangles of 700 faces (2 left out: ...)"
std::string facesText(const LoadedCloud& loaded)
{
    const CloudFileReport& report = loaded.report;
    std::string            text   = counted(loaded.faces.size(), "triangle") + " of " + counted(report.faces, "face");
    if (report.degenerateFaces > 0)
        text += ", " + std::to_string(report.degenerateFaces) + " left out: fewer than three corners, or one twice";
    if (report.droppedFaces > 0) text += ", " + std::to_string(report.droppedFaces) + " left out: lost a point";
    return text;
}

/// "8 vertices, 49 mm apart, ..."
std::string scatterText(const LoadedCloud& loaded, const ScatterPlan& plan)
{
    return std::to_string(loaded.cloud.size()) + " vertices, " + formatQuantity(plan.spacing, "m") +
           " apart, with edges up to " + formatQuantity(plan.longestEdge, "m") + ": a fingertip of " +
           formatQuantity(plan.fingertip, "m") + " touches " + counted(loaded.faces.size(), "triangle") +
           " through about " + roundCount(plan.points) + " points at least " + formatQuantity(plan.distance, "m") +
           " apart, scattered over them";
}

nlohmann::json scatterJson(const ScatterPlan& plan)
{
    return {{"vertex_spacing", plan.spacing},
            {"longest_edge", plan.longestEdge},
            {"fingertip", plan.fingertip},
            {"distance", plan.distance},
            {"points_about", plan.points}};
}

/// Prints what was read, and what is known about it.
void printText(const InfoOptions& options, const LoadedCloud& loaded, const QualityReport& quality,
               const std::optional<ScatterPlan>& plan, const nlohmann::json& report)
{
    const std::string unit = report["stiffness_unit"] == "N_m" ? "N m" : report["stiffness_unit"];
    std::string       properties;
    for (const std::string& property : loaded.report.properties)
        properties += (properties.empty() ? "" : ", ") + property;
    std::cout << options.source.name << ": " << loaded.report.format << ", " << counted(loaded.cloud.size(), "point");
    if (loaded.report.droppedPoints) std::cout << " (" << loaded.report.droppedPoints << " dropped: NaN or infinity)";
    std::cout << "\n  extent      " << span3(loaded.cloud.bounds()) << "\n  size        "
              << sizeText(loaded.cloud.bounds()) << "\n  length unit " << loaded.report.lengthUnitSource << "\n";
    printText(quality, loaded.report.duplicatePositions);
    std::cout << "  stiffness   " << formatQuantity(report["stiffness_min"], unit) << " to "
              << formatQuantity(report["stiffness_max"], unit) << ": " << loaded.report.stiffnessSource << "\n";
    if (const auto& range = report["stiffening"]; !range.is_null())
        std::cout << "  stiffening  " << formatQuantity(range[0], "1/m") << " to " << formatQuantity(range[1], "1/m")
                  << ": of each point, from the file\n";
    if (const auto& range = report["foundation"]; !range.is_null())
        std::cout << "  foundation  " << formatQuantity(range[0], "Pa/m") << " to " << formatQuantity(range[1], "Pa/m")
                  << ": below each point, from the file, if the scene says below: own\n";
    if (loaded.report.faces > 0) std::cout << "  faces       " << facesText(loaded) << "\n";
    if (plan && quality.refusal.empty()) std::cout << "  scattered   " << scatterText(loaded, *plan) << "\n";
    if (!loaded.normals.empty()) std::cout << "  normals     in the file\n";
    if (!properties.empty()) std::cout << "  properties  " << properties << "\n";
    for (const std::string& line : meaningForTouch(quality)) std::cout << "  for touch   " << line << "\n";
    for (const auto& line : report["warnings"].get<std::vector<std::string>>())
        std::cout << "  warning     " << line << "\n";
}

/// Returns the object with what the scene says that holds it; without where the scene holds what the cloud does not
/// say: a file is shown whatever a scene wants of it.
SoftObject heldIfItCan(const Scene& scene, SoftObject object, const LoadedCloud& loaded)
{
    try {
        return heldAs(scene, object, loaded);
    } catch (const Error&) {
        return object;
    }
}

void printInfo(const InfoOptions& options)
{
    if (!options.picture.empty()) demandPictureName("--picture", options.picture);
    const Scene whole = options.source.load();
    refuseSourcesAsTarget(options.source, whole, "--picture", options.picture);
    Scene scene                    = whole;
    scene.scatter                  = Scatter::off; // the file is shown, and what would become of it
    const LoadedCloud       loaded = options.source.loadCloud(scene);
    const auto              plan   = scatterPlan(whole, loaded);
    std::optional<Progress> progress("looking at the points");
    progress->mayLast();
    constexpr double kMostTried = 1e6; // points: enough to judge a mesh by the points through which it is touched
    const SoftObject object =
        plan && loaded.cloud.kind() != StiffnessKind::felt && double(plan->points) <= kMostTried
            ? options.source.loadObject(whole).object
            : heldIfItCan(scene, SoftObject(loaded.cloud, scene.material, loaded.faces, loaded.normals), loaded);
    QualityReport quality = qualityReport(object, loaded, scene);
    if (plan) quality.refusal = scatterRefusal(*plan);
    progress.reset();

    nlohmann::json report   = cloudJson(options.source.name, loaded.cloud, loaded.faces, loaded.report);
    report["point_spacing"] = object.spacing();
    report["scatter"]       = plan ? scatterJson(*plan) : nlohmann::json();
    report["quality"]       = jsonOf(quality);
    report["warnings"]      = cloudWarnings(scene, loaded.cloud, loaded.report);
    if (!options.picture.empty()) {
        progress.emplace("drawing").mayLast();
        writeQualityPicture(options.picture, options.source.title(), object, quality.quality);
        progress.reset();
        report["picture"] = options.picture;
    }
    options.json ? void(std::cout << jsonText(report)) : printText(options, loaded, quality, plan, report);
}

void printSamples(bool json)
{
    nlohmann::json list = nlohmann::json::array();
    for (const Sample& sample : samples()) {
        list.push_back({{"name", sample.name}, {"description", sample.description}, {"points", sample.points}});
        if (!json) std::printf("sample:%-11s %s\n", sample.name.data(), sample.description.data());
    }
    if (json) std::cout << jsonText(list);
}

/// Prints the keys of scenes: what each takes and means.
void printKeys(bool asJson)
{
    if (!asJson) return void(std::cout << sceneKeyTable(&study::huntKeys()));
    nlohmann::json keys = nlohmann::json::array();
    for (const SceneKey* key : sceneKeysWith(&study::huntKeys()))
        keys.push_back({{"key", key->name}, {"unit", key->unit}, {"takes", key->expected()}, {"means", key->help}});
    std::cout << keys.dump(2) << '\n';
}

} // namespace

void addInfoCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("info", "shows what a cloud holds, how it is read and how good it is");
    const auto options = std::make_shared<InfoOptions>();
    options->source.addTo(*command, SceneKey::Group::touch); // how it bends decides what the window holds
    command->get_option("SCENE")->required(false);
    const auto list = std::make_shared<bool>(false), keys = std::make_shared<bool>(false),
               schema = std::make_shared<bool>(false);
    command->add_flag("--samples", *list, "lists the procedural samples");
    command->add_flag("--keys", *keys, "lists the keys of scenes, as a table in Markdown");
    command->add_flag("--schema", *schema, "prints the JSON Schema of scene files");
    command->add_option("--picture", options->picture,
                        "a .png or .svg file: the object in the colours of spacing and of noise");
    command->add_flag("--json", options->json, "machine-readable");
    command->footer("Examples:\n"
                    "  palpate info scan.ply --picture quality.png\n"
                    "  palpate info scan.ply --length-unit mm\n"
                    "  palpate info painted.ply --stiffness-property quality --stiffness-range 20kPa,2MPa\n"
                    "  palpate info --samples");
    command->callback([command, options, list, keys, schema] {
        for (const char* alone : {"--samples", "--keys", "--schema"}) allowOnlyWith(*command, alone, {"--json"});
        if (*list) return printSamples(options->json);
        if (*keys) return printKeys(options->json);
        if (*schema) return void(std::cout << sceneSchema(&study::huntKeys()));
        if (options->source.name.empty()) throw CLI::RequiredError("SCENE");
        printInfo(*options);
    });
}

} // namespace palp
