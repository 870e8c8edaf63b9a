#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/cloud/ply_repaint.h"
#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/quantity.h"
#include "engine/session/scene_mesh.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/scene_source.h"
#include "engine/tools/cli/stroke.h"

// palpate paint: strokes of a brush over a cloud, without a window.

namespace palp {
namespace {

struct PaintOptions {
    SceneSource              source;
    std::vector<std::string> strokes;
    std::string              out;
    bool                     json = false;
};

/// The painted cloud, and how its file was read.
struct Canvas {
    explicit Canvas(const SceneSource& source)
        : scene(withPointsOfFile(source.load())), loaded(source.loadCloud(scene)),
          file(isSample(scene) ? "" : scene.cloud), warnings(cloudWarnings(scene, loaded.cloud, loaded.report))
    {
        if (!scene.stiffness.empty() && source.name.ends_with(".json"))
            warnings.emplace_back(
                "the scene's law of stiffness is painted over here, but in a session it would replace "
                "the paint: take the key \"stiffness\" out of a scene of the new cloud");
    }

    Scene                    scene;
    LoadedCloud              loaded;
    std::string              file; ///< empty: a sample
    std::vector<std::string> warnings;
};

bool isPly(const std::string& file)
{
    return !file.empty() && formatToRead(file).format == CloudFormat::ply;
}

/// Numbers of the points beside their stiffness.
struct PaintedField {
    std::vector<double> values;            ///< empty: the source has none
    bool                isPainted = false; ///< by a stroke
    std::size_t         changed   = 0;     ///< points with another value
};

/// What the strokes make.
struct Painted {
    PointCloud   cloud;
    std::size_t  changed = 0; ///< points with another stiffness
    PaintedField stiffening;  ///< [1/m]
    PaintedField held;        ///< share that is held [1]

    [[nodiscard]] bool hasNewFields() const { return stiffening.isPainted || held.isPainted; }
};

/// Returns true if the new file is the original with another stiffness.
bool keepsOriginal(const PaintOptions& o, const Canvas& canvas, const Painted& painted)
{
    return isPly(canvas.file) && isPly(o.out) && canvas.loaded.report.scatteredPoints == 0 && !painted.hasNewFields();
}

/// Writes the source's file with the new stiffness, or else a new file.
/// \return how the stiffness is found in it
RepaintedPly write(const PaintOptions& o, const Canvas& canvas, const Painted& painted)
{
    if (keepsOriginal(o, canvas, painted)) return repaintPly(canvas.file, canvas.scene.reading, painted.cloud, o.out);
    writeCloud(o.out, painted.cloud, FieldsBeside(canvas.loaded, painted.stiffening.values).all(),
               {CloudEncoding::binaryLittleEndian, canvas.loaded.faces});
    return {propertyOf(painted.cloud.kind()), true};
}

/// A field while it is painted, as numbers above zero, which a brush brings from one to another by equal factors.
class FieldPainting {
public:
    using Map = double (*)(double) noexcept;

    FieldPainting(const SoftObject& object, std::span<const double> values, Map above, Map back)
        : values_(values.begin(), values.end()), back_(back), before_(object.size(), 1)
    {
        std::ranges::transform(values_, before_.begin(), above);
        shown_.emplace(object.repainted(before_));
        painting_.emplace(*shown_);
    }

    [[nodiscard]] StiffnessPainting& painting() noexcept { return *painting_; }
    [[nodiscard]] PaintedField       result() const
    {
        PaintedField field{values_, painting_->changed()};
        if (!field.isPainted) return field;
        field.values.resize(before_.size());
        for (std::size_t i = 0; i < before_.size(); ++i) {
            if (painting_->stiffness()[i] == before_[i]) continue; // what was not painted keeps its bits
            field.values[i] = back_(painting_->stiffness()[i]);
            ++field.changed;
        }
        return field;
    }

private:
    std::vector<double>              values_;
    Map                              back_;
    std::vector<double>              before_;
    std::optional<SoftObject>        shown_;
    std::optional<StiffnessPainting> painting_;
};

nlohmann::json jsonOf(const StrokeOrder& order, const StrokeReport& report)
{
    nlohmann::json path = nlohmann::json::array();
    for (const glm::dvec3& p : order.path) path.push_back({p.x, p.y, p.z});
    return {{"path", path},
            {"radius", order.radius},
            {"strength", order.strength},
            {"value", order.value ? nlohmann::json(*order.value) : nlohmann::json()},
            {"stiffening", order.stiffening ? nlohmann::json(*order.stiffening) : nlohmann::json()},
            {"held", order.held ? nlohmann::json(*order.held) : nlohmann::json()},
            {"smooth", !order.value && !order.stiffening && !order.held},
            {"dabs", report.dabs},
            {"points", report.points}};
}

/// Returns the unit of a stiffness as people read it.
std::string shownUnit(StiffnessKind kind)
{
    return kind == StiffnessKind::rigidity ? "N m" : unitOf(kind);
}

/// The strokes of one command as they were painted, for people and for scripts.
struct StrokeAccount {
    std::string    lines;
    nlohmann::json json = nlohmann::json::array();

    void add(const StrokeOrder& order, const StrokeReport& report, const std::string& unit)
    {
        json.push_back(jsonOf(order, report));
        lines += "  stroke " + std::to_string(json.size()) + "    " + counted(report.dabs, "dab") + " over " +
                 counted(report.points, "point") + ", " +
                 (order.value        ? "towards " + formatQuantity(*order.value, unit)
                  : order.stiffening ? "stiffening towards " + formatQuantity(*order.stiffening, "1/m")
                  : order.held       ? "held towards " + shortNumber(*order.held)
                                     : "smoothing") +
                 "\n";
    }
};

/// Says what a reader of the new file has to know.
void addWarnings(const PaintOptions& o, Canvas& canvas, const Painted& painted, const RepaintedPly& written)
{
    if (painted.changed + painted.stiffening.changed + painted.held.changed == 0)
        canvas.warnings.emplace_back("no stroke changed anything");
    if (!keepsOriginal(o, canvas, painted))
        for (std::string& line : leftUnwritten(canvas.loaded, formatToWrite(o.out)))
            canvas.warnings.push_back(std::move(line));
    if (painted.held.isPainted)
        canvas.warnings.emplace_back("what is held counts where a scene says --held own and --window object");
    if (!written.appended && !canvas.scene.reading.stiffnessProperty.empty())
        canvas.warnings.push_back("the stiffness keeps its property: read it with --stiffness-property " +
                                  written.property + ", and without --stiffness-range");
}

void print(const PaintOptions& o, const Canvas& canvas, const Painted& painted, const RepaintedPly& written,
           const StrokeAccount& strokes)
{
    const PointCloud& cloud  = painted.cloud;
    const std::string unit   = shownUnit(cloud.kind());
    const bool        kept   = keepsOriginal(o, canvas, painted);
    const auto [least, most] = std::ranges::minmax_element(cloud.stiffness());
    if (o.json) {
        std::cout << jsonText(nlohmann::json{{"name", o.source.name},
                                             {"points", cloud.size()},
                                             {"changed_points", painted.changed},
                                             {"stiffened_points", painted.stiffening.changed},
                                             {"held_points", painted.held.changed},
                                             {"strokes", strokes.json},
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
    std::cout << o.out << ": " << cloud.size() << " points, " << painted.changed << " with another stiffness"
              << (painted.stiffening.isPainted
                      ? ", " + std::to_string(painted.stiffening.changed) + " with another stiffening"
                      : "")
              << (painted.held.isPainted ? ", " + std::to_string(painted.held.changed) + " held otherwise" : "") << "\n"
              << strokes.lines << "  stiffness   " << formatQuantity(*least, unit) << " to "
              << formatQuantity(*most, unit) << ", property " << written.property
              << (kept ? ", all else as in " + canvas.file : std::string(", in a new file in metres")) << "\n";
    for (const std::string& line : canvas.warnings) std::cout << "  warning     " << line << "\n";
}

void paint(const PaintOptions& o)
{
    static_cast<void>(formatToWrite(o.out)); // first, refuses a name of no known format
    Canvas canvas(o.source);
    refuseSourceAsTarget("--out", canvas.file.empty() ? o.source.name : canvas.file, o.out);
    const SoftObject         object(canvas.loaded.cloud, {}, canvas.loaded.faces, canvas.loaded.normals);
    const PointCloud&        cloud  = object.cloud();
    const std::string        unit   = shownUnit(cloud.kind());
    const double             metres = metresPerPlainNumber(o.source, canvas.scene);
    std::vector<StrokeOrder> orders;
    const auto               what = [](std::size_t k) { return "--stroke " + std::to_string(k + 1); };
    for (std::size_t k = 0; k < o.strokes.size(); ++k)
        orders.push_back(parseStroke(o.strokes[k], what(k), metres, cloud.kind()));

    StiffnessPainting painting(object);
    FieldPainting     stiffening(object, canvas.loaded.stiffening, growthOf, stiffeningOf);
    FieldPainting     held(object, canvas.loaded.held, holdOf, heldOf);
    StrokeAccount     strokes;
    for (std::size_t k = 0; k < orders.size(); ++k) {
        StiffnessPainting& canvasOf = orders[k].stiffening ? stiffening.painting()
                                      : orders[k].held     ? held.painting()
                                                           : painting;
        strokes.add(orders[k], paintStroke(orders[k], what(k), object, canvasOf), unit);
    }
    Painted painted{painting.cloud(), 0, stiffening.result(), held.result()};
    for (std::size_t i = 0; i < cloud.size(); ++i)
        painted.changed += painted.cloud.stiffness()[i] != cloud.stiffness()[i] ? 1 : 0;
    canvas.loaded.held         = painted.held.values;
    const RepaintedPly written = write(o, canvas, painted);
    addWarnings(o, canvas, painted, written);
    print(o, canvas, painted, written, strokes);
}

} // namespace

void addPaintCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("paint", "paints stiffness onto a cloud with a round brush");
    const auto options = std::make_shared<PaintOptions>();
    options->source.addTo(*command, SceneKey::Group::object);
    command
        ->add_option(
            "--stroke", options->strokes,
            "a stroke of the brush; may be repeated:\n"
            "  at        its middle X,Y,Z on the surface, or a path X,Y,Z;X,Y,Z;...\n"
            "  radius    of the brush; its effect falls smoothly from the middle to this distance\n"
            "  value     stiffness that it approaches, by equal factors; or instead of it\n"
            "  stiffening  how the force grows with depth, b [1/m], that it approaches; or instead of both\n"
            "  held      1 where something holds the object and it cannot bend, 0 where it is free; or instead\n"
            "  smooth    approaches the mean around each point\n"
            "  strength  share of the way that it goes in the middle, up to 1 [1]")
        ->required()
        ->allow_extra_args(false);
    command
        ->add_option("--out", options->out,
                     "file for the painted cloud; a .ply painted from a .ply keeps everything but the stiffness")
        ->required();
    command->add_flag("--json", options->json, "machine-readable report, SI units");
    command->footer(
        "Only the side under the brush is painted. Where faces or normals do not tell the sides, the other one has to "
        "be\n"
        "half a point spacing away.\n"
        "Examples:\n"
        "  palpate paint sample:palm --stroke 'at=14mm,5mm,0 radius=6mm value=2MPa' --out palm.ply\n"
        "  palpate paint scan.ply --length-unit mm --stroke 'at=12,0,30;15,2,30;18,5,29 radius=3 value=1MPa "
        "strength=0.5' \\\n"
        "    --stroke 'at=12,0,30 radius=8 smooth' --out painted.ply\n"
        "  palpate paint sample:palm --stroke 'at=0,0,0 radius=1cm stiffening=800' --out stiffens.ply\n"
        "  palpate paint lobe.ply --stroke 'at=0,9mm,0 radius=8mm held=1' --out rooted.ply\n"
        "  palpate paint samples/scenes/palm.json --stroke 'at=0,0,0 radius=1cm smooth' --out smoother.ply --json");
    command->callback([options] { paint(*options); });
}

} // namespace palp
