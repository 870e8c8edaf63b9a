#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/npy.h"
#include "engine/core/quantity.h"
#include "engine/tools/cli/cloud_source.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/patch_json.h"
#include "engine/tools/cli/solver_choice.h"
#include "engine/tools/plot/patch_pictures.h"

namespace palp {
namespace {

struct TouchOptions {
    CloudSource  source;
    SolverChoice solver;
    std::string  at, from, force = "0.5N", preset = "palpate";
    std::string  map, sampling, edges, forceLaw, foundation, thickness, poisson, window,
        footprint;            // empty: the preset's
    std::optional<int> cells; ///< empty: the default
    std::string        out;
    bool               json = false;
};

/// The value of an option with a fixed set of names, or a sentence that lists them.
template <class T>
T named(const std::optional<T>& value, const std::string& option, const std::string& text, const char* known)
{
    if (value) return *value;
    throw Error(option + ": unknown name \"" + text + "\"; known: " + known);
}

// Far beyond what a hand can feel, and far from where single precision or a result could overflow.
constexpr double kLeastLength    = 1e-9; // [m]
constexpr double kMostLength     = 1e4;  // [m]
constexpr double kMostCoordinate = 1e9;  // [m] as in files: surveyors count from far away
constexpr double kMostForce      = 1e6;  // [N]
constexpr double kMostFoundation = 1e15; // [Pa/m] a micrometre of steel has less

double between(double least, double most, const char* unit, double value, const std::string& option,
               const std::string& text)
{
    if (value >= least && value <= most) return value;
    char bounds[64];
    std::snprintf(bounds, sizeof bounds, "%g to %g %s", least, most, unit);
    throw Error(option + ": expected a value from " + bounds + ", found \"" + text + "\"");
}

/// A plain number is in the unit of --unit, as in --at.
double lengthOf(const TouchOptions& options, const std::string& text, const std::string& option)
{
    const double value = parseQuantity(text, Dimension::length, option, options.source.metresPerPlainNumber());
    return between(kLeastLength, kMostLength, "m", value, option, text);
}

constexpr const char* kSummary = "touch.json";

Material materialOf(const TouchOptions& options)
{
    Material material = options.source.sample() ? options.source.sample()->material : Material{};
    if (!options.thickness.empty()) material.thickness = lengthOf(options, options.thickness, "--thickness");
    if (!options.poisson.empty()) material.poissonRatio = parseQuantity(options.poisson, Dimension::none, "--poisson");
    if (!isPoissonRatio(material.poissonRatio))
        throw Error("--poisson: expected a number above -1 and at most 0.5, found " + options.poisson);
    return material;
}

/// Settings in order of precedence: defaults, the sample's constants, the preset, the options.
PatchSettings settingsOf(const TouchOptions& options)
{
    PatchSettings settings;
    if (const Sample* sample = options.source.sample()) {
        settings.foundation      = sample->foundation;
        settings.window          = sample->window;
        settings.footprintRadius = sample->footprintRadius;
    }
    settings =
        withPreset(settings, named(valueNamed<Preset>(options.preset), "--preset", options.preset, "palpate, paper"));
    if (!options.foundation.empty())
        settings.foundation = between(0, kMostFoundation, "Pa/m",
                                      parseQuantity(options.foundation, Dimension::foundation, "--foundation"),
                                      "--foundation", options.foundation);
    if (!options.window.empty()) settings.window = lengthOf(options, options.window, "--window");
    if (!options.footprint.empty()) settings.footprintRadius = lengthOf(options, options.footprint, "--footprint");
    if (!options.edges.empty()) settings.edges = parseEdges(options.edges, "--edges");
    if (!options.map.empty())
        settings.map = named(valueNamed<Map>(options.map), "--map", options.map,
                             "lambert-azimuthal, lambert-cylindrical, gall-peters");
    if (!options.sampling.empty())
        settings.sampling =
            named(valueNamed<Resampling>(options.sampling), "--sampling", options.sampling, "log-mean, nearest");
    if (!options.forceLaw.empty())
        settings.forceLaw =
            named(valueNamed<ForceLaw>(options.forceLaw), "--force-law", options.forceLaw, "series, paper");
    if (options.cells) settings.cells = *options.cells;
    constexpr int kMostCells = 1024; // --device reference: the factor then takes about 4 GB
    if (settings.cells < 8 || settings.cells > kMostCells || settings.cells % 2)
        throw Error("--cells: expected an even number from 8 to " + std::to_string(kMostCells) + ", found " +
                    std::to_string(settings.cells));
    settings.tolerance = options.solver.tolerance;
    return settings;
}

Contact contactOf(const TouchOptions& options, const SoftObject& object, double window)
{
    const Sample*             sample = options.source.sample();
    std::optional<glm::dvec3> from;
    if (sample) from = sample->from;
    if (!options.from.empty()) from = parsePoint(options.from, "--from");
    const double plain = options.source.metresPerPlainNumber();
    if (!sample && options.at.empty()) {
        const Bounds&    bounds = object.cloud().bounds();
        const glm::dvec3 middle = object.positions()[object.index().nearest(bounds.centre(), 1).front().point];
        throw Error("--at: expected a place X,Y,Z for a cloud from a file, found none; near its middle it has the "
                    "point --at " +
                    placeText(middle, bounds.diagonal(), plain) + " (in " +
                    (options.source.unit.empty() ? "m" : options.source.unit) + ")");
    }
    const glm::dvec3 place = options.at.empty() ? sample->place : parsePoint(options.at, "--at", plain);
    for (int k = 0; k < 3; ++k) between(-kMostCoordinate, kMostCoordinate, "m", place[k], "--at", options.at);
    return touchAt(object, place, from, window / 4);
}

std::string percent(double share)
{
    char             text[32];
    constexpr double kLeast = 1e-5; // [1] the third decimal of a percent
    if (share > 0 && share < kLeast) return "below 0.001 %";
    std::snprintf(text, sizeof text, share < 0.1 ? "%.2g %%" : "%.0f %%", 100 * share);
    return text;
}

void printTouch(const TouchOptions& options, const Material& material, const PatchSettings& settings,
                const nlohmann::json& r)
{
    const auto  quantity = [&](const char* key, const char* unit) { return formatQuantity(r[key], unit); };
    const auto& window   = r["window"];
    const auto& error    = r["error"];
    const auto& at       = r["contact"]["point"];
    const auto& normal   = r["chart"]["normal"];
    std::printf("%s, preset %s, %s at (%.4g, %.4g, %.4g) m, pressed against (%.2f, %.2f, %.2f)\n",
                options.source.name.c_str(), options.preset.c_str(), formatQuantity(r["force"], "N").c_str(),
                at[0].get<double>(), at[1].get<double>(), at[2].get<double>(), normal[0].get<double>(),
                normal[1].get<double>(), normal[2].get<double>());
    std::printf("  length unit        %s\n", r["cloud"]["length_unit_source"].get<std::string>().c_str());
    std::printf("  stiffness          %s\n", r["cloud"]["stiffness_source"].get<std::string>().c_str());
    std::printf("  scene              thickness %s, poisson %.3g, foundation %s, footprint radius %s\n",
                formatQuantity(material.thickness, "m").c_str(), material.poissonRatio,
                formatQuantity(settings.foundation, "Pa/m").c_str(),
                formatQuantity(settings.footprintRadius, "m").c_str());
    std::printf("  sphere             %s, radius %s, misfit %s\n", r["sphere"]["outcome"].get<std::string>().c_str(),
                r["sphere"]["radius"].is_null() ? "infinite" : formatQuantity(r["sphere"]["radius"], "m").c_str(),
                formatQuantity(r["sphere"]["misfit"], "m").c_str());
    std::printf("  window             %s, %d x %d cells, %zu points, %zu nodes without a point nearby\n",
                formatQuantity(settings.window, "m").c_str(), settings.cells, settings.cells,
                window["points_near_side"].get<std::size_t>(), window["nodes_without_point"].get<std::size_t>());
    std::printf("  rigidity           %s at the contact, %s to %s in the window\n",
                quantity("rigidity_at_contact", "N m").c_str(), formatQuantity(window["rigidity_min"], "N m").c_str(),
                formatQuantity(window["rigidity_max"], "N m").c_str());
    std::printf("  deflection         %s at the contact, %s at most\n", quantity("deflection_at_contact", "m").c_str(),
                quantity("max_deflection", "m").c_str());
    std::printf("  compliance         %s, mean under the fingertip\n", quantity("compliance", "m/N").c_str());
    std::printf("  contact stiffness  %s\n", quantity("contact_stiffness", "N/m").c_str());
    std::printf("  felt stiffness     %s (%s law)\n", quantity("felt_stiffness", "N/m").c_str(),
                name(settings.forceLaw));
    std::printf("  error              discretisation %s, solver %s (%s)\n",
                error["discretisation"].is_null() ? "unknown" : percent(error["discretisation"].get<double>()).c_str(),
                percent(error["solver"].get<double>()).c_str(), r["solver"]["device"].get<std::string>().c_str());
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

/// What the touch looks like; the names of the files, in the order in which one looks at them.
std::vector<std::string> writePictures(const std::filesystem::path& folder, const PointCloud& cloud, const Patch& patch,
                                       const PatchSettings& settings, double force)
{
    const std::string newtons = formatQuantity(force, "N");
    const double deepest = force * *std::max_element(patch.response.values().begin(), patch.response.values().end());
    const PressedPatch pressed[] = {{&patch, force, newtons}};
    const double       far       = roundExaggeration(deepest, cloud.bounds().diagonal());
    const double       near      = roundExaggeration(deepest, 2 * settings.window);
    const auto         times     = [](double factor) {
        return factor == 1 ? std::string() : ", displacement x " + std::to_string(int(factor));
    };
    const std::pair<const char*, std::string> pictures[] = {
        {"surface.svg", surfaceSvg(cloud, pressed, {"Under " + newtons + times(far), far, {}, false})},
        {"close_up.svg",
         surfaceSvg(cloud, pressed, {"Around the contact under " + newtons + times(near), near, {}, true})},
        {"rigidity.svg",
         rigidityChartSvg(patch, settings, std::string("Rigidity in the ") + name(patch.chart.map) + " chart")},
        {"deflection.svg", deflectionChartSvg(patch, settings, force, "Deflection under " + newtons)},
        {"profile.svg", profileSvg(patch, force, "Deflection through the contact under " + newtons)}};
    std::vector<std::string> files;
    for (const auto& picture : pictures) {
        writeFileWhole(folder / picture.first, [&](std::ostream& stream) { stream << picture.second; });
        files.emplace_back(picture.first);
    }
    return files;
}

/// The deformed cloud, the grids and the pictures.
std::vector<std::string> writeFiles(const TouchOptions& options, const PointCloud& cloud, const Patch& patch,
                                    const PatchSettings& settings, double force)
{
    const std::filesystem::path folder = options.out;
    makeFolder(folder);
    // touch.json, written last, says that the folder holds one whole set: that of an earlier touch must not.
    std::error_code failure;
    std::filesystem::remove(folder / kSummary, failure);
    if (failure) throw Error((folder / kSummary).string() + ": cannot be replaced: " + failure.message());
    const std::vector<double>     deflection = deflections(cloud, patch, force);
    const std::span<const double> stiffness  = cloud.stiffness();
    const PointCloud bent(displaced(cloud, patch, force), {stiffness.begin(), stiffness.end()}, cloud.kind());
    const NamedField field{"deflection", "m", deflection};
    writeCloud(folder / "deformed.ply", bent, {&field, 1});

    NodeField w = patch.response;
    for (double& value : w.values()) value *= force;
    writeNpy(folder / "deflection.npy", w);
    writeNpy(folder / "rigidity.npy", patch.plate.rigidity);

    std::vector<std::string> files = {"deformed.ply", "deflection.npy", "rigidity.npy"};
    for (std::string& picture : writePictures(folder, cloud, patch, settings, force))
        files.push_back(std::move(picture));
    return files;
}

/// Stiffnesses and thicknesses may be anything positive; their quotients must still be numbers.
void refuseOverflow(const nlohmann::json& report)
{
    for (const char* key :
         {"rigidity_at_contact", "compliance", "contact_stiffness", "felt_stiffness", "max_deflection"})
        if (!std::isfinite(report[key].get<double>()))
            throw Error(std::string("touch: ") + key + " is not finite; are stiffness, --thickness and --force right?");
}

void touch(const TouchOptions& options)
{
    const Material      material = materialOf(options);
    const PatchSettings settings = settingsOf(options);
    const double        force    = between(-kMostForce, kMostForce, "N",
                                           parseQuantity(options.force, Dimension::force, "--force"), "--force", options.force);
    const LoadedCloud   loaded   = options.source.load();
    const SoftObject    object(loaded.cloud, material);
    const Contact       contact = contactOf(options, object, settings.window);
    PlateSolver         device  = options.solver.open();
    const auto          told    = device.note();
    const Patch         patch   = deform(object, contact, settings, device);
    if (device.note() != told) std::cerr << "palpate: the reference solver took over: " << device.note() << "\n";
    if (!patch.deformed())
        throw Error("touch: the " + std::to_string(patch.gathered.size()) +
                    " points around the contact do not determine a "
                    "surface (" +
                    name(patch.sphere.outcome) + "); try a larger --window, or check --unit");

    nlohmann::json report = patchJson(patch, material, settings, force, device);
    refuseOverflow(report);
    report["cloud"] = cloudJson(options.source, loaded);
    for (std::string& line : options.source.warnings(loaded)) report["warnings"].push_back(std::move(line));
    report["preset"] = options.preset;
    if (!options.out.empty()) {
        std::vector<std::string> files = writeFiles(options, loaded.cloud, patch, settings, force);
        files.emplace_back(kSummary);
        report["files"] = files;
        writeFileWhole(std::filesystem::path(options.out) / kSummary,
                       [&](std::ostream& file) { file << jsonText(report); });
    }
    if (options.json)
        std::cout << jsonText(report);
    else
        printTouch(options, object.material(), settings, report);
}

} // namespace

void addTouchCommand(CLI::App& app)
{
    CLI::App* command =
        app.add_subcommand("touch", "presses a scripted finger on a cloud: how far it gives, how it feels");
    const auto o = std::make_shared<TouchOptions>();
    o->source.addTo(*command);
    command->add_option("--at", o->at,
                        "place X,Y,Z, such as 10mm,0,35mm; plain numbers are in the unit of --unit (else m)");
    command->add_option("--from", o->from, "direction X,Y,Z from which the finger comes (else from outside)");
    command->add_option("--force", o->force, "that presses, such as 0.5N")->capture_default_str();
    command->add_option("--preset", o->preset, "palpate, or paper: as Kumari and Chaudhuri published it")
        ->capture_default_str();
    command->add_option("--thickness", o->thickness,
                        "of the sheet, such as 4mm; plain numbers of all lengths are in the unit of --unit (else m)");
    command->add_option("--poisson", o->poisson, "Poisson's ratio");
    command->add_option("--foundation", o->foundation, "stiffness of what lies below, such as 1.74MPa/m; 0 is nothing");
    command->add_option("--window", o->window, "edge of the square that bends, such as 40mm");
    command->add_option("--cells", o->cells, "of the grid along the window's edge, even (default 64)");
    command->add_option("--footprint", o->footprint, "radius of the fingertip, such as 4mm");
    command->add_option("--map", o->map, "lambert-azimuthal, lambert-cylindrical or gall-peters");
    command->add_option("--sampling", o->sampling, "rigidity of a node: log-mean or nearest");
    command->add_option("--edges", o->edges,
                        "of the window: clamped, supported, free, or such as x0=free,z1=supported, the others clamped");
    o->solver.addTo(*command);
    command->add_option("--force-law", o->forceLaw, "series (plate and contact) or paper (contact alone)");
    command->add_option(
        "--out", o->out,
        "folder for the deformed cloud, grids, pictures and touch.json; that comes last: a folder without it "
        "holds no whole set");
    command->add_flag("--json", o->json, "machine-readable, SI units");
    command->footer("Examples:\n"
                    "  palpate touch sample:skin --out touch\n"
                    "  palpate touch sample:ellipsoid --at 30mm,0,30mm --force 0.3N --preset paper --json\n"
                    "  palpate touch scan.ply --unit mm --at 12,0,30 --uniform 300kPa --thickness 3mm --window 30mm");
    command->callback([command, o] {
        refuseEmptyValues(*command);
        touch(*o);
    });
}

} // namespace palp
