// falcon_demo: a Novint Falcon, or an emulated one, from the upload of its firmware to a scene that one can feel.
// Exit codes: 0 good, 1 a fault of ours, 2 bad usage, or a file or device that cannot be used.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <glm/geometric.hpp>
#include <unistd.h>

#include "device/falcon/falcon_device.h"
#include "device/falcon/falcon_firmware.h"
#include "device/falcon/libusb_link.h"
#include "engine/compute/processor_error.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/core/real_time.h"
#include "engine/session/deformation.h"
#include "engine/session/held_falcon.h"
#include "engine/session/real_session.h"

namespace palp {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::string scene, scenes, firmware;
    double      seconds  = 20;                             ///< [s]
    double      counts   = FalconMotors::kCountsPerTorque; ///< of its motors [1/(N m)]
    bool        emulator = false, list = false;
};

void declare(CLI::App& app, Options& o)
{
    app.add_option("SCENE", o.scene, "name of a scene, as --list shows it, or a .json file [palm_wart]");
    app.add_option("--seconds", o.seconds, "how long it is felt; Ctrl-C ends it earlier, at zero force")
        ->capture_default_str()
        ->check(CLI::Range(1e-3, 86400.0));
    app.add_flag("--emulator", o.emulator, "the emulated Falcon even if a real one is plugged in");
    app.add_option("--firmware", o.firmware, "image that a Falcon needs after it was plugged in [FALCON_FIRMWARE]");
    app.add_option("--falcon-counts", o.counts, "counts per N m of its motors, see palpate calibrate")
        ->capture_default_str()
        ->check(CLI::Range(500.0, 50000.0));
    app.add_flag("--list", o.list, "the scenes, and what to feel in each; nothing else");
    app.add_option("--scenes", o.scenes, "folder of the scenes [../share/palpate/scenes from here, or samples/scenes]");
    app.footer("Examples:\n"
               "  falcon_demo --list\n"
               "  falcon_demo skin_wart --emulator --seconds 10\n"
               "  falcon_demo my_scene.json --firmware falcon.bin");
}

// --- the scenes

/// The program may have been moved with its data: they are looked for from where it is, then from where the user is.
fs::path scenesFolder(const Options& o)
{
    if (!o.scenes.empty()) return o.scenes;
    std::error_code none;
    const fs::path  here = fs::read_symlink("/proc/self/exe", none).parent_path();
    for (const fs::path& folder :
         {here / "../share/palpate/scenes", here / "../../samples/scenes", fs::path("samples/scenes")})
        if (fs::is_directory(folder, none)) return folder.lexically_normal();
    throw Error("the scenes were not found beside " + here.string() +
                "; expected ../share/palpate/scenes there; name their folder by --scenes");
}

std::vector<fs::path> scenesIn(const fs::path& folder)
{
    std::vector<fs::path> scenes;
    std::error_code       failure;
    for (const auto& entry : fs::directory_iterator(folder, failure))
        if (entry.path().extension() == ".json" && !entry.path().stem().string().ends_with(".schema"))
            scenes.push_back(entry.path());
    if (failure) throw Error(folder.string() + ": cannot be read: " + failure.message());
    std::ranges::sort(scenes);
    return scenes;
}

/// Each scene opens with a comment of one line: what to feel.
void list(const fs::path& folder)
{
    for (const fs::path& scene : scenesIn(folder)) {
        std::ifstream file(scene);
        std::string   line;
        std::getline(file, line);
        std::printf("  %-21s %s\n", scene.stem().c_str(), line.starts_with("// ") ? line.c_str() + 3 : "");
    }
}

/// Who names no scene sees which there are, and gets the wart.
fs::path sceneFile(const Options& o)
{
    if (o.scene.find_first_of("./") != std::string::npos) return o.scene;
    const fs::path folder = scenesFolder(o);
    if (o.scene.empty()) list(folder);
    const std::string name = o.scene.empty() ? "palm_wart" : o.scene;
    for (const fs::path& scene : scenesIn(folder))
        if (scene.stem() == name) return scene;
    throw Error("there is no scene \"" + name + "\" in " + folder.string() + "; see --list, or name a .json file");
}

// --- Ctrl-C

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

/// Before the session; during it the session ends in order.
struct Interrupted {};

void onInterrupt(int signal)
{
    interrupted = true;
    std::signal(signal, SIG_DFL); // a second one ends the program
}

// --- what is felt

/// What is felt, by which hand, where.
struct Touching {
    Scene       scene;
    SoftObject  object;
    Deformation deformation;
    HandPlace   place;

    explicit Touching(const fs::path& file)
        : scene(readScene(file, {{}, processEnvironment()})), object(loadObject(scene).object),
          deformation(object, scene), place(handPlace(scene, object))
    {
    }

    /// Down beside the place, then to and fro across it; 40 % of the thickness deep, within plate theory.
    [[nodiscard]] HandPath scan(double seconds) const
    {
        HandScript script;
        script.motion   = HandMotion::scan;
        script.depth    = 0.4 * scene.material.thickness;
        script.height   = scene.startHeight;
        script.duration = seconds;
        return draped(makeHand(script, place), place, object);
    }
};

// --- starting the Falcon

const char* meaning(DeviceLight light)
{
    switch (light) {
    case DeviceLight::red:
        return "red    it is to be homed";
    case DeviceLight::blue:
        return "blue   no force flows: the grip is out of its workspace, or something is wrong";
    case DeviceLight::green:
        return "green  forces flow";
    default:
        return "none";
    }
}

/// One line that is written over on a terminal; in a file, only its end.
void showUpload(std::size_t done, std::size_t total)
{
    if (interrupted) throw Interrupted();
    if (done < total && isatty(STDOUT_FILENO) == 0) return;
    std::printf("%supload  %zu of %zu bytes%s", isatty(STDOUT_FILENO) != 0 ? "\r" : "", done, total,
                done == total ? ", each came back as it was sent\n" : "");
    std::fflush(stdout);
}

/// The Falcon at hand: somebody's, or an emulated one in a scripted hand.
struct Falcon {
    std::unique_ptr<HandPath>     path; ///< of the scripted hand
    std::unique_ptr<HapticDevice> device;
    HeldFalcon*                   emulated = nullptr; ///< device, if it is one
    DeviceFrame                   frame;
};

/// Says which; the reason why one that is plugged in is of no use too.
bool isRealUsable(const Options& o)
{
    if (o.emulator) {
        std::puts("device  an emulated Falcon, from the packets on its wire to its motors");
        return false;
    }
    const auto found = listFalcons();
    for (const FalconListing& listing : found) {
        if (listing.usable) {
            std::printf("device  the Falcon at %s\n", listing.path.c_str());
            return true;
        }
        std::printf("device  the Falcon at %s cannot be used: %s; %s\n", listing.path.c_str(), listing.why.c_str(),
                    listing.help.c_str());
    }
    std::printf("device  %s (looked for with %s): an emulated one stands in, from the packets on its wire to its "
                "motors\n",
                found.empty() ? "no Falcon is plugged in" : "none can be used", falconSupport().c_str());
    return false;
}

FalconDeviceSettings settingsOf(const Options& o)
{
    FalconDeviceSettings settings;
    if (const auto image = falconFirmwarePath(o.firmware); !image.empty()) settings.firmware = readFirmware(image);
    settings.loop.countsPerTorque = o.counts;
    settings.start.onUpload       = showUpload;
    return settings;
}

Falcon realFalcon(const Options& o, const Touching& touching)
{
    Falcon           falcon;
    const HandPlace& place = touching.place;
    falcon.frame           = deviceFrame(place.point + touching.scene.startHeight * place.outward, place.outward);
    falcon.device          = std::make_unique<FalconDevice>([] { return openFalcon(); }, settingsOf(o));
    return falcon;
}

/// Plugged in a moment ago: without firmware, and its position unknown.
Falcon emulatedFalcon(const Options& o, const Touching& touching)
{
    Falcon falcon;
    falcon.path                   = std::make_unique<HandPath>(touching.scan(o.seconds));
    const glm::dvec3 start        = falcon.path->position(falcon.path->begin());
    falcon.frame                  = deviceFrame(start, touching.place.outward);
    FalconDeviceSettings settings = settingsOf(o);
    if (settings.firmware.empty()) {
        std::puts("upload  of 8000 zeros, which the emulator takes: Palpate has none of Novint's firmware");
        settings.firmware.assign(8000, 0);
    }
    settings.start.onUpload = [](std::size_t done, std::size_t total) {
        std::this_thread::sleep_for(std::chrono::milliseconds(4)); // 62 bytes and their echo take 4.4 on the wire
        showUpload(done, total);
    };
    const SimulatedHand grip{.stiffness = 300, .damping = 2};
    auto                held =
        std::make_unique<HeldFalcon>(HoldingHand{*falcon.path, grip, falcon.frame}, Ft232EmulatorSettings{}, settings);
    falcon.emulated = held.get();
    falcon.device   = std::move(held);
    return falcon;
}

/// [m] along the device's z at a time [s]: out, in as far as it goes, and back to the middle.
double homingPath(double time)
{
    constexpr double kOut = 0.048, kIn = -0.052, kSpeed = 0.1; // [m], [m/s]
    const double     turn = kOut / kSpeed + 0.3, there = turn + (kOut - kIn) / kSpeed + 0.3;
    if (time < turn) return std::min(kOut, kSpeed * time);
    if (time < there) return std::max(kIn, kOut - kSpeed * (time - turn));
    return std::min(0.0, kIn + kSpeed * (time - there));
}

/// Says what the light means whenever it changes, and first of all what to do about red.
void tell(DeviceLight light, const Falcon& falcon)
{
    std::printf("light   %s\n", meaning(light));
    if (light == DeviceLight::red)
        std::printf("homing  pull the grip all the way out, then push it all the way in%s\n",
                    falcon.emulated ? "; a scripted hand does it" : "");
    std::fflush(stdout);
}

/// Until it is homed, and the emulated hand is back in the middle.
void home(Falcon& falcon)
{
    constexpr double kEmulatedTime = 3, kFirstAnswers = 1; // [s]
    const auto       start = std::chrono::steady_clock::now();
    Metronome        metronome{std::chrono::milliseconds(1)};
    auto             told = DeviceLight::none;
    falcon.device->home();
    for (;;) {
        if (interrupted) throw Interrupted();
        const double now = std::chrono::duration<double>(metronome.wait() - start).count();
        if (falcon.emulated) falcon.emulated->lead({0, 0, homingPath(now)});
        const HapticState state = falcon.device->exchange(GovernedForce(), now);
        if (state.sequence > 0 && falconLight(state) != told) tell(told = falconLight(state), falcon);
        if (state.homed && (!falcon.emulated || now > kEmulatedTime)) break;
        if (now > kFirstAnswers && (state.fault == DeviceFault::unplugged || state.fault == DeviceFault::silent))
            throw Error(std::string("the Falcon was lost while it was to be homed: ") + name(state.fault) +
                        "; palpate doctor may tell why");
    }
    if (falcon.emulated) falcon.emulated->follow();
    std::puts("homing  done: it knows where the grip is");
}

// --- the session

void showLine(const SessionView& view)
{
    const TickRecord& s = view.sample;
    Hand              hand;
    HapticState       state;
    hand.setBits(s.device);
    state.fault = hand.device;
    state.homed = hand.homed;
    state.inBox = hand.inBox;
    std::fprintf(stderr, "\r%6.1f s  %9s  %9s deep  light %s\033[K", s.time,
                 formatQuantity(glm::length(s.force), "N").c_str(),
                 formatQuantity(glm::length(s.proxy - s.hip), "m").c_str(), meaning(falconLight(state)));
}

void report(const SessionSummary& s)
{
    std::printf("felt    %.1f s, in contact %.0f %% of it; force at most %s, depth at most %s\n",
                double(s.ticks) * 1e-3, s.ticks > 0 ? 100 * double(s.contactTicks) / double(s.ticks) : 0.0,
                formatQuantity(s.mostForce, "N").c_str(), formatQuantity(s.mostDepth, "m").c_str());
    std::printf("engine  a tick computes %s (p99 %s) and comes every %s (p99 %s); %llu patches, each %s\n",
                formatQuantity(s.tick.quantile(0.5), "s").c_str(), formatQuantity(s.tick.quantile(0.99), "s").c_str(),
                formatQuantity(s.period.quantile(0.5), "s").c_str(),
                formatQuantity(s.period.quantile(0.99), "s").c_str(), static_cast<unsigned long long>(s.patches),
                formatQuantity(s.solve.quantile(0.5), "s").c_str());
    if (s.fault != GovernorFault::none) std::printf("stopped the governor stopped the force: %s\n", name(s.fault));
    if (s.deviceFault != DeviceFault::none)
        std::printf("trouble the Falcon was not well for a while: %s\n", name(s.deviceFault));
    if (s.beyondTheory > 0)
        std::printf("theory  bent by more than half its thickness in %llu ticks; press more gently\n",
                    static_cast<unsigned long long>(s.beyondTheory));
}

void feel(const Options& o, Touching& touching, Falcon& falcon)
{
    RealSessionSettings settings;
    settings.seconds = o.seconds;
    settings.stop    = &interrupted;
    if (isatty(STDERR_FILENO) != 0) settings.onView = showLine;
    std::string warning;
    std::puts("feel    now; Ctrl-C ends it, at zero force");
    std::fflush(stdout);
    const SessionSummary summary =
        runReal({touching.scene, touching.object, touching.deformation.solver(), *falcon.device, falcon.frame},
                settings, warning);
    if (settings.onView) std::fprintf(stderr, "\r\033[K");
    falcon.device->close();
    if (!warning.empty()) std::fprintf(stderr, "falcon_demo: warning: %s\n", warning.c_str());
    report(summary);
    if (!falcon.emulated) return;
    const EmulatedFalcon& wire = falcon.emulated->emulator().falcon();
    if (wire.command().motors != FalconCommand{}.motors) throw std::logic_error("the last packet asked for a force");
    std::printf("wire    %llu packets; the last one asked for no force\n",
                static_cast<unsigned long long>(wire.packets()));
}

void run(const Options& o)
{
    if (o.list) return list(scenesFolder(o));
    const fs::path file = sceneFile(o);
    Touching       touching(file);
    std::printf("scene   %s\n", file.stem().c_str());
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) std::signal(signal, onInterrupt);
    Falcon falcon = isRealUsable(o) ? realFalcon(o, touching) : emulatedFalcon(o, touching);
    falcon.device->open();
    home(falcon);
    feel(o, touching, falcon);
}

int complain(const char* sentence, int code)
{
    std::fflush(stdout);
    std::fprintf(stderr, "falcon_demo: %s\n", sentence);
    return code;
}

} // namespace
} // namespace palp

int main(int argumentCount, char** arguments)
{
    CLI::App      app("Starts a Novint Falcon, guides its homing, and lets you feel a scene; without one, an emulated "
                           "Falcon stands in.");
    palp::Options options;
    palp::declare(app, options);
    try {
        app.parse(argumentCount, arguments);
        palp::run(options);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error); // --help
        return palp::complain((std::string(error.what()) + "; see --help").c_str(), 2);
    } catch (const palp::Interrupted&) {
        std::puts("ended   before the scene; no force flowed");
    } catch (const palp::compute::ProcessorError& error) {
        return palp::complain(error.what(), 4);
    } catch (const palp::Error& error) {
        return palp::complain(error.what(), 2);
    } catch (const std::exception& error) {
        return palp::complain((std::string("internal error, please report it: ") + error.what()).c_str(), 1);
    }
    return 0;
}
