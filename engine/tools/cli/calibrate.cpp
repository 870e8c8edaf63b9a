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
#include "engine/session/gripped_falcon.h"
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

/// Returns "50 g to 250 g".
std::string possibleMasses()
{
    const auto grams = [](double mass) { return std::to_string(std::lround(1000 * mass)) + " g"; };
    return grams(FalconCalibration::kLeastMass) + " to " + grams(FalconCalibration::kMostMass);
}

/// Reads "200 g" or "0.2" [kg].
double kilograms(const std::string& text)
{
    const double mass = parseQuantity(text, Dimension::mass, "--mass");
    if (mass >= FalconCalibration::kLeastMass && mass <= FalconCalibration::kMostMass) return mass;
    throw Error("--mass: expected " + possibleMasses() + ", found \"" + text + "\"" +
                (mass > FalconCalibration::kMostMass ? ": the motors could not hold it beside the arm" : ""));
}

/// A Falcon, a clock, and a user with a mass.
struct Bench {
    FalconDevice&                           device;
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

void tell(double mass, Stage stage)
{
    if (stage == Stage::lift)
        std::cerr << "palpate: lift the grip to the middle of its workspace and hold it there loosely; release it when "
                     "the force begins, within 2 s; the motors then find the command that carries the arm\n";
    if (stage == Stage::bare) std::cerr << "palpate: hands off: the arm moves up and down for 16 s and is weighed\n";
    if (stage == Stage::hang)
        std::cerr << "palpate: hang " << formatQuantity(1000 * mass, "g")
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
    std::string           serial;              ///< of the Falcon
    double                begun    = 0;        ///< [counts/(N m)] in use until then
    bool                  isBefore = false;    ///< every command ran with those
    double                counts = 0, arm = 0; ///< [counts/(N m)], [kg]
    std::optional<double> hold{};              ///< [s] empty: see whyNoHold
    std::string           whyNoHold{};         ///< "not found: ..." or "not measured: ..."
};

/// Goes through all stages with an open Falcon. However it ends, the device is closed, so its last force is zero.
Found weigh(double mass, Bench& bench)
{
    const HapticDeviceInfo& info = bench.device.info();
    Found found{.serial = info.serial, .begun = bench.device.countsInUse(), .isBefore = info.note.empty()};
    if (!found.isBefore)
        std::cerr << "palpate: warning: " << info.note << "; the weighing begins with " << std::lround(found.begun)
                  << " counts per N m\n";
    FalconCalibration calibration({.mass = mass, .countsPerTorque = found.begun});

    constexpr double          kPatience = 300; // [s] for all stages
    const std::atomic<bool>&  stop      = catchInterrupts();
    ForceGovernor             governor;
    HangsStill                hangsStill;
    GovernedForce             force;
    Stage                     told = Stage::failed;
    std::optional<FalconHold> hold;
    double                    weighed = 0; // [s] when the hold is begun to be measured
    const double              begin   = bench.wait();
    for (double last = begin, gain = 0, ill = 0; calibration.stage() < Stage::done || (hold && !hold->isDone());) {
        if (stop) throw Error("the calibration was interrupted; the force is off");
        if (calibration.stage() != told) tell(mass, told = calibration.stage());
        const double now = bench.wait(), dt = now - last;
        last = now;
        if (bench.act) bench.act(gain, told);
        bench.device.useCounts(calibration.countsInUse());
        const HapticState state = bench.device.exchange(force, now);
        GovernorInput     in;
        in.force = hold ? hold->step(bench.device, state, gain, dt) : calibration.step(state, force, gain, dt);
        if (!hold && calibration.stage() == Stage::done) {
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
        constexpr double kHoldPatience = 150; // [s] some 40 silences, each after 2 s
        const bool       isLost        = ill > 1 || out.fault != GovernorFault::none;
        if (hold && (isLost || now > weighed + kHoldPatience)) { // the weighing counts all the same
            found.whyNoHold = std::string("not measured: ") + (out.fault != GovernorFault::none ? name(out.fault)
                                                               : isLost                         ? name(state.fault)
                                                                        : "it took longer than two and a half minutes");
            break;
        }
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
    found.counts = calibration.countsPerTorque().value();
    found.arm    = calibration.armMass().value();
    if (hold) found.hold = hold->hold();
    if (!found.hold && found.whyNoHold.empty())
        found.whyNoHold = hold->fell() ? "not found: the grip fell, but not as one that is let go of"
                                       : "not found: the grip did not fall within half a second without a packet";
    return found;
}

Found weighReal(const CalibrateOptions& o, double mass)
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
    return weigh(mass, bench);
}

/// [counts/(N m)] the emulated Falcon's true value, which its driver does not know. It and the arm's weight are those
/// of `--hand falcon-emulator`, so what is stored is right there.
constexpr double kEmulatedCounts = EmulatedFalconSettings{}.countsPerTorque;

/// The emulated Falcon in virtual time, whose friction takes 0.05 N of its force, and a user with a mass within reach.
struct EmulatedBench {
    SimulatedArm  arm;
    double        hanging = 0; ///< [kg]
    double        asked   = 0; ///< [s] since the user was asked to hang the mass
    double        now     = 0; ///< [s]
    Ft232Emulator emulator;
    FalconDevice  falcon;

    static constexpr glm::dvec3 kHeld{0, 0.004, -0.006}; ///< [m] the place where the user first holds the grip

    explicit EmulatedBench(std::optional<double> countsByHand)
        : arm({.friction = 0.05, .encoderStep = 0, .delayTicks = 0}, kHeld),
          emulator(motors(), [this](const glm::dvec3& force, double dt) { return moved(force, dt); }),
          falcon([this] { return emulator.connect(); }, stepped(countsByHand))
    {
        falcon.open();
        now = emulator.now();
    }

    static Ft232EmulatorSettings motors()
    {
        Ft232EmulatorSettings settings  = GrippedFalcon::ready();
        settings.falcon.countsPerTorque = kEmulatedCounts;
        return settings;
    }

    static FalconDeviceSettings stepped(std::optional<double> countsByHand)
    {
        FalconDeviceSettings settings;
        settings.pace = FalconPace::stepped;
        settings.tune = [countsByHand](const std::string& serial) { return tuningToCalibrate(serial, countsByHand); };
        return settings;
    }

    /// The mass's inertia is omitted, because it does not change means.
    glm::dvec3 moved(const glm::dvec3& force, double dt)
    {
        arm.step(force - glm::dvec3(0, (emulatedFalconArm() + hanging) * 9.81, 0), dt);
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

Found weighEmulated(const CalibrateOptions& o, double mass)
{
    const auto byHand = countsByHand(o.falcon); // first: it may be refused
    std::cerr << "palpate: this Falcon and the hand that acts on it are emulated, faster than real time\n";
    EmulatedBench emulated(byHand);
    Bench bench{emulated.falcon, [&] { return emulated.now = std::max(emulated.now + 1e-3, emulated.emulator.now()); },
                [&](double gain, Stage stage) { emulated.act(gain, stage, mass); }};
    return weigh(mass, bench);
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
/// \param why  gets the reason if it cannot be stored
/// \return the file; empty, with a sentence, if it cannot be stored: the numbers are printed all the same
std::string store(const Found& found, std::string& why)
{
    try {
        return writeFalconConstants({.serial          = found.serial,
                                     .countsPerTorque = found.counts,
                                     .armMass         = found.arm,
                                     .date            = today(),
                                     .hold            = found.hold})
            .string();
    } catch (const Error& error) {
        why = error.what();
        std::cerr << "palpate: " << why << "; the calibration was measured, and is not stored\n";
        return {};
    }
}

/// Returns why the hold is not known, and what follows.
std::string adviceOnHold(const Found& found)
{
    return found.whyNoHold + ". Unplug its power, not its cable, to be sure of no force";
}

nlohmann::ordered_json jsonOf(const CalibrateOptions& o, double mass, const Found& found, const std::string& file)
{
    nlohmann::ordered_json report{
        {"counts_per_torque", found.counts},
        {"counts_per_torque_before", nullptr},
        {"arm_kg", found.arm},
        {"hold_s", nullptr},
        {"why_no_hold", nullptr},
        {"mass_kg", mass},
        {"file", file.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(file)},
        {"emulated", nullptr}};
    if (found.isBefore) report["counts_per_torque_before"] = found.begun;
    if (found.hold)
        report["hold_s"] = *found.hold;
    else
        report["why_no_hold"] = adviceOnHold(found);
    if (o.emulator) report["emulated"] = {{"counts_per_torque", kEmulatedCounts}, {"arm_kg", emulatedFalconArm()}};
    return report;
}

/// Prints who uses what was found. Of the emulated Falcon it only says so: its numbers are no other's.
void printUse(const CalibrateOptions& o, const Found& found, const std::string& file)
{
    const auto& record = o.emulator ? kFalconEmulatorRecord : kFalconRecord;
    if (o.emulator)
        std::printf("true values      %.0f and %.0f g: this Falcon is emulated, and no other has its numbers\n",
                    kEmulatedCounts, 1000 * emulatedFalconArm());
    if (file.empty())
        std::printf("%s palpate run SCENE --hand %s %s %.0f\n", o.emulator ? "would be used by" : "use it          ",
                    record.name.data(), kFalconCounts.flag.data(), found.counts);
    else if (o.emulator)
        std::printf("used by          --hand %s, as every command uses a real Falcon's: %s\n", record.name.data(),
                    file.c_str());
    else
        std::printf("use it           every command does from now on: %s\n", file.c_str());
}

void print(const CalibrateOptions& o, const Found& found, const std::string& file)
{
    if (found.isBefore)
        std::printf("counts per N m   %.0f   (%.0f before: the forces were %.2f times those asked for)\n", found.counts,
                    found.begun, found.begun / found.counts);
    else
        std::printf("counts per N m   %.0f   (nothing ran before, because the stored ones could not be used)\n",
                    found.counts);
    std::printf("the arm          %.0f g weigh on the grip\n", 1000 * found.arm);
    if (found.hold)
        std::printf(
            "its own hold     after %.0f ms without a packet its motors let go: so long a force lasts where only "
            "they can end it\n",
            1000 * *found.hold);
    else
        std::printf("its own hold     %s\n", adviceOnHold(found).c_str());
    printUse(o, found, file);
}

void calibrate(const CalibrateOptions& o)
{
    const double      mass  = kilograms(o.mass);
    const Found       found = o.emulator ? weighEmulated(o, mass) : weighReal(o, mass);
    std::string       whyNotStored;
    const std::string file = store(found, whyNotStored);
    if (o.json)
        std::cout << jsonText(jsonOf(o, mass, found, file));
    else
        print(o, found, file);
    if (file.empty()) throw CheckFailed(whyNotStored); // a script would go on with the old counts
}

} // namespace

void addCalibrateCommand(CLI::App& app)
{
    auto* command = app.add_subcommand("calibrate", "weighs a known mass with a Falcon to calibrate its force");
    auto  o       = std::make_shared<CalibrateOptions>();
    command->add_option("--mass", o->mass, "the mass that you will hang on the grip, " + possibleMasses())
        ->capture_default_str();
    addDeviceOptions(*command, o->falcon, std::array{&kFalconRecord});
    command->add_flag("--emulator", o->emulator,
                      "calibrates an emulated Falcon with an emulated hand, in virtual time, as a demonstration");
    command->add_flag("--json", o->json, "machine-readable; instructions still go to standard error");
    command->footer(
        "The motors first find the command that carries the arm. Then the grip moves up and down by 8 mm while the\n"
        "mean force is measured, first without and then with the mass. This takes a minute; nothing may touch the\n"
        "grip meanwhile. The result is stored in $XDG_CONFIG_HOME/palpate (~/.config/palpate) by the Falcon's serial\n"
        "number; every command uses it, and carries the arm. That of the emulated Falcon is used by falcon-emulator\n"
        "alone; remove falcon-EMULATED.json to be rid of it. Exit code 1: the weighing failed, or its\n"
        "result, which is printed all the same, could not be stored.\n"
        "Examples:\n"
        "  palpate calibrate --mass '200 g'\n"
        "  palpate calibrate --mass 0.1 --falcon-firmware falcon.bin\n"
        "  palpate calibrate --emulator --json");
    command->callback([command, o] {
        allowOnlyWith(*command, "--emulator", {"--mass", std::string(kFalconCounts.flag), "--json"});
        calibrate(*o);
    });
}

} // namespace palp
