#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/pipeline/deform.h"
#include "engine/pipeline/patch_warnings.h"
#include "engine/pipeline/press.h"
#include "engine/session/drawn_load.h"
#include "engine/session/virtual_session.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/hand_source.h"
#include "engine/tools/cli/named_option.h"
#include "engine/tools/cli/scene_source.h"
#include "engine/tools/cli/solver_choice.h"
#include "engine/tools/render/annotation.h"
#include "engine/tools/render/surface_renderer.h"
#include "engine/tools/render/touch_view.h"

// palpate render: pictures of a touched object, without a display.

namespace palp {
namespace {

/// What the camera of a picture sees.
enum class Shot { patch, whole };
constexpr auto namesOf(Shot)
{
    using enum Shot;
    return std::to_array<NamedValue<Shot>>({{patch, "patch"}, {whole, "whole"}});
}

struct RenderOptions {
    SceneSource        scene;
    std::string        force, size = "1600x1200", out;
    std::string        colour = "deflection", map = "viridis", exaggerate = "1";
    std::string        drawOn = "auto", view = name(Shot::patch);
    HandOptions        hand{.seconds = "2 s"};
    std::optional<int> frames;
    int                finer = 2;
    bool               dark = false, json = false, ghost = false, sphere = false, projected = false, curvature = false;
};

PictureSize sizeOf(const RenderOptions& o)
{
    const auto [width, height] = pixelsOf(o.size, 16, 4096);
    return {width, height, o.finer};
}

TouchLook lookOf(const RenderOptions& o)
{
    TouchLook look;
    look.paint              = optionNamed<ViewPaint>("--colour", o.colour);
    look.map                = optionNamed<ColourMap>("--colour-map", o.map);
    look.ground             = o.dark ? Ground::dark : Ground::light;
    look.overlays.ghost     = o.ghost;
    look.overlays.sphere    = o.sphere;
    look.overlays.projected = o.projected;
    look.overlays.curvature = o.curvature;
    look.exaggeration       = parseQuantity(o.exaggerate, Dimension::none, "--exaggerate");
    if (!(look.exaggeration >= 0 && look.exaggeration <= 1000))
        throw Error("--exaggerate: expected a factor from 0 to 1000, found \"" + o.exaggerate + "\"");
    return look;
}

/// The touched and drawn object with its renderer, made once.
struct Stage {
    explicit Stage(const RenderOptions& o)
        : size(sizeOf(o)), look(lookOf(o)), scene(o.scene.load()), renderer({.processor = o.drawOn}),
          loaded(o.scene.loadObject(scene)), solver(openSolver(scene.solver)), told(solver.counts().takeovers),
          view(loaded.object, scene.patch)
    {
        sayPassedOver(renderer.processor().name, renderer.note());
        scene.patch = settledFor(loaded.object, scene.patch);
        if (look.overlays.curvature && scene.patch.theory != Theory::shell)
            throw Error("--curvature: shows what a shell bent with; add --theory shell");
    }
    PictureSize     size;
    TouchLook       look;
    Scene           scene;
    SurfaceRenderer renderer; // before the cloud, so that a missing processor is reported at once
    LoadedObject    loaded;
    PlateSolver     solver;
    int             told; ///< takeovers, see sayTakeovers()
    TouchView       view;
    std::string     takeover{}; ///< in the session of a film, see sayTakeovers()
};

Patch patchAt(Stage& stage, const Contact& contact)
{
    Patch patch = deform(stage.loaded.object, contact, stage.scene.patch, stage.solver);
    demandDeformed(patch);
    return patch;
}

Camera cameraFor(const RenderOptions& o, const Stage& stage, const Patch& patch)
{
    const double aspect = double(stage.size.width) / stage.size.height;
    const Camera camera = cameraAt(patch, aspect);
    if (optionNamed<Shot>("--view", o.view) == Shot::patch) return camera;
    const Bounds& bounds = stage.loaded.object.cloud().bounds();
    return framed(camera, bounds.centre(), 0.5 * bounds.diagonal(), aspect);
}

double deepestOf(const Patch& patch, double load)
{
    return load * mostResponse(patch);
}

std::string noteOf(const Stage& stage, const Patch& patch, double force, double load)
{
    std::string note = formatQuantity(force, "N") + ", " + formatQuantity(deepestOf(patch, load), "m") + " deep in " +
                       formatQuantity(stage.scene.material.thickness, "m");
    if (stage.look.exaggeration != 1) note += ", displacement \u00d7 " + shortNumber(stage.look.exaggeration);
    return note;
}

struct Written {
    std::string file;
    double      force = 0, deepest = 0, milliseconds = 0; ///< [N], [m], of drawing [ms]
};

/// Draws the view and writes the picture.
Written write(Stage& stage, const Camera& camera, const std::filesystem::path& file)
{
    const auto start = std::chrono::steady_clock::now();
    Image      image = stage.renderer.draw(stage.view.scene(), camera, stage.size);
    const auto end   = std::chrono::steady_clock::now();
    annotate(image, stage.view.scene(), camera);
    const std::string bytes = encodePng(image);
    writeFileWhole(file, [&](std::ostream& stream) { stream << bytes; });
    return {file.string(), 0, 0, std::chrono::duration<double, std::milli>(end - start).count()};
}

/// Draws a touch at the scene's place.
/// \param said  gets what there is to say of the touch
Written still(const RenderOptions& o, Stage& stage, std::vector<std::string>& said)
{
    const Patch  patch = patchAt(stage, contactOf(stage.scene, stage.loaded.object));
    const double force = o.force.empty() ? forceThatShows(patch, stage.scene.material.thickness) : forceOf(o.force);
    const double load  = pressOf(patch, stage.scene.material, force).load;
    stage.view.show(&patch, force, stage.look, {}, load);
    stage.view.scene().title = o.scene.title();
    stage.view.scene().note  = noteOf(stage, patch, force, load);
    Written written          = write(stage, cameraFor(o, stage, patch), o.out);
    written.force            = force;
    written.deepest          = deepestOf(patch, load);
    warn(warnings(patch, stage.scene.patch, force, stage.scene.material), said);
    return written;
}

/// A session of a hand, at some of its times.
struct Filmed {
    std::vector<TickRecord> records;
    bool                    turns = false; ///< the hand's orientation is known
};

/// Returns the session at evenly spread times, from the first to the last tick.
Filmed recordsOf(const RenderOptions& o, Stage& stage, int frames, std::vector<std::string>& said)
{
    HandOptions hand          = o.hand;
    hand.metresPerPlainNumber = metresPerPlainNumber(o.scene, stage.scene);
    SessionHand source        = handFor(hand, stage.scene, stage.loaded.object);
    if (source.isHeldByPerson())
        throw Error("--hand " + hand.hand + ": a person holds it; --frames needs a scripted hand");
    warn(source.warnings, said);
    Deformation             deformation(stage.loaded.object, stage.scene);
    const SessionParts      parts{stage.scene,    stage.loaded.object, deformation.solver(),
                             *source.device, source.frame,        deformation.firstLaw()};
    std::vector<TickRecord> all;
    static_cast<void>(runVirtual(parts, source.seconds, [&](const TickRecord& s) { all.push_back(s); }));
    stage.takeover = deformation.plateSolver().takeoverSince(0);
    if (all.empty()) throw Error("--seconds: expected a hand of at least a millisecond");
    Filmed film{{}, source.device->info().rotates};
    for (int n = 0; n < frames; ++n)
        film.records.push_back(all[std::size_t(std::llround(double(all.size() - 1) * (n + 1) / frames))]);
    return film;
}

/// Returns "film_0003.png" for "film.png", 3.
std::filesystem::path frameFile(const std::filesystem::path& out, int number)
{
    char text[16];
    std::snprintf(text, sizeof text, "_%04d", number);
    return out.parent_path() / (out.stem().string() + text + out.extension().string());
}

/// Draws the session of a scripted hand in virtual time, with one camera and one scale of colours for all pictures.
std::vector<Written> film(const RenderOptions& o, Stage& stage, std::vector<std::string>& said)
{
    const Patch        middle  = patchAt(stage, contactOf(stage.scene, stage.loaded.object));
    const Camera       camera  = cameraFor(o, stage, middle);
    const Filmed       film    = recordsOf(o, stage, *o.frames, said);
    const auto&        records = film.records;
    std::vector<Patch> patches;
    const auto         loadOf = [&](const TickRecord& s, const Patch* patch) {
        return drawnLoad(s, patch, stage.scene.material);
    };
    TouchLook look = stage.look;
    for (const TickRecord& s : records) {
        const double force = glm::length(s.force);
        if (force > 0) patches.push_back(patchAt(stage, {s.proxy, s.normal}));
        look.strongest = std::max(look.strongest, force);
        if (force > 0) look.deepest = std::max(look.deepest, deepestOf(patches.back(), loadOf(s, &patches.back())));
    }
    Progress             progress("drawing");
    std::vector<Written> written;
    auto                 patch = patches.begin();
    for (std::size_t n = 0; n < records.size(); ++n) {
        const TickRecord& s     = records[n];
        const double      force = glm::length(s.force);
        const Patch*      bent  = force > 0 ? &*patch++ : nullptr;
        const double      load  = loadOf(s, bent);
        stage.view.show(bent, force, look,
                        {{s.hip, s.force, {}, film.turns ? std::optional(s.orientation) : std::nullopt}}, load);
        stage.view.scene().title = o.scene.title();
        stage.view.scene().note  = formatQuantity(s.time, "s") + ", " + formatQuantity(force, "N");
        written.push_back(write(stage, camera, frameFile(o.out, int(n) + 1)));
        written.back().force   = force;
        written.back().deepest = bent ? deepestOf(*bent, load) : 0;
        progress.at(n + 1, records.size());
    }
    return written;
}

void tell(const RenderOptions& o, const Stage& stage, const std::vector<Written>& written,
          const std::vector<std::string>& said, const std::string& takeover)
{
    if (o.json) {
        nlohmann::ordered_json all;
        all["scene"]     = o.scene.name;
        all["points"]    = stage.loaded.object.cloud().size();
        all["size"]      = {stage.size.width, stage.size.height};
        all["drawn_on"]  = stage.renderer.processor().name;
        all["solved_on"] = stage.solver.name();
        all["takeover"]  = orNull(takeover);
        all["warnings"]  = said;
        for (const Written& w : written)
            all["pictures"].push_back({{"file", w.file},
                                       {"force", w.force},
                                       {"max_deflection", w.deepest},
                                       {"milliseconds", w.milliseconds}});
        std::cout << jsonText(all);
        return;
    }
    for (const Written& w : written)
        std::printf("%s: %s, %s deep, drawn in %.0f ms on %s\n", w.file.c_str(), formatQuantity(w.force, "N").c_str(),
                    formatQuantity(w.deepest, "m").c_str(), w.milliseconds, stage.renderer.processor().name.c_str());
}

void render(const RenderOptions& o)
{
    if (std::filesystem::path(o.out).extension() != ".png")
        throw Error("--out: expected a file that ends in .png, found \"" + o.out + "\"");
    expectWritable(o.out);
    constexpr int kMostFrames = 9999;
    if (o.frames && (*o.frames < 1 || *o.frames > kMostFrames))
        throw Error("--frames: expected 1 to 9999, found " + std::to_string(*o.frames));
    if (o.frames && !o.force.empty())
        throw Error("--force: with --frames the hand decides how hard it presses; omit one of the two");
    Stage stage(o);
    if (!o.frames) refuseSourcesAsTarget(o.scene, stage.scene, "--out", o.out);
    for (int n = 1; n <= o.frames.value_or(0); ++n)
        refuseSourcesAsTarget(o.scene, stage.scene, "--out", frameFile(o.out, n).string());
    std::vector<std::string> said;
    warn(cloudWarnings(stage.scene, stage.loaded.object.cloud(), stage.loaded.report), said);
    const auto written = o.frames ? film(o, stage, said) : std::vector{still(o, stage, said)};
    tell(o, stage, written, said, sayTakeovers(stage.solver, stage.told, stage.takeover));
}

} // namespace

void addRenderCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("render", "draws pictures of a touched object, without a display");
    const auto o       = std::make_shared<RenderOptions>();
    command->add_option("--out", o->out, "PNG file; with --frames a number is added before .png")->required();
    command->add_option("--size", o->size, "size of the picture [px]")->capture_default_str();
    command
        ->add_option("--finer", o->finer,
                     "factor by which the picture is drawn larger, then averaged, for smooth edges")
        ->check(CLI::Range(1, 4))
        ->capture_default_str();
    command->add_option("--force", o->force,
                        "force that presses, such as '1 N' [the force that dents by a third of the thickness]");
    command->add_option("--colour,--color", o->colour, "quantity in colours: " + wordsOf<ViewPaint>())
        ->capture_default_str();
    command->add_option("--colour-map,--color-map", o->map, "map of colours: " + wordsOf<ColourMap>())
        ->capture_default_str();
    command->add_option("--exaggerate", o->exaggerate, "factor on every displacement")->capture_default_str();
    command
        ->add_option("--view", o->view,
                     std::string(name(Shot::patch)) + ": the part that bends; " + name(Shot::whole) + ": the object")
        ->capture_default_str();
    command->add_flag("--dark", o->dark, "draws on a dark ground");
    command->add_flag("--ghost", o->ghost, "adds dots where the dented points are at rest");
    command->add_flag("--sphere", o->sphere, "adds the near half of the fitted sphere");
    command->add_flag("--projected", o->projected, "adds dots where the points lie on that sphere");
    command->add_flag("--curvature", o->curvature,
                      "adds crosses along the principal curvatures that a shell bent with; needs --theory shell");
    command->add_option("--frames", o->frames, "number of pictures along the path of --hand, in virtual time");
    command->add_option("--hand", o->hand.hand, "hand for --frames: " + generatedHands() + ", or a file")
        ->capture_default_str();
    command->add_option("--seconds", o->hand.seconds, "time that the hand moves, for --frames")->capture_default_str();
    addHandOptions(*command, o->hand, {});
    command->add_option("--draw-on", o->drawOn, "Vulkan processor that draws, as \"palpate devices\" names it")
        ->capture_default_str();
    command->add_flag("--json", o->json, "machine-readable, SI units");
    o->scene.addTo(*command, SceneKey::Group::session);
    command->footer("Examples:\n"
                    "  palpate render sample:ear-lobe --out lobe.png\n"
                    "  palpate render samples/scenes/skin_wart.json --force '1 N' --colour stiffness --out wart.png\n"
                    "  palpate render scan.ply --length-unit mm --place 12,0,30 --size 800x600 --dark --out scan.png\n"
                    "  palpate render samples/scenes/palm.json --frames 50 --out film.png");
    command->callback([command, o] {
        demandOwner(*command, "--frames", {"--hand", "--seconds", "--speed", "--press-depth", "--reach", "--arm"});
        render(*o);
    });
}

} // namespace palp
