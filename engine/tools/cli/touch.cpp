#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/npy.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/curvature_doubt.h"
#include "engine/pipeline/deform.h"
#include "engine/pipeline/dent_length.h"
#include "engine/pipeline/presets.h"
#include "engine/pipeline/press.h"
#include "engine/session/hand_path.h"
#include "engine/session/scene_keys.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/patch_json.h"
#include "engine/tools/cli/scene_source.h"
#include "engine/tools/cli/solver_choice.h"
#include "engine/tools/paper/section.h"
#include "engine/tools/plot/patch_pictures.h"
#include "engine/tools/render/cloud_figure.h"

namespace palp {
namespace {

struct TouchOptions {
    SceneSource source;
    std::string force = "0.5N", out;
    bool        json  = false;
};

constexpr const char* kSummary    = "touch.json";
constexpr const char* kDeformed   = "deformed.ply";
constexpr const char* kGrids[]    = {"deflection.npy", "rigidity.npy"};
constexpr const char* kPictures[] = {"surface.svg", "close_up.svg", "rigidity.svg", "deflection.svg", "profile.svg"};

/// Returns the names of all files in the folder of --out, in reading order.
std::vector<std::string> fileNames()
{
    std::vector<std::string> names{kDeformed};
    names.insert(names.end(), std::begin(kGrids), std::end(kGrids));
    names.insert(names.end(), std::begin(kPictures), std::end(kPictures));
    names.emplace_back(kSummary);
    return names;
}

/// Refuses a folder in which a file would be written over one that the touch reads.
void demandTarget(const TouchOptions& options, const Scene& scene)
{
    if (options.out.empty()) return;
    demandFolder("--out", options.out);
    for (const std::string& name : fileNames())
        refuseSourcesAsTarget(options.source, scene, "--out", (std::filesystem::path(options.out) / name).string());
}

std::string percent(double share)
{
    constexpr double kLeast = 1e-5; // the third decimal of a percent [1]
    return share > 0 && share < kLeast ? "below 0.001 %" : report::percent(share);
}

void printLarge(const nlohmann::json& large)
{
    if (large.contains("linear_because")) {
        std::printf("  large deflection   linear, because %s\n", large["linear_because"].get<std::string>().c_str());
        return;
    }
    const auto        quantity = [&](const char* key, const char* unit) { return formatQuantity(large[key], unit); };
    const std::string linear = quantity("depth_linear", "m"), trusted = quantity("trusted_deflection", "m");
    if (large["depth"].is_null())
        std::printf(
            "  large deflection   not known at this force: trusted to a deflection of %s, which needs %s; linear, the "
            "hand would be %s deep\n",
            trusted.c_str(), quantity("trusted_force", "N").c_str(), linear.c_str());
    else
        std::printf(
            "  large deflection   felt %s at this force, depth %s of the hand; linear %s; trusted to a deflection "
            "of %s\n",
            quantity("felt_stiffness", "N/m").c_str(), quantity("depth", "m").c_str(), linear.c_str(), trusted.c_str());
}

void printWindow(const nlohmann::json& window)
{
    const bool whole = window["of"] == "object";
    std::printf("  patch window       %s%s, %d x %d cells%s, %zu points, ", whole ? "the whole object, " : "",
                formatQuantity(window["size"][0], "m").c_str(), window["cells"][0].get<int>(),
                window["cells"][1].get<int>(), whole ? " by its size" : "",
                window["points_near_side"].get<std::size_t>());
    if (whole)
        std::printf("%zu nodes covered", window["nodes_covered"].get<std::size_t>());
    else
        std::printf("%zu nodes without a point nearby", window["nodes_without_point"].get<std::size_t>());
    if (const auto held = window["nodes_held"].get<std::size_t>()) std::printf(", %zu held", held);
    std::printf("\n");
    if (!window["chosen"].is_null())
        std::printf("  window chosen      %s\n", window["chosen"].get<std::string>().c_str());
}

void printShell(const nlohmann::json& shell, double compliance, double force, bool isCut)
{
    constexpr double kNoise = 1e-4; // what fits to points leave of no curvature [1]
    const auto   quantity = [](const nlohmann::json& number, const char* unit) { return formatQuantity(number, unit); };
    const double most = shell["curvatures"][0], least = shell["curvatures"][1];
    if (shell["flat"].get<bool>())
        std::printf("  shell              %s", shell["flat_because"].is_null()
                                                   ? "flat here, bent as a plate"
                                                   : "none, bent as a flat plate: see below");
    else
        std::printf("  shell              curvatures %s and %s", formatQuantity(most, "1/m").c_str(),
                    formatQuantity(std::abs(least) < kNoise * std::abs(most) ? 0 : least, "1/m").c_str());
    if (!shell["length"].is_null())
        std::printf(", window %.1f lengths of %s", shell["window_lengths"].get<double>(),
                    quantity(shell["length"], "m").c_str());
    std::printf("\n");
    if (!shell["felt_stiffness_supported"].is_null()) {
        std::printf("  support range      felt %s with supported and %s with clamped edges",
                    quantity(shell["felt_stiffness_supported"], "N/m").c_str(),
                    quantity(shell["felt_stiffness_clamped"], "N/m").c_str());
        if (shell["felt_stiffness_least"] < shell["felt_stiffness_supported"])
            std::printf(", %s with supported edges of a window of %s",
                        quantity(shell["felt_stiffness_least"], "N/m").c_str(),
                        quantity(shell["least_in_window"], "m").c_str());
        std::printf("; the answer is that of the scene's: %s\n", shell["edges"].get<std::string>().c_str());
    }
    if (const double body = shell["body_compliance"]; isCut || body > 0)
        std::printf("  body               gives way by %s of the compliance, %s beside the deflection: %s\n",
                    percent(body / compliance).c_str(), formatQuantity(force * body, "m").c_str(),
                    isCut ? "the window is cut from a coarse shell of the whole object, held as the scene says"
                          : "a cap is held by its rim, what is closed just below its widest");
}

void printTouch(const TouchOptions& options, const Scene& scene, const nlohmann::json& r)
{
    const PatchSettings& settings = scene.patch;
    const auto           quantity = [&](const char* key, const char* unit) { return formatQuantity(r[key], unit); };
    const auto&          window   = r["window"];
    const auto&          error    = r["error"];
    const auto           pointOf  = [](const nlohmann::json& p) { return glm::dvec3(p[0], p[1], p[2]); };
    const auto&          cloud    = r["cloud"];
    const glm::dvec3     at       = pointOf(r["contact"]["point"]);
    const auto&          normal   = r["chart"]["normal"];
    std::printf("%s, preset %s, %s at %s m, pressed against (%.2f, %.2f, %.2f)\n", options.source.name.c_str(),
                name(scene.preset), formatQuantity(r["force"], "N").c_str(),
                placeText(at, glm::length(pointOf(cloud["high"]) - pointOf(cloud["low"])) / 10).c_str(),
                normal[0].get<double>(), normal[1].get<double>(), normal[2].get<double>());
    std::printf("  length unit        %s\n", r["cloud"]["length_unit_source"].get<std::string>().c_str());
    std::printf("  stiffness          %s\n", r["cloud"]["stiffness_source"].get<std::string>().c_str());
    std::printf("  scene              thickness %s, poisson %.3g, foundation %s, footprint radius %s\n",
                formatQuantity(scene.material.thickness, "m").c_str(), scene.material.poissonRatio,
                formatQuantity(settings.foundation, "Pa/m").c_str(),
                formatQuantity(settings.footprintRadius, "m").c_str());
    std::printf("  sphere             %s, radius %s, misfit %s\n", r["sphere"]["outcome"].get<std::string>().c_str(),
                r["sphere"]["radius"].is_null() ? "infinite" : formatQuantity(r["sphere"]["radius"], "m").c_str(),
                formatQuantity(r["sphere"]["misfit"], "m").c_str());
    printWindow(window);
    std::printf("  rigidity           %s at the contact, %s to %s in the patch window\n",
                quantity("rigidity_at_contact", "N m").c_str(), formatQuantity(window["rigidity_min"], "N m").c_str(),
                formatQuantity(window["rigidity_max"], "N m").c_str());
    std::printf("  deflection         %s at the contact, %s at most\n", quantity("deflection_at_contact", "m").c_str(),
                quantity("max_deflection", "m").c_str());
    std::printf("  compliance         %s, mean under the fingertip\n", quantity("compliance", "m/N").c_str());
    std::printf("  contact stiffness  %s\n", quantity("contact_stiffness", "N/m").c_str());
    std::printf("  felt stiffness     %s (%s law)\n", quantity("felt_stiffness", "N/m").c_str(),
                name(settings.forceLaw));
    if (const auto& shell = r["shell"]; !shell.is_null())
        printShell(shell, r["compliance"], r["force"], window["beyond"] == "body");
    if (const auto& large = r["large"]; !large.is_null()) printLarge(large);
    if (!scene.material.isLinear() || r["stiffening"].get<double>() > 0)
        std::printf("  depth              %s of the hand at once, %s in the end (stiffening %.4g 1/m, relaxation %s)\n",
                    quantity("depth", "m").c_str(), quantity("depth_relaxed", "m").c_str(),
                    r["stiffening"].get<double>(), relaxationText(scene.material.relaxation).c_str());
    std::printf("  error              discretisation %s, solver %s (%s)\n",
                error["discretisation"].is_null() ? "unknown" : percent(error["discretisation"].get<double>()).c_str(),
                percent(error["solver"].get<double>()).c_str(), r["solver"]["name"].get<std::string>().c_str());
    std::printf("  time               %.1f ms:", r["milliseconds"]["total"].get<double>());
    for (const char* stage : {"gather", "fit", "project", "resample", "prepare", "solve", "lift"})
        std::printf(" %s %.2f", stage, r["milliseconds"][stage].get<double>());
    std::printf("\n");
    for (const std::string& line : differencesFromPaper(settings))
        std::printf("  unlike the paper   %s\n", line.c_str());
    for (const auto& line : r["warnings"]) std::printf("  warning            %s\n", line.get<std::string>().c_str());
    if (r.contains("files"))
        for (const auto& file : r["files"])
            std::printf("  wrote              %s\n", (options.out + "/" + file.get<std::string>()).c_str());
}

void writePictures(const std::filesystem::path& folder, const PointCloud& cloud, const Patch& patch,
                   const PatchSettings& settings, double force, double load, FigureRenderer& renderer)
{
    const std::string  newtons   = formatQuantity(force, "N");
    const double       deepest   = load * mostResponse(patch);
    const PressedPatch pressed[] = {{&patch, load, newtons}};
    const double       far       = roundExaggeration(deepest, cloud.bounds().diagonal());
    const double       near      = roundExaggeration(deepest, 2 * bentSize(patch));
    const auto         times     = [](double factor) {
        return factor == 1 ? std::string() : ", displacement x " + std::to_string(int(factor));
    };
    const std::array<std::string, std::size(kPictures)> drawn = {
        surfaceSvg(cloud, pressed, {"Under " + newtons + times(far), far, {}, false}, renderer),
        surfaceSvg(cloud, pressed, {"Around the contact under " + newtons + times(near), near, {}, true}, renderer),
        rigidityChartSvg(patch, settings, std::string("Rigidity in the ") + name(patch.chart.map) + " chart"),
        deflectionChartSvg(patch, settings, load, "Deflection under " + newtons),
        profileSvg(patch, load, "Deflection through the contact under " + newtons)};
    for (std::size_t k = 0; k < drawn.size(); ++k)
        writeFileWhole(folder / kPictures[k], [&](std::ostream& stream) { stream << drawn[k]; });
}

/// Writes the deformed cloud, the grids and the pictures.
void writeFiles(const TouchOptions& options, const PointCloud& cloud, const Patch& patch, const PatchSettings& settings,
                double force, double load, FigureRenderer& renderer)
{
    const std::filesystem::path folder = options.out;
    makeFolder(folder);
    // touch.json is written last, as the mark of a complete folder, so that of an earlier touch must go first.
    std::error_code failure;
    std::filesystem::remove(folder / kSummary, failure);
    if (failure) throw Error((folder / kSummary).string() + ": cannot be replaced: " + failure.message());
    const std::vector<double>     deflection = deflections(cloud, patch, load);
    const std::span<const double> stiffness  = cloud.stiffness();
    const PointCloud bent(displaced(cloud, patch, load), {stiffness.begin(), stiffness.end()}, cloud.kind());
    const NamedField field{"deflection", "m", deflection};
    writeCloud(folder / kDeformed, bent, {&field, 1});

    NodeField w = patch.response;
    for (double& value : w.values()) value *= load;
    writeNpy(folder / kGrids[0], w);
    writeNpy(folder / kGrids[1], patch.plate.rigidity);
    writePictures(folder, cloud, patch, settings, force, load, renderer);
}

/// Stiffnesses and thicknesses may be anything positive; their quotients must still be numbers.
void refuseOverflow(const nlohmann::json& report)
{
    for (const char* key :
         {"rigidity_at_contact", "compliance", "contact_stiffness", "felt_stiffness", "max_deflection"})
        if (!std::isfinite(report[key].get<double>()))
            throw Error(std::string(key) + " is not finite; check the stiffness, --thickness and --force");
}

/// Says who took over, and how long that took if one waited for it.
void tellTakeover(std::string sentence, const Patch& patch)
{
    constexpr double kLong = 2000; // [ms]
    const double     time  = patch.times.prepare + patch.times.solve;
    if (!sentence.empty() && patch.report.solver == PlateSolver::kReference && time > kLong)
        sentence += "; that took " + formatQuantity(1e-3 * time, "s");
    sayTakeover(sentence);
}

/// Says how far from a place that was asked for the touched point lies; empty where the points' own distances explain
/// it.
std::string placeDoubt(const Scene& scene, const Patch& patch)
{
    constexpr double kExplained = 2; // spacings [1]
    if (!scene.place) return {};
    const double off = glm::length(patch.contact.point - *scene.place);
    if (off <= kExplained * patch.spacing) return {};
    return "the place lies " + formatQuantity(off, "m") + " off the surface: the nearest place on it is touched";
}

void touch(const TouchOptions& options)
{
    Scene                scene    = options.source.load();
    const PatchSettings& settings = scene.patch;
    const double         force    = forceOf(options.force);
    demandTarget(options, scene);
    const LoadedObject loaded = options.source.loadObject(scene);
    const SoftObject&  object = loaded.object;
    const std::string  why    = whyDentWindow(object, scene.patch);
    scene.patch               = settledFor(object, scene.patch);
    const Contact contact     = contactOf(scene, object);
    PlateSolver   solver      = openSolver(scene.solver);
    const auto    told        = solver.counts().takeovers;
    const Patch   patch       = deform(object, contact, settings, solver);
    tellTakeover(solver.takeoverSince(told), patch);
    demandDeformed(patch);
    demandUsable(patch);

    nlohmann::json report = patchJson(object, patch, settings, force, solver);
    refuseOverflow(report);
    report["window"]["chosen"] = why.empty() ? nlohmann::json(nullptr) : nlohmann::json(why);
    report["cloud"]            = cloudJson(options.source.name, object.cloud(), object.faces(), loaded.report);
    for (std::string& line : curvatureDoubts(object, patch, settings)) report["warnings"].push_back(std::move(line));
    for (std::string& line : cloudWarnings(scene, object.cloud(), loaded.report))
        report["warnings"].push_back(std::move(line));
    if (std::string doubt = placeDoubt(scene, patch); !doubt.empty()) report["warnings"].push_back(std::move(doubt));
    report["preset"] = name(scene.preset);
    if (!options.out.empty()) {
        FigureRenderer renderer;
        const double   load = pressOf(patch, scene.material, force).load;
        writeFiles(options, object.cloud(), patch, settings, force, load, renderer);
        for (const std::string& warning : renderer.warnings()) report["warnings"].push_back(warning);
        report["files"] = fileNames();
        writeFileWhole(std::filesystem::path(options.out) / kSummary,
                       [&](std::ostream& file) { file << jsonText(report); });
    }
    if (options.json)
        std::cout << jsonText(report);
    else
        printTouch(options, scene, report);
}

} // namespace

void addTouchCommand(CLI::App& app)
{
    CLI::App* command =
        app.add_subcommand("touch", "presses a scripted finger on a cloud and reports dent and felt stiffness");
    const auto o = std::make_shared<TouchOptions>();
    o->source.addTo(*command, SceneKey::Group::touch);
    command->add_option("--force", o->force, "force that presses, such as 0.5N")->capture_default_str();
    command->add_option(
        "--out", o->out,
        "folder for the deformed cloud, grids, pictures and touch.json, which is written last: a folder without it "
        "is incomplete");
    command->add_flag("--json", o->json, "machine-readable, SI units");
    command->footer(
        "Examples:\n"
        "  palpate touch sample:skin --out touch\n"
        "  palpate touch sample:ellipsoid --place 30mm,0,30mm --force 0.3N --preset paper --json\n"
        "  palpate touch scan.ply --length-unit mm --stiffness-property quality --stiffness-range 20kPa,2MPa --place "
        "12,0,30\n"
        "Without --place a cloud from a file is touched where it comes nearest to the viewer. Plain numbers of\n"
        "lengths are in the unit of --length-unit, else metres.");
    command->callback([o] { touch(*o); });
}

} // namespace palp
