#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "engine/compute/processor_list.h"
#include "engine/core/processor.h"
#include "engine/plate/host/host_kernels.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/haptic_list.h"

namespace palp {
namespace {

struct DevicesOptions {
    bool gpu    = false;
    bool haptic = false;
    bool json   = false;
};

/// What there is to compute on.
struct Machine {
    std::vector<compute::Processor>   gpus;
    std::optional<compute::Processor> host{compute::describeHost()};
    std::string                       processor{processorName()}, instructionSet{hostVariant().isa}; ///< of the host
    int                               taken = host->index; ///< index of the one that "auto" takes
};

std::string joined(const std::vector<std::string>& reasons)
{
    std::string text;
    for (const std::string& reason : reasons) text += (text.empty() ? "" : ", ") + reason;
    return text;
}

nlohmann::ordered_json orNull(const std::string& text)
{
    return text.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(text);
}

nlohmann::ordered_json jsonOf(const compute::Processor& device, const Machine& machine)
{
    const bool isHost = device.kind == compute::kHostProcessor;
    return {{"index", isHost ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(device.index)},
            {"name", device.name},
            {"kind", device.kind},
            {"driver", orNull(device.driver)},
            {"api", orNull(device.api)},
            {"processor", orNull(isHost ? machine.processor : "")},
            {"instruction_set", orNull(isHost ? machine.instructionSet : "")},
            {"memory", device.memory},
            {"float64", device.float64},
            {"usable", device.refusals.empty()},
            {"refusals", device.refusals},
            {"auto", device.index == machine.taken}};
}

nlohmann::ordered_json jsonOf(const Machine& machine)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const compute::Processor& device : machine.gpus) list.push_back(jsonOf(device, machine));
    if (machine.host) list.push_back(jsonOf(*machine.host, machine));
    return list;
}

void printText(const compute::Processor& device, const Machine& machine)
{
    const bool isHost = device.kind == compute::kHostProcessor;
    std::cout << (isHost ? device.name + "  " + machine.processor : std::to_string(device.index) + "  " + device.name)
              << "\n   kind     " << device.kind << "\n   "
              << (isHost ? "code     native, for " + machine.instructionSet
                         : "driver   " + device.driver + ", Vulkan " + device.api);
    std::cout << "\n   memory   " << (device.memory >> 20) << " MiB\n   float64  " << (device.float64 ? "yes" : "no")
              << "\n   usable   " << (device.refusals.empty() ? "yes" : "no: " + joined(device.refusals))
              << (device.index == machine.taken ? "; auto takes it" : "") << "\n";
}

void printText(const HapticList& haptics)
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
    }
    std::cout << "looked for with " << hapticSupport() << "\n";
}

/// Vulkan may be broken: the host is there all the same.
/// \throws compute::ProcessorError if Vulkan does not start and only GPUs are asked for
Machine lookAtMachine(const DevicesOptions& options)
{
    Machine machine;
    try {
        machine.gpus = compute::listProcessors();
    } catch (const compute::ProcessorError& error) {
        if (options.gpu) throw;
        std::cerr << "palpate: the host only: " << error.what() << "\n";
    }
    if (const auto best = compute::chooseProcessor(machine.gpus, compute::kAutoProcessor))
        machine.taken = machine.gpus[*best].index;
    if (options.gpu) machine.host.reset();
    return machine;
}

/// \throws compute::ProcessorError, after printing, if only GPUs are asked for and none can be used
void printComputing(const DevicesOptions& options)
{
    const Machine machine = lookAtMachine(options);
    if (options.json) {
        std::cout << jsonText(jsonOf(machine));
    } else {
        if (!options.gpu) std::cout << "to compute on\n";
        for (const compute::Processor& device : machine.gpus) printText(device, machine);
        if (machine.host) printText(*machine.host, machine);
    }
    std::cout.flush();
    if (options.gpu && std::ranges::none_of(machine.gpus, [](const auto& device) { return device.refusals.empty(); }))
        throw compute::ProcessorError(
            "no GPU can be used: install the vendor's driver, or mesa-vulkan-drivers for one in software");
}

HapticList lookForHaptics()
{
    HapticList haptics = listHaptics();
    for (const std::string& trouble : haptics.troubles) std::cerr << "palpate: " << trouble << "\n";
    return haptics;
}

void printDevices(const DevicesOptions& options)
{
    if (options.gpu) return printComputing(options);
    if (options.haptic) {
        const HapticList haptics = lookForHaptics();
        if (options.json)
            std::cout << jsonText(jsonOf(haptics.devices));
        else
            printText(haptics);
        return;
    }
    if (options.json) {
        const Machine machine = lookAtMachine(options);
        std::cout << jsonText(
            nlohmann::ordered_json{{"compute", jsonOf(machine)}, {"haptic", jsonOf(lookForHaptics().devices)}});
        return;
    }
    printComputing(options);
    std::cout << "\nas a hand\n";
    printText(lookForHaptics());
}

} // namespace

void addDevicesCommand(CLI::App& app)
{
    CLI::App* command = app.add_subcommand("devices", "what this machine can compute on, and what can serve as a hand");
    const auto   options = std::make_shared<DevicesOptions>();
    CLI::Option* gpu =
        command->add_flag("--gpu", options->gpu, "only GPUs, as Vulkan sees them; exit code 4: none can be used");
    command->add_flag("--haptic", options->haptic, "only haptic devices, and what stands in for one")->excludes(gpu);
    command->add_flag(
        "--json", options->json,
        "machine-readable: a list with --gpu or --haptic, else an object with both, \"compute\" and \"haptic\"; "
        "\"auto\" is true for the one that --device auto takes");
    command->footer(
        "A GPU is named by its index or part of its name; \"host\" is this processor, with native code for the\n"
        "best instruction set that it has; the environment variable PALPATE_HOST_ISA sets a limit (portable,\n"
        "avx2 or avx512). --device auto takes a GPU, discrete before integrated before virtual, else the host;\n"
        "a device in software only if it is named, by \"lavapipe\" too.\n"
        "A haptic device is opened and let go again to see whether that works; one that cannot be used comes with\n"
        "the reason, and with what helps. \"palpate doctor\" looks at the rest of the machine.\n"
        "Examples:\n"
        "  palpate devices\n"
        "  palpate devices --gpu --json\n"
        "  palpate devices --haptic");
    command->callback([options] { printDevices(*options); });
}

} // namespace palp
