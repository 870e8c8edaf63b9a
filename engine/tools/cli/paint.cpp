#include <algorithm>
#include <iostream>
#include <memory>
#include <utility>

#include <nlohmann/json.hpp>

#include "engine/cloud/ply_repaint.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/session/scene.h"
#include "engine/tools/cli/cloud_source.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/stroke.h"

// palpate paint: strokes of a brush over a cloud, without a window.

namespace palp {
namespace {

struct PaintOptions {
    CloudSource              source;
    std::vector<std::string> strokes;
    std::string              out;
    bool                     json = false;
};

/// What is painted, and how its file was read.
struct Canvas {
    explicit Canvas(LoadedCloud cloud) : loaded(std::move(cloud)) {}

    LoadedCloud              loaded;
    std::string              file; ///< empty: a sample
    CloudReadSettings        readAs;
    double                   metresPerPlainNumber = 1;
    std::vector<std::string> warnings;
};

/// The cloud of a scene, read by the scene's keys; --points, --seed, --unit and --stiffness stand over them.
Canvas canvasOfScene(const CloudSource& s)
{
    for (const auto& [option, given] : {std::pair{"--stiffness-property", !s.stiffnessProperty.empty()},
                                        {"--range", !s.range.empty()},
                                        {"--log-range", s.logRange},
                                        {"--stiffness-unit", !s.stiffnessUnit.empty()},
                                        {"--uniform", !s.uniform.empty()},
                                        {"--columns", !s.columns.empty()},
                                        {"--drop-invalid", s.dropInvalid}})
        if (given)
            throw Error(std::string(option) + ": expected a cloud, but " + s.name +
                        " is a scene, whose keys say how its cloud is read; leave it away or name the cloud");
    SceneOverrides overrides{{}, processEnvironment()};
    if (s.points) overrides.flags["points"] = std::to_string(*s.points);
    if (s.seed) overrides.flags["seed"] = std::to_string(*s.seed);
    if (!s.unit.empty()) overrides.flags["length_unit"] = s.unit;
    if (!s.law.empty()) overrides.flags["stiffness"] = s.law;
    const Scene scene = readScene(s.name, overrides);
    Canvas      canvas(loadCloud(scene));
    if (!scene.cloud.starts_with("sample:")) canvas.file = scene.cloud;
    canvas.readAs.lengthUnit = scene.lengthUnit;
    if (!scene.stiffness.empty())
        canvas.warnings.push_back("the scene's law is painted over here, but in a session it would replace what is "
                                  "painted: take the key \"stiffness\" out of a scene of the new cloud");
    return canvas;
}

Canvas canvasOf(const CloudSource& source)
{
    if (source.name.ends_with(".json")) return canvasOfScene(source);
    Canvas canvas(source.load());
    canvas.metresPerPlainNumber = source.metresPerPlainNumber();
    canvas.warnings             = source.warnings(canvas.loaded);
    if (source.sample()) return canvas;
    canvas.file   = source.name;
    canvas.readAs = source.readSettings();
    return canvas;
}

bool isPly(const std::string& file)
{
    return !file.empty() && holdsFaces(file);
}

/// Writes the file of the source once more, or a new one where that cannot be; says how the stiffness is found in it.
RepaintedPly write(const PaintOptions& o, const Canvas& canvas, const PointCloud& painted)
{
    if (isPly(canvas.file) && isPly(o.out)) return repaintPly(canvas.file, canvas.readAs, painted, o.out);
    writeCloud(o.out, painted, {}, {CloudEncoding::binaryLittleEndian, canvas.loaded.faces});
    return {painted.kind() == StiffnessKind::modulus ? "stiffness" : "flexural_rigidity", true};
}

nlohmann::json jsonOf(const StrokeOrder& order, const StrokeReport& report)
{
    nlohmann::json path = nlohmann::json::array();
    for (const glm::dvec3& p : order.path) path.push_back({p.x, p.y, p.z});
    return {{"path", path},
            {"radius", order.radius},
            {"strength", order.strength},
            {"value", order.value ? nlohmann::json(*order.value) : nlohmann::json()},
            {"smooth", !order.value},
            {"dabs", report.dabs},
            {"points", report.points}};
}

void paint(const PaintOptions& o)
{
    static_cast<void>(holdsFaces(o.out)); // a name of no format is the first thing to say
    Canvas canvas = canvasOf(o.source);
    refuseSourceAsTarget("--out", canvas.file.empty() ? o.source.name : canvas.file, o.out);
    const SoftObject         object(canvas.loaded.cloud);
    const PointCloud&        cloud = object.cloud();
    const std::string        unit  = cloud.kind() == StiffnessKind::modulus ? "Pa" : "N m";
    std::vector<StrokeOrder> orders;
    const auto               what = [](std::size_t k) { return "--stroke " + std::to_string(k + 1); };
    for (std::size_t k = 0; k < o.strokes.size(); ++k)
        orders.push_back(parseStroke(o.strokes[k], what(k), canvas.metresPerPlainNumber, cloud.kind()));

    StiffnessPainting painting(object);
    nlohmann::json    strokes = nlohmann::json::array();
    std::string       lines;
    for (std::size_t k = 0; k < orders.size(); ++k) {
        const StrokeReport report = paintStroke(orders[k], what(k), object, painting);
        strokes.push_back(jsonOf(orders[k], report));
        lines += "  stroke " + std::to_string(k + 1) + "    " + std::to_string(report.dabs) + " dabs over " +
                 std::to_string(report.points) + " points, " +
                 (orders[k].value ? "towards " + formatQuantity(*orders[k].value, unit) : "smoothing") + "\n";
    }
    const PointCloud   painted = painting.cloud();
    const RepaintedPly written = write(o, canvas, painted);
    std::size_t        changed = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) changed += painted.stiffness()[i] != cloud.stiffness()[i] ? 1 : 0;
    if (changed == 0) canvas.warnings.emplace_back("no stroke changed anything");
    const bool kept = isPly(canvas.file) && isPly(o.out); // what the original had
    if (!written.appended && !o.source.stiffnessProperty.empty())
        canvas.warnings.push_back("the stiffness is where it was: read it with --stiffness-property " +
                                  written.property + ", and without --range");
    const auto [least, most] = std::minmax_element(painted.stiffness().begin(), painted.stiffness().end());
    if (o.json) {
        std::cout << jsonText(nlohmann::json{{"name", o.source.name},
                                             {"points", cloud.size()},
                                             {"changed_points", changed},
                                             {"strokes", strokes},
                                             {"stiffness_unit", unitOf(cloud.kind())},
                                             {"stiffness_min", *least},
                                             {"stiffness_max", *most},
                                             {"written", o.out},
                                             {"property", written.property},
                                             {"appended", written.appended},
                                             {"original_kept", kept},
                                             {"warnings", canvas.warnings}});
        return;
    }
    std::cout << o.out << ": " << cloud.size() << " points, " << changed << " with another stiffness\n"
              << lines << "  stiffness   " << formatQuantity(*least, unit) << " to " << formatQuantity(*most, unit)
              << ", property " << written.property
              << (kept ? ", all else as in " + canvas.file : std::string(", in a new file in metres")) << "\n";
    for (const std::string& line : canvas.warnings) std::cout << "  warning     " << line << "\n";
}

} // namespace

void addPaintCommand(CLI::App& app)
{
    CLI::App* command = app.add_subcommand(
        "paint", "paints stiffness onto a cloud, or that of a scene (SCENE.json), with a round brush");
    const auto options = std::make_shared<PaintOptions>();
    options->source.addTo(*command);
    command->get_option("CLOUD")->description(
        "a .ply, .pcd, .xyz, .txt or .csv file, sample:NAME, or a scene that ends in .json");
    command
        ->add_option("--stroke", options->strokes,
                     "a stroke of the brush, once for each:\n"
                     "  at        X,Y,Z in the middle, on the surface; or a path X,Y,Z;X,Y,Z;...\n"
                     "  radius    where the brush ends; its effect falls smoothly from the middle to there\n"
                     "  value     the stiffness it goes towards, by equal factors; or in its place\n"
                     "  smooth    towards the mean around each point\n"
                     "  strength  share of the way that the stroke goes in the middle, up to 1 [1]")
        ->required()
        ->allow_extra_args(false);
    command
        ->add_option("--out", options->out,
                     "the painted cloud; a .ply from a .ply keeps everything but the stiffness as it is")
        ->required();
    command->add_flag("--json", options->json, "machine-readable report, SI units");
    command->footer(
        "Only the side that the brush is on is painted, if the other one is three point spacings away.\n"
        "Examples:\n"
        "  palpate paint sample:palm --stroke 'at=14mm,5mm,0 radius=6mm value=2MPa' --out palm.ply\n"
        "  palpate paint scan.ply --unit mm --stroke 'at=12,0,30;15,2,30;18,5,29 radius=3 value=1MPa strength=0.5' \\\n"
        "    --stroke 'at=12,0,30 radius=8 smooth' --out painted.ply\n"
        "  palpate paint samples/scenes/palm.json --stroke 'at=0,0,0 radius=1cm smooth' --out smoother.ply --json");
    command->callback([command, options] {
        refuseEmptyValues(*command);
        paint(*options);
    });
}

} // namespace palp
