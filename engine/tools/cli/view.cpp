#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "device/hid/hid_records.h"
#include "device/hid/hidapi_system.h"
#include "device/homing.h"
#include "device/mouse_device.h"
#include "engine/cloud/samples.h"
#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/quantity.h"
#include "engine/core/shown_text.h"
#include "engine/session/interrupt.h"
#include "engine/session/marker_input.h"
#include "engine/session/scene_keys.h"
#include "engine/tools/cli/cloud_report.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/hand_source.h"
#include "engine/tools/cli/hunt_report.h"
#include "engine/tools/cli/named_option.h"
#include "engine/tools/cli/scene_source.h"
#include "engine/tools/cli/session_run.h"
#include "engine/tools/gui/glfw_display.h"
#include "engine/tools/gui/glfw_window.h"
#include "engine/tools/gui/panel_frame.h"
#include "engine/tools/gui/window_memory.h"
#include "engine/tools/gui/workbench.h"

// palpate view: an object in a window, touched with the pointer or with any other hand.

namespace palp {
namespace {

struct ViewOptions {
    HandOptions              hand;
    std::string              drawOn = "auto", colour = "stiffness", map = "viridis", size;
    SceneSource              scene{"sample:palm", {}};
    std::string              command;
    std::vector<std::string> streams{};
    std::string              markers{}; ///< an address where markers are awaited; empty: none
    bool                     dark = false, json = false, noPanels = false, validate = false;
};

/// Returns whether SCENE is the folder of a recorded session.
bool isFolder(const std::string& scene)
{
    std::error_code hidden; // reading says why
    return std::filesystem::is_directory(scene, hidden);
}

#ifdef PALPATE_WINDOW

/// Returns the size that is asked for, or the window's last one [px].
glm::ivec2 sizeOf(const std::string& text)
{
    if (text.empty()) return rememberedSize();
    const auto [width, height] = pixelsOf(text, 320, 8192);
    return {width, height};
}

double quantileOf(std::vector<double> values, double share)
{
    if (values.empty()) return 0;
    const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
    std::ranges::nth_element(values, at);
    return *at;
}

void tell(const ViewOptions& o, const WorkbenchReport& report, const SurfaceRenderer& renderer,
          const std::optional<study::HuntScore>& score)
{
    const double median = quantileOf(report.frameTimes, 0.5), slow = quantileOf(report.frameTimes, 0.99);
    if (o.json) {
        nlohmann::json all{{"frames", report.frames},
                           {"touching_frames", report.frameTimes.size()},
                           {"frame_p50_s", median},
                           {"frame_p99_s", slow},
                           {"draw_p50_s", quantileOf(report.drawTimes, 0.5)},
                           {"real_time", report.realTime},
                           {"drawn_on", renderer.processor().name}};
        if (score) all["hunt"] = jsonOf(*score);
        std::cout << jsonText(all);
        return;
    }
    std::cout << report.frames << " pictures on " << renderer.processor().name;
    if (median > 0)
        std::cout << "; while touching one every " << formatQuantity(median, "s") << " (99 % within "
                  << formatQuantity(slow, "s") << ")";
    std::cout << "\n";
}

/// Says what was sent and what was dropped, beside a report for scripts on standard error.
void tellStreams(const std::vector<std::unique_ptr<TickStream>>& streams, bool json)
{
    for (const auto& stream : streams) (json ? std::cerr : std::cout) << sentenceOf(stream->finish()) << "\n";
}

SessionInfo infoOf(const ViewOptions& o, const Stage& stage, const HapticDevice& device)
{
    SessionInfo info;
    info.scene    = stage.scene();
    info.versions = {{"palpate", PALPATE_VERSION}, {"compiler", __VERSION__}, {"libraries", PALPATE_LIBRARIES}};
    info.solver   = stage.solvedOn();
    info.clock    = SessionClock::real;
    info.command  = o.command;
    info.cloud    = fingerprint(stage.object().cloud());
    info.hand     = device.info();
    return info;
}

/// Opens a SpaceMouse to move the camera, unless it is the hand.
std::unique_ptr<SpaceMouse> capFor(const ViewOptions& o, HidSystem& system)
{
    if (deviceNamed(o.hand.hand) == &kSpaceMouseRecord) return nullptr;
    try {
        for (const HidListing& listing : system.list())
            if (spaceMouseModel(listing)) {
                auto cap = std::make_unique<SpaceMouse>(system, listing);
                cap->open();
                return cap;
            }
    } catch (const HidRefused& error) { // it is optional, but there
        warn({std::string("the SpaceMouse does not move the camera: ") + error.what()});
    } catch (const Error&) { // nothing can be listed
    }
    return nullptr;
}

/// Returns the samples, and the files that were opened last.
std::vector<std::string> offeredObjects()
{
    std::vector<std::string> offered;
    for (const Sample& sample : samples()) offered.push_back(std::string(kSamplePrefix).append(sample.name));
    std::ranges::copy(rememberedFiles(), std::back_inserter(offered));
    return offered;
}

/// Returns the scorer of a scene in which something is hidden; empty for any other, and for recorded sessions.
std::optional<study::HuntScorer> scorerFor(const SceneSource& source)
{
    if (isFolder(source.name)) return {};
    const Scene scene = source.load();
    if (!study::hiddenIn(scene)) return {};
    return std::make_optional<study::HuntScorer>(scene, source.loadCloud(scene).cloud);
}

/// Opens the device that is asked for, and waits until its arm knows where it is.
/// \param source  holds it, and gives back the one before: a device can be open only once
WorkbenchHand openHand(const ViewOptions& o, const Stage& stage, const HandWait& wait, SessionHand& source)
{
    source                    = {};
    HandOptions hand          = o.hand;
    hand.metresPerPlainNumber = metresPerPlainNumber(o.scene, stage.scene());
    hand.cancel               = &wait.givenUp;
    source                    = handFor(hand, stage.scene(), stage.object());
    warn(source.warnings);
    say(source.notes);
    waitForHoming(*source.device, wait.givenUp, wait.tell);
    return {source.device.get(), source.frame, source.isHeldByPerson() ? 1e9 : source.seconds, source.from};
}

/// Returns what the options decide.
/// \param o, source  outlive the window
WorkbenchSettings settingsOf(const ViewOptions& o, SessionHand& source)
{
    WorkbenchSettings settings;
    settings.what     = o.scene.name;
    settings.values   = o.scene.flags;
    settings.toolKeys = &study::huntKeys();
    settings.opened   = [](const std::string& what) {
        if (!what.starts_with(kSamplePrefix)) rememberFile(std::filesystem::absolute(what).string());
    };
    settings.offered = offeredObjects;
    if (isFirstWindow())
        settings.welcome = "Hold Space over the object and move the mouse to touch it; the wheel sets the depth, F1 "
                           "shows all keys, and Object opens others";
    settings.open     = sceneFrom;
    settings.recorded = [&o](const Stage& stage, const HapticDevice& device) { return infoOf(o, stage, device); };
    if (deviceNamed(o.hand.hand) != &kMouseRecord)
        settings.hand = [&](const Stage& stage, const HandWait& wait) { return openHand(o, stage, wait, source); };
    settings.assumed    = assumptions;
    settings.complained = [](const std::string& sentence) { std::cerr << "palpate: " << sentence << "\n"; };
    if (!o.hand.seconds.empty()) settings.seconds = secondsOf(o.hand.seconds);
    settings.state.look.paint  = optionNamed<ViewPaint>("--colour", o.colour);
    settings.state.look.map    = optionNamed<ColourMap>("--colour-map", o.map);
    settings.state.look.ground = o.dark ? Ground::dark : Ground::light;
    settings.stop              = &catchInterrupts();
    return settings;
}

/// Says how the window ended.
void tellEnd(const ViewOptions& o, const WorkbenchReport& report, SurfaceRenderer& renderer,
             const std::optional<study::HuntScorer>& scorer)
{
    if (!report.said.empty()) std::cerr << "palpate: " << report.said << "\n";
    const auto score = scorer ? std::optional(scorer->score()) : std::nullopt;
    tell(o, report, renderer, score);
    if (score && !o.json) printText(*score, study::hiddenIn(o.scene.load())->hunt);
    const auto messages = renderer.takeMessages();
    for (const std::string& message : messages) std::cerr << "palpate: validation: " << message << "\n";
    if (!messages.empty()) throw CheckFailed("the validation layer has messages");
    if (report.hasLost) throw CheckFailed("paint or ticks were lost");
}

/// Shows what the options name until its window is closed.
/// \param streams  of the session, whose counts are told
void showIn(GlfwWindow& window, const ViewOptions& o, WorkbenchSettings& settings,
            std::optional<study::HuntScorer>& scorer, const std::vector<std::unique_ptr<TickStream>>& streams)
{
    std::optional<PanelFrame> panels; // outlives what draws it and what feeds it
    compute::ContextSettings  gpu{.processor = o.drawOn};
    if (o.validate) gpu.validation = compute::Validation::synchronization;
    std::optional<CrashesWithDisplay> first(std::in_place);
    SurfaceRenderer                   renderer(gpu, window.link());
    first.reset();
    if (!o.noPanels && PanelFrame::available()) panels.emplace(window.scale());
    glm::ivec2 last{};
    settings.titled = [&window](const std::string& name) { window.setTitle(name + " - Palpate"); };
    WindowScreen               screen(renderer);
    Workbench                  bench(settings, screen);
    std::optional<MarkerInput> markers; // ends before what it marks
    if (!o.markers.empty()) markers.emplace(MarkerSources{.address = markerAddress(o.markers)});
    if (markers)
        markers->listen([&bench](std::string_view text) { bench.mark(text); },
                        [&bench](std::uint64_t lost) { bench.loseMarkers(lost); });
    const auto report = bench.run(
        [&](double patience) {
            WindowInput input = window.poll(patience);
            if (input.size.x > 0) last = input.size;
            return input;
        },
        panels ? &*panels : nullptr);
    markers.reset();
    if (o.size.empty()) rememberSize(last);
    tellStreams(streams, o.json);
    tellEnd(o, report, renderer, scorer);
}

void view(const ViewOptions& o)
{
    if (!o.markers.empty()) static_cast<void>(markerAddress(o.markers)); // before a window opens
    std::vector<std::unique_ptr<TickStream>> streams;                    // outlive the window
    SessionHand                              source;
    WorkbenchSettings                        settings = settingsOf(o, source);
    auto                                     scorer   = scorerFor(o.scene);
    if (scorer) settings.onTick = [&scorer](const TickRecord& record) { scorer->add(record); };
    for (const std::string& outlet : o.streams) streams.push_back(std::make_unique<TickStream>(openOutlet(outlet)));
    for (const auto& stream : streams) settings.streams.push_back(stream.get());

    HidapiSystem hid;
    const auto   cap = capFor(o, hid);
    settings.camera  = cap.get();

    GlfwWindow window("Palpate", sizeOf(o.size));
    try {
        showIn(window, o, settings, scorer, streams);
    } catch (const Error& error) { // a driver may notice first, and say that it has no memory
        static_cast<void>(window.poll());
        if (window.hasDisplay()) throw;
        throw Error(std::string("the display has gone, and the window with it (") + error.what() + ")");
    }
    if (!window.hasDisplay()) throw Error("the display has gone, and the window with it");
}

#else

void view(const ViewOptions&)
{
    throw Error("this build opens no windows: it was made without GLFW (package libglfw3-dev); palpate render makes "
                "pictures without a display");
}

#endif

} // namespace

void addViewCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("view", "shows an object in a window, to be touched with the mouse");
    const auto o       = std::make_shared<ViewOptions>();
    o->hand.hand       = kMouseRecord.name;
    o->scene.addTo(*command, SceneKey::Group::session);
    command->get_option("SCENE")->description(command->get_option("SCENE")->get_description() +
                                              ", or the folder of a recorded session");
    command
        ->add_option("--hand", o->hand.hand,
                     std::string(kMouseRecord.name) + "; or any hand of palpate run: " + generatedHands() +
                         ", a file, " + deviceHands())
        ->capture_default_str();
    command->add_option("--seconds", o->hand.seconds, "time after which the window closes by itself [never]");
    command->add_option("--colour,--color", o->colour, "quantity in colours: " + wordsOf<ViewPaint>())
        ->capture_default_str();
    command->add_option("--colour-map,--color-map", o->map, "map of colours: " + wordsOf<ColourMap>())
        ->capture_default_str();
    command->add_flag("--dark", o->dark, "draws on a dark ground");
    command->add_option("--size", o->size, "size of the window [px] [its last size]");
    command->add_flag("--no-panels", o->noPanels, "shows no panels; keys and mouse still work");
    command->add_option("--draw-on", o->drawOn, "Vulkan processor that draws, as \"palpate devices\" names it")
        ->capture_default_str();
    command->add_flag("--validate", o->validate,
                      "runs under Vulkan's validation layer; exit code 1 if it has a message");
    addStreamOption(*command, o->streams);
    addMarkersOption(*command, o->markers);
    command->add_flag("--json", o->json, "machine-readable, SI units");
    addHandOptions(*command, o->hand, deviceRecords());
    command->footer("Hold Space over the object and move to touch it; the wheel sets the depth. F1 shows all keys.\n"
                    "Examples:\n"
                    "  palpate view\n"
                    "  palpate view samples/scenes/skin_wart.json --colour stiffness\n"
                    "  palpate view samples/scenes/nodule_hunt.json --hunt-seed 7     hidden nodules: M declares one\n"
                    "  palpate view scan.ply --length-unit mm --place 12,0,30\n"
                    "  palpate view sample:ellipsoid --hand circle --seconds 10 --json");
    command->callback([command, o] {
        o->command = commandOf(*command);
        if (isFolder(o->scene.name) && !o->scene.flags.empty())
            throw Error(flagOf(o->scene.flags.begin()->first) + " has no effect on a recorded session, " +
                        shownPath(o->scene.name) + ", which says what its scene was; omit the option");
        if (deviceNamed(o->hand.hand) == &kMouseRecord) demandFitting(o->hand); // others: when they are opened
        view(*o);
    });
}

} // namespace palp
