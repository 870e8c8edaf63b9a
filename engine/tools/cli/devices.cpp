#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "engine/compute/processor_list.h"
#include "engine/core/processor.h"
#include "engine/core/quantity.h"
#include "engine/plate/host/host_kernels.h"
#include "engine/plate/plate_solver.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/haptic_list.h"

namespace palp {
namespace {

struct DevicesOptions {
    bool haptic     = false;
    bool processors = false;
    bool gpus       = false;
    bool json       = false;
};

constexpr int    kTrialCells = 64, kTrialLoads = 9; ///< as sessions have them
constexpr double kTrialApart = 1.0 / 60;            ///< [s]

/// The processors of this machine that can solve plates.
struct Machine {
    std::vector<compute::Processor>   gpus;
    std::optional<compute::Processor> host{compute::describeHost()}; ///< empty: only GPUs were asked for
    std::string                       processor{processorName()}, instructionSet{hostVariant().isa}; ///< of the host
    int                               taken = host->index; ///< index of the one that "auto" takes
    std::map<int, double>             trialMs; ///< by index, of those that "auto" may take and that solved it
};

std::string joined(const std::vector<std::string>& reasons)
{
    std::string text;
    for (const std::string& reason : reasons) text += (text.empty() ? "" : ", ") + reason;
    return text;
}

std::optional<double> trialOf(const Machine& machine, int index)
{
    const auto found = machine.trialMs.find(index);
    return found == machine.trialMs.end() ? std::nullopt : std::optional(found->second);
}

nlohmann::ordered_json jsonOf(const compute::Processor& unit, const Machine& machine)
{
    const bool isHost = unit.kind == compute::ProcessorKind::host;
    const auto trial  = trialOf(machine, unit.index);
    return {{"index", isHost ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(unit.index)},
            {"name", unit.name},
            {"kind", name(unit.kind)},
            {"driver", orNull(unit.driver)},
            {"api", orNull(unit.api)},
            {"processor", orNull(isHost ? machine.processor : "")},
            {"instruction_set", orNull(isHost ? machine.instructionSet : "")},
            {"memory", unit.memory},
            {"float64", unit.float64},
            {"usable", unit.refusals.empty()},
            {"refusals", unit.refusals},
            {"trial_ms", trial ? nlohmann::ordered_json(*trial) : nlohmann::ordered_json(nullptr)},
            {"auto", unit.index == machine.taken}};
}

nlohmann::ordered_json jsonOf(const Machine& machine)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const compute::Processor& unit : machine.gpus) list.push_back(jsonOf(unit, machine));
    if (machine.host) list.push_back(jsonOf(*machine.host, machine));
    return list;
}

void printText(const compute::Processor& unit, const Machine& machine)
{
    const bool isHost = unit.kind == compute::ProcessorKind::host;
    std::cout << (isHost ? unit.name + "  " + machine.processor : std::to_string(unit.index) + "  " + unit.name)
              << "\n   kind     " << name(unit.kind) << "\n   "
              << (isHost ? "code     native, for " + machine.instructionSet
                         : "driver   " + unit.driver + ", Vulkan " + unit.api);
    if (const auto trial = trialOf(machine, unit.index))
        std::cout << "\n   time     " << formatQuantity(*trial / 1e3, "s") << " for a new map and " << kTrialLoads
                  << " loads on " << kTrialCells << " x " << kTrialCells << " cells";
    std::cout << "\n   memory   " << (unit.memory >> 20) << " MiB\n   float64  " << (unit.float64 ? "yes" : "no")
              << "\n   usable   " << (unit.refusals.empty() ? "yes" : "no: " + joined(unit.refusals))
              << (unit.index == machine.taken ? "; sessions with auto take it" : "") << "\n";
}

void printText(const DeviceList& haptics)
{
    for (const DeviceListing& device : haptics.devices) {
        std::cout << device.name << "  " << device.model << "\n";
        if (!device.path.empty()) std::cout << "   path     " << device.path << "\n";
        std::cout << "   usable   " << (device.usable ? "yes" : "no")
                  << (device.why.empty() ? ""
                      : device.usable    ? ", but "
                                         : ": ")
                  << device.why << "\n";
        if (!device.help.empty()) std::cout << "   help     " << device.help << "\n";
        if (const auto& rate = device.exchange)
            std::cout << "   answers  " << std::lround(rate->perSecond) << " a second, "
                      << formatQuantity(rate->age, "s") << " old when they come, at most "
                      << formatQuantity(rate->longest, "s") << " apart\n";
        if (!device.calibration.empty()) std::cout << "   force    " << device.calibration << "\n";
    }
    std::cout << "looked for with " << hapticSupport() << "\n";
}

/// Measures what "auto" compares, on the processors that it may take.
void timeCandidates(Machine& machine)
{
    using enum compute::ProcessorKind;
    PlateTrial trial = plateTrial(kTrialCells, kTrialLoads);
    trial.apart      = kTrialApart;
    const auto time  = [&](int index, const std::string& word) {
        try {
            machine.trialMs[index] = PlateSolver(word).timeOf(trial);
        } catch (const std::exception& error) {
            std::cerr << "palpate: no time of " << word << ": " << error.what() << "\n";
        }
    };
    for (const compute::Processor& unit : machine.gpus)
        if (unit.refusals.empty() && unit.kind != software && unit.kind != other)
            time(unit.index, std::to_string(unit.index));
    time(machine.host->index, std::string(compute::kHostProcessor));
    const auto best = trialOf(machine, machine.taken), native = trialOf(machine, machine.host->index);
    if (!best || (native && *native < *best)) machine.taken = machine.host->index;
}

/// Lists the processors; where Vulkan is broken the host remains.
/// \throws compute::ProcessorError if Vulkan does not start and only GPUs are asked for
Machine lookAtMachine(const DevicesOptions& options)
{
    Machine machine;
    try {
        machine.gpus = compute::listProcessors();
    } catch (const compute::ProcessorError& error) {
        if (options.gpus) throw;
        std::cerr << "palpate: only the host can compute: " << error.what() << "\n";
    }
    if (const auto best = compute::chooseProcessor(machine.gpus, compute::kAutoProcessor))
        machine.taken = machine.gpus[*best].index;
    timeCandidates(machine);
    if (options.gpus) machine.host.reset();
    return machine;
}

/// \throws compute::ProcessorError, after printing, if only GPUs are asked for and none can be used
void printProcessors(const DevicesOptions& options, const Machine& machine)
{
    if (options.json) {
        std::cout << jsonText(jsonOf(machine));
    } else {
        for (const compute::Processor& unit : machine.gpus) printText(unit, machine);
        if (machine.host) printText(*machine.host, machine);
    }
    std::cout.flush();
    if (options.gpus && std::ranges::none_of(machine.gpus, [](const auto& unit) { return unit.refusals.empty(); }))
        throw compute::ProcessorError(
            "no GPU can be used: install the vendor's driver, or mesa-vulkan-drivers for one in software");
}

DeviceList lookForHaptics()
{
    DeviceList haptics = listHaptics();
    measureExchanges(haptics.devices);
    for (const std::string& trouble : haptics.troubles) std::cerr << "palpate: " << trouble << "\n";
    return haptics;
}

void printHaptics(const DevicesOptions& options)
{
    const DeviceList haptics = lookForHaptics();
    if (options.json)
        std::cout << jsonText(jsonOf(haptics.devices));
    else
        printText(haptics);
}

void printDevices(const DevicesOptions& options)
{
    if (options.haptic) return printHaptics(options);
    const Machine machine = lookAtMachine(options); // first: where it throws, nothing has been printed
    if (options.processors || options.gpus) return printProcessors(options, machine);
    if (options.json) {
        const auto haptics = jsonOf(lookForHaptics().devices);
        std::cout << jsonText(nlohmann::ordered_json{{"haptic", haptics}, {"processors", jsonOf(machine)}});
        return;
    }
    std::cout << "haptic devices\n";
    printHaptics(options);
    std::cout << "\nprocessors that solve plates\n";
    printProcessors(options, machine);
}

} // namespace

void addDevicesCommand(CLI::App& app)
{
    CLI::App*    command = app.add_subcommand("devices", "lists haptic devices and the processors that solve plates");
    const auto   options = std::make_shared<DevicesOptions>();
    CLI::Option* haptic  = command->add_flag("--haptic", options->haptic, "lists only haptic devices");
    CLI::Option* all     = command->add_flag("--processors", options->processors,
                                             "lists only processors: GPUs, as Vulkan sees them, and the host");
    command->add_flag("--gpus", options->gpus, "lists only GPUs; exit code 4 if none can be used")
        ->excludes(haptic, all);
    all->excludes(haptic);
    command->add_flag("--json", options->json,
                      "machine-readable: a list if only one kind is asked for, else an object with \"haptic\" and "
                      "\"processors\"; \"auto\" is true for the processor that a session with auto takes");
    command->footer(
        "Each haptic device is opened and closed again as a test; for one that cannot be used the list gives the\n"
        "reason and a remedy. One with motors is asked for half a second, at zero force, how often it answers and how\n"
        "old its answers are: from that follows how stiff a wall may be. \"palpate doctor\" examines the rest of the\n"
        "machine.\n"
        "A GPU is named by its index or by a part of its name; \"host\" is this processor, with native code for the\n"
        "best instruction set that it has; the environment variable PALPATE_HOST_ISA sets a limit (portable,\n"
        "avx2 or avx512). auto takes a GPU, discrete before integrated before virtual, else the host. It never takes\n"
        "a GPU in software; choose one by its name, or by \"lavapipe\". A session with auto first solves a plate of\n"
        "its own size and number of loads on that GPU and on the host, and keeps the faster one; the times listed are\n"
        "those of such a trial.\n"
        "Examples:\n"
        "  palpate devices\n"
        "  palpate devices --processors --json\n"
        "  palpate devices --haptic");
    command->callback([options] { printDevices(*options); });
}

} // namespace palp
