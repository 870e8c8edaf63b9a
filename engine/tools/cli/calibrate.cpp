// palpate calibrate: a Falcon weighs a known mass, which measures the torque that its motors give for a command.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "device/falcon/falcon_calibration.h"
#include "device/falcon/falcon_constants.h"
#include "device/falcon/falcon_hold.h"
#include "device/falcon/falcon_record.h"
#include "device/falcon/ft232_emulator.h"
#include "device/hid/hidapi_system.h"
#include "device/simulated_arm.h"
#include "engine/core/contract.h"
#include "engine/core/quantity.h"
#include "engine/core/real_time.h"
#include "engine/force/governor.h"
#include "engine/session/interrupt.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/hand_source.h"

namespace palp {
namespace {

using Stage = FalconCalibrationStage;

struct CalibrateOptions {
    std::string        mass = "200 g";
    DeviceOptionValues falcon;
    bool               emulator = false, json = false;
};

/// Returns the counts per torque that the Falcon uses during the weighing [1/(N m)].
double countsBefore(const CalibrateOptions& o)
{
    const std::string counts = textOf(o.falcon, kFalconCounts);
    return counts.empty() ? FalconMotors::kCountsPerTorque : numberOf(kFalconCounts, counts);
}

/// Reads "200 g" or "0.2" [kg].
double kilograms(std::string text)
{
    const std::string given = text;
    double            unit  = 1; // [kg]
    if (text.ends_with("g")) {
        const bool kilo = text.ends_with("kg");
        text.resize(text.size() - (kilo ? 2 : 1));
        unit = kilo ? 1 : 1e-3;
    }
    const double mass = parseQuantity(text, Dimension::none, "--mass", unit);
    if (mass >= 0.05 && mass <= 0.5) return mass;
    throw Error("--mass: expected 50 g to 500 g, found \"" + given + "\"");
}

/// A Falcon, a clock, and a user with a mass.
struct Bench {
    HapticDevice&                           device;
    std::function<double()>                 wait; ///< waits for the next tick and returns when it is [s]
    std::function<void(double gain, Stage)> act;  ///< what the user does, each tick; may be empty
};

/// Detects that a mass has been hung on the grip and hangs still.
class HangsStill {
public:
    bool operator()(double upwards, double speed, double dt) noexcept
    {
        constexpr double kLeast = 0.2, kStill = 5e-3, kLong = 3; // [N], [m/s], [s] beyond the integral's second
        time_ += dt;
        if (time_ < 1) without_ = upwards; // the arm has just stopped moving
        still_ = upwards > without_ + kLeast && speed < kStill ? still_ + dt : 0;
        return still_ >= kLong;
    }

private:
    double time_ = 0, still_ = 0; ///< [s]
    double without_ = 0;          ///< [N] that hold the arm alone
};

void tell(const CalibrateOptions& o, Stage stage)
{
    if (stage == Stage::lift)
        std::cerr << "palpate: lift the grip to the middle of its workspace and hold it there loosely; release it when "
                     "the force begins, within 2 s; the motors then find the command that carries the arm\n";
    if (stage == Stage::bare) std::cerr << "palpate: hands off: the arm moves up and down for 16 s and is weighed\n";
    if (stage == Stage::hang)
        std::cerr << "palpate: hang " << o.mass
                  << " on the grip and release it; the weighing continues when the mass hangs still\n";
    if (stage == Stage::done)
        std::cerr << "palpate: hands off: the Falcon now gets no packet for a moment, again and again and longer each "
                     "time, until its motors let go and the mass drops by some millimetres\n";
    if (stage == Stage::loaded) std::cerr << "palpate: hands off: arm and mass are weighed for 16 s\n";
}

[[noreturn]] void giveUp(const std::string& why)
{
    std::cerr << "palpate: not calibrated: " << why << "\n";
    throw CheckFailed(why);
}

/// Gives up if the device is at fault or the governor has stopped the force.
/// \param ill  time for which the device has been at fault [s]
void demandWell(const HapticState& state, double ill, GovernorFault fault)
{
    constexpr double kPatience = 1; // [s]
    if (ill > kPatience)
        giveUp(std::string("the Falcon reports a fault: ") + name(state.fault) + "; run palpate doctor for the cause");
    if (fault != GovernorFault::none)
        giveUp(std::string("the governor stopped the force: ") + name(fault) +
               "; start again and move the grip slowly");
}

/// What the weighing found.
struct Found {
    std::string           serial; ///< of the Falcon
    std::optional<double> hold;   ///< [s] empty: it holds for longer than half a second, or was not measured
};

/// Goes through all stages. However it ends, the device is closed, so its last force is zero.
Found weigh(const CalibrateOptions& o, Bench& bench, FalconCalibration& calibration)
{
    constexpr double          kPatience = 300; // [s] for all stages
    const std::atomic<bool>&  stop      = catchInterrupts();
    ForceGovernor             governor;
    HangsStill                hangsStill;
    GovernedForce             force;
    Stage                     told = Stage::failed;
    std::optional<FalconHold> hold;
    double                    weighed = 0; // [s] when the hold is begun to be measured
    auto* const               falcon  = dynamic_cast<FalconDevice*>(&bench.device);
    const double              begin   = bench.wait();
    for (double last = begin, gain = 0, ill = 0; calibration.stage() < Stage::done || (hold && !hold->isDone());) {
        if (stop) throw Error("the calibration was interrupted; the force is off");
        if (calibration.stage() != told) tell(o, told = calibration.stage());
        const double now = bench.wait(), dt = now - last;
        last = now;
        if (bench.act) bench.act(gain, told);
        if (falcon) falcon->useCounts(calibration.countsInUse());
        const HapticState state = bench.device.exchange(force, now);
        GovernorInput     in;
        in.force = hold ? hold->step(*falcon, state, gain, dt) : calibration.step(state, force, gain, dt);
        if (!hold && falcon && calibration.stage() == Stage::done) {
            hold.emplace(force.newtons());
            weighed  = now;
            in.force = force.newtons();
        }
        in.position                    = state.position;
        in.velocity                    = state.velocity;
        in.homed                       = state.homed && state.fault == DeviceFault::none;
        in.inBox                       = state.inBox;
        in.dt                          = dt;
        in.missedExchanges             = state.missed;
        const auto out                 = governor.step(in);
        ill                            = state.fault == DeviceFault::none ? 0 : ill + dt;
        constexpr double kHoldPatience = 120; // [s]
        const bool       isLost        = ill > 1 || out.fault != GovernorFault::none;
        if (hold && (isLost || now > weighed + kHoldPatience)) break; // the weighing counts all the same
        demandWell(state, ill, out.fault);
        gain  = out.gain;
        force = governor.force();
        bench.device.light(std::uint8_t(gain > 0 ? DeviceLight::green : DeviceLight::blue));
        if (told == Stage::hang && hangsStill(force.newtons().y, glm::length(state.velocity), dt)) calibration.hung();
        if (told == Stage::hang && !state.inBox)
            giveUp("the grip was pulled out of its workspace: take a lighter mass and lower it gently");
        if (now > begin + kPatience) giveUp("the calibration took more than 5 minutes; nothing was weighed");
    }
    if (calibration.stage() == Stage::failed) giveUp(calibration.failure());
    return {{}, hold ? hold->hold() : std::nullopt};
}

Found weighReal(const CalibrateOptions& o, FalconCalibration& calibration)
{
    HidapiSystem hid; // not used by a Falcon
    const auto   falcon = makeFalconToCalibrate({.hid = hid, .options = o.falcon});
    falcon->open();
    waitForHoming(*falcon, catchInterrupts());
    if (const std::string refused = askForRealTime(); !refused.empty())
        std::cerr << "palpate: warning: " << refused << "\n";
    Metronome  metronome{std::chrono::milliseconds(1)};
    const auto start = metronome.wait();
    Bench      bench{*falcon, [&] { return std::chrono::duration<double>(metronome.wait() - start).count(); }, {}};
    Found      found = weigh(o, bench, calibration);
    found.serial     = falcon->info().serial;
    return found;
}

/// The emulated Falcon's true values, which its driver does not know.
constexpr double kEmulatedCounts = 5000; ///< [counts/(N m)]
constexpr double kEmulatedArm    = 0.21; ///< [kg] part of the arm that weighs on the grip

/// A Falcon in virtual time whose friction takes 0.05 N of its force, and a user with a mass within reach.
struct EmulatedBench {
    SimulatedArm  arm;
    double        hanging = 0; ///< [kg]
    double        asked   = 0; ///< [s] since the user was asked to hang the mass
    double        now     = 0; ///< [s]
    Ft232Emulator emulator;
    FalconDevice  falcon;

    static constexpr glm::dvec3 kHeld{0, 0.004, -0.006}; ///< [m] the place where the user first holds the grip

    explicit EmulatedBench(double countsPerTorque)
        : arm({.friction = 0.05, .encoderStep = 0, .delayTicks = 0}, kHeld),
          emulator(motors(), [this](const glm::dvec3& force, double dt) { return moved(force, dt); }),
          falcon([this] { return emulator.connect(); }, stepped(countsPerTorque))
    {
        falcon.open();
        now = emulator.now();
    }

    static Ft232EmulatorSettings motors()
    {
        Ft232EmulatorSettings settings;
        settings.falcon.running = settings.falcon.homed = true;
        settings.falcon.countsPerTorque                 = kEmulatedCounts;
        return settings;
    }

    static FalconDeviceSettings stepped(double countsPerTorque)
    {
        FalconDeviceSettings settings;
        settings.pace                 = FalconPace::stepped;
        settings.loop.countsPerTorque = countsPerTorque;
        return settings;
    }

    /// The mass's inertia is omitted, because it does not change means.
    glm::dvec3 moved(const glm::dvec3& force, double dt)
    {
        arm.step(force - glm::dvec3(0, (kEmulatedArm + hanging) * 9.81, 0), dt);
        return arm.position();
    }

    /// Holds the grip until the force begins, and hangs `mass` [kg] on it two seconds after being asked to.
    void act(double gain, Stage stage, double mass)
    {
        arm.holdBy(gain < 1 ? SimulatedHand{.stiffness = 500, .damping = 20, .target = kHeld} : SimulatedHand{});
        if (stage == Stage::hang) asked += 1e-3;
        if (asked > 2) hanging = mass;
    }
};

Found weighEmulated(const CalibrateOptions& o, double mass, FalconCalibration& calibration)
{
    std::cerr << "palpate: this Falcon and the hand that acts on it are emulated, faster than real time\n";
    EmulatedBench emulated(countsBefore(o));
    Bench bench{emulated.falcon, [&] { return emulated.now = std::max(emulated.now + 1e-3, emulated.emulator.now()); },
                [&](double gain, Stage stage) { emulated.act(gain, stage, mass); }};
    return weigh(o, bench, calibration);
}

std::string today()
{
    const std::time_t    now = std::time(nullptr);
    std::tm              local{};
    std::array<char, 11> text{};
    localtime_r(&now, &local);
    std::strftime(text.data(), text.size(), "%F", &local);
    return text.data();
}

/// Stores what was found where every command finds it.
/// \return the file; empty, with a warning, if it cannot be stored: the numbers are printed all the same
std::string store(const FalconCalibration& calibration, const Found& found)
{
    try {
        return writeFalconConstants({.serial          = found.serial,
                                     .countsPerTorque = calibration.countsPerTorque().value(),
                                     .armMass         = calibration.armMass().value(),
                                     .date            = today()})
            .string();
    } catch (const Error& error) {
        std::cerr << "palpate: warning: " << error.what() << "\n";
        return {};
    }
}

void print(const CalibrateOptions& o, double mass, const FalconCalibration& calibration, const Found& found,
           const std::string& file)
{
    const double counts = calibration.countsPerTorque().value(), arm = calibration.armMass().value();
    if (o.json) {
        nlohmann::ordered_json report{
            {"counts_per_torque", counts},
            {"counts_per_torque_before", countsBefore(o)},
            {"arm_kg", arm},
            {"hold_s", nullptr},
            {"mass_kg", mass},
            {"file", file.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(file)},
            {"emulated", nullptr}};
        if (found.hold) report["hold_s"] = *found.hold;
        if (o.emulator) report["emulated"] = {{"counts_per_torque", kEmulatedCounts}, {"arm_kg", kEmulatedArm}};
        std::cout << jsonText(report);
        return;
    }
    std::printf("counts per N m   %.0f   (%.0f before: the forces were %.2f times those asked for)\n", counts,
                countsBefore(o), countsBefore(o) / counts);
    std::printf("the arm          %.0f g weigh on the grip\n", 1000 * arm);
    if (found.hold)
        std::printf(
            "its own hold     after %.0f ms without a packet its motors let go: so long a force lasts where only "
            "they can end it\n",
            1000 * *found.hold);
    else
        std::printf("its own hold     not found: the grip did not fall within half a second without a packet. Unplug "
                    "its power, not its cable, to be sure of no force\n");
    if (o.emulator)
        std::printf("true values      %.0f and %.0f g: this Falcon is emulated, do not use its numbers with another\n",
                    kEmulatedCounts, 1000 * kEmulatedArm);
    if (file.empty())
        std::printf("use it           palpate run SCENE --hand %s %s %.0f\n", kFalconRecord.name.data(),
                    kFalconCounts.flag.data(), counts);
    else
        std::printf("use it           every command does from now on: %s\n", file.c_str());
}

void calibrate(const CalibrateOptions& o)
{
    const double      mass = kilograms(o.mass);
    FalconCalibration calibration({.mass = mass, .countsPerTorque = countsBefore(o)});
    const Found       found = o.emulator ? weighEmulated(o, mass, calibration) : weighReal(o, calibration);
    print(o, mass, calibration, found, o.emulator ? "" : store(calibration, found));
}

} // namespace

void addCalibrateCommand(CLI::App& app)
{
    auto* command = app.add_subcommand("calibrate", "weighs a known mass with a Falcon to calibrate its force");
    auto  o       = std::make_shared<CalibrateOptions>();
    command->add_option("--mass", o->mass, "the mass that you will hang on the grip, 50 g to 500 g")
        ->capture_default_str();
    addDeviceOptions(*command, o->falcon, std::array{&kFalconRecord});
    command->add_flag("--emulator", o->emulator,
                      "calibrates an emulated Falcon with an emulated hand, in virtual time, as a demonstration");
    command->add_flag("--json", o->json, "machine-readable; instructions still go to standard error");
    command->footer(
        "The motors first find the command that carries the arm. Then the grip moves up and down by 8 mm while the\n"
        "mean force is measured, first without and then with the mass. This takes a minute; nothing may touch the\n"
        "grip meanwhile. The result is stored in $XDG_CONFIG_HOME/palpate (~/.config/palpate) by the Falcon's serial\n"
        "number; every command uses it, and carries the arm. Exit code 1: the weighing failed.\n"
        "Examples:\n"
        "  palpate calibrate --mass '200 g'\n"
        "  palpate calibrate --mass 0.1 --falcon-firmware falcon.bin\n"
        "  palpate calibrate --emulator --json");
    command->callback([o] { calibrate(*o); });
}

} // namespace palp
