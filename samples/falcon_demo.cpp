// falcon_demo: a Novint Falcon, or an emulated one, from the upload of its firmware to a scene that one can feel.
// Exit codes: 0 good, 1 a fault of ours, 2 bad usage, or a file or device that cannot be used, 4 no processor.
#include <cstdio>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "device/falcon/falcon_record.h"
#include "device/hid/hidapi_system.h"
#include "device/homing.h"
#include "engine/compute/processor_error.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/session/force_state.h"
#include "engine/session/gripped_falcon.h"
#include "engine/session/interrupt.h"
#include "engine/session/real_session.h"
#include "engine/session/session_hand.h"
#include "engine/session/session_line.h"
#include "engine/session/shipped_scenes.h"

using namespace palp;

namespace {

const std::atomic<bool>& interrupted = catchInterrupts();

struct Options {
    std::string scene, scenes;
    HandChoice  hand{.seconds = 20};
    bool        emulator = false, list = false;
};

/// Without a name this lists the scenes and takes the wart.
std::filesystem::path sceneFile(const Options& o)
{
    if (o.scene.find_first_of("./") != std::string::npos) return o.scene;
    const auto folder = o.scenes.empty() ? shippedScenesFolder() : std::filesystem::path(o.scenes);
    for (const ShippedScene& scene : scenesIn(folder)) {
        if (scene.name == o.scene) return scene.file;
        if (o.scene.empty()) std::printf("  %-21s %s\n", scene.name.c_str(), scene.feel.c_str());
    }
    if (o.scene.empty()) return folder / "palm_wart.json";
    throw Error("there is no scene \"" + o.scene + "\" in " + folder.string() + "; see --list, or name a .json file");
}

/// Says which Falcon it is, and why one that is plugged in cannot be used.
bool isRealUsable()
{
    HidapiSystem hid; // which a Falcon does not use
    for (const DeviceListing& falcon : kFalconRecord.list(hid)) {
        const char* verdict = falcon.usable ? "is used" : "cannot be used";
        std::printf("device  %s %s: %s; %s\n", falcon.path.c_str(), verdict, falcon.why.c_str(), falcon.help.c_str());
        if (falcon.usable) return true;
    }
    std::printf("device  none can be used (looked for with %s)\n", kFalconRecord.support().library.c_str());
    return false;
}

/// Waits until the Falcon is homed and a scripted hand is back from that. Says what the light means.
void home(HapticDevice& device, const GrippedFalcon* emulated)
{
    auto       told   = DeviceLight::none;
    const auto tell   = [](const std::string& what) { std::printf("homing  %s\n", what.c_str()); };
    const auto isDone = [&](const HapticState& state) {
        if (const auto light = falconLight(state); state.sequence > 0 && light != told)
            std::printf("light   %s\n", meaningOf(told = light));
        return state.homed && !(emulated && emulated->isBeingHomed());
    };
    waitForHoming(device, interrupted, tell, isDone);
    std::puts("homing  done: it knows where the grip is");
}

void report(const SessionSummary& s)
{
    if (isatty(STDERR_FILENO) != 0) clearLine();
    const auto text = [](double value, const char* unit) { return formatQuantity(value, unit); };
    std::printf("felt    %.1f s, in contact %.0f %% of it; force at most %s, depth at most %s\n",
                double(s.ticks) * 1e-3, 100 * double(s.contactTicks) / std::max(1.0, double(s.ticks)),
                text(s.mostForce, "N").c_str(), text(s.mostDepth, "m").c_str());
    std::printf("engine  a tick comes every %s, a patch takes %s\n", text(s.period.quantile(0.5), "s").c_str(),
                text(s.solve.quantile(0.5), "s").c_str());
    std::printf("faults  governor: %s; Falcon: %s\n", name(s.fault), name(s.deviceFault));
    if (s.oldTable > 0)
        std::printf("plate   it did not answer for a quarter of a second; there was no force for %s ticks\n",
                    std::to_string(s.oldTable).c_str());
    if (s.beyondTheory > 0) std::puts("theory  it bent by more than half its thickness; press more gently");
}

void run(Options& o)
{
    if (o.list) return static_cast<void>(sceneFile(o));
    demandOptionsOf(kFalconRecord.name, o.hand.options);
    const auto         file   = sceneFile(o);
    const Scene        scene  = readScene(file, {{}, processEnvironment()});
    const LoadedObject loaded = loadObject(scene);
    Deformation        deformation(loaded.object, scene);
    std::printf("scene   %s\n", file.stem().c_str());
    o.hand.hand     = kFalconRecord.name;
    o.hand.cancel   = &interrupted;
    o.hand.onUpload = [](std::size_t done, std::size_t total) {
        if (done == total) std::printf("upload  %zu of %zu bytes, each came back as it was sent\n", done, total);
    };
    if (o.emulator || !isRealUsable()) {
        std::puts("device  an emulated Falcon, from the packets on its wire to its motors; a scripted hand holds it");
        o.hand.hand                                   = kFalconEmulatorRecord.name;
        o.hand.options[std::string(kFalconCold.flag)] = "true";
    }
    SessionHand hand = openHand(o.hand, scene, loaded.object);
    for (const auto& said : {hand.warnings, hand.notes})
        for (const std::string& sentence : said) std::printf("note    %s\n", sentence.c_str());
    auto* emulated = dynamic_cast<GrippedFalcon*>(hand.device.get());
    home(*hand.device, emulated);
    std::puts("feel    now; Ctrl-C ends it, at zero force");
    RealSessionSettings settings{.seconds = hand.seconds, .stop = &interrupted};
    settings.onView = [line = isatty(STDERR_FILENO) != 0, told = DeviceLight::blue](const SessionView& view) mutable {
        if (const auto light = lightOf(forceState(view.record)); light != told) {
            if (line) clearLine();
            std::printf("light   %s\n", meaningOf(told = light));
        }
        if (line) showLine(view);
    };
    std::string warning;
    report(runReal(
        {scene, loaded.object, deformation.solver(), *hand.device, hand.frame, deformation.firstLaw(), hand.from},
        settings, warning));
    hand.device->close();
    if (!warning.empty()) std::fprintf(stderr, "falcon_demo: warning: %s\n", warning.c_str());
    if (!emulated) return;
    const EmulatedFalcon& wire = emulated->emulator().falcon();
    if (wire.command().motors != FalconCommand{}.motors) throw std::logic_error("the last packet asked for a force");
    std::printf("wire    %s packets; the last one asked for no force\n", std::to_string(wire.packets()).c_str());
}

} // namespace

int main(int argumentCount, char** arguments)
{
    CLI::App app("Starts a Novint Falcon, or an emulated one, guides its homing, and lets you feel a scene.");
    Options  o;
    app.add_option("SCENE", o.scene, "name of a scene, as --list shows it, or a .json file [palm_wart]");
    app.add_option("--seconds", *o.hand.seconds, "how long it is felt [20]")->check(CLI::Range(1e-3, 86400.0));
    app.add_flag("--emulator", o.emulator, "the emulated Falcon even if a real one is plugged in");
    app.add_flag("--list", o.list, "lists the scenes, and what to feel in each");
    app.add_option("--scenes", o.scenes, "folder of the scenes [../share/palpate/scenes from here, or samples/scenes]");
    for (const DeviceOption& option : kFalconRecord.options) {
        std::string& text = o.hand.options[std::string(option.flag)];
        if (option.kind == DeviceOption::Kind::flag)
            app.add_flag_callback(
                std::string(option.flag), [&text] { text = "true"; }, std::string(option.help));
        else
            app.add_option(std::string(option.flag), text, std::string(option.help));
    }
    app.footer("Example:\n  falcon_demo skin_wart --emulator --seconds 10");
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ); // each line at once, also into a file
    try {
        app.parse(argumentCount, arguments);
        run(o);
        return 0;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error); // --help
        return std::fprintf(stderr, "falcon_demo: %s; see --help\n", error.what()), 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "falcon_demo: %s\n", error.what());
        if (interrupted) return 0; // before the scene: no force flowed
        if (dynamic_cast<const compute::ProcessorError*>(&error)) return 4;
        return dynamic_cast<const Error*>(&error) ? 2 : 1;
    }
}
