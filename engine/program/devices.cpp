#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "engine/core/processor.h"
#include "engine/gpu/device_list.h"
#include "engine/plate/host_kernels.h"
#include "engine/program/commands.h"

namespace palp {
namespace {

struct DevicesOptions {
    bool gpu  = false;
    bool json = false;
};

/// What there is to compute on.
struct Machine {
    std::vector<gpu::DeviceDescription>   gpus;
    std::optional<gpu::DeviceDescription> host{gpu::describeHost()};
    std::string processor{processorName()}, instructionSet{hostVariant().isa}; ///< of the host
    int         taken = host->index;                                           ///< index of the one that "auto" takes
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

nlohmann::ordered_json jsonOf(const gpu::DeviceDescription& device, const Machine& machine)
{
    const bool isHost = device.kind == gpu::kHostDevice;
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

void printJson(const Machine& machine)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const gpu::DeviceDescription& device : machine.gpus) list.push_back(jsonOf(device, machine));
    if (machine.host) list.push_back(jsonOf(*machine.host, machine));
    std::cout << list.dump(2) << "\n";
}

void printText(const gpu::DeviceDescription& device, const Machine& machine)
{
    const bool isHost = device.kind == gpu::kHostDevice;
    std::cout << (isHost ? device.name + "  " + machine.processor : std::to_string(device.index) + "  " + device.name)
              << "\n   kind     " << device.kind << "\n   "
              << (isHost ? "code     native, for " + machine.instructionSet
                         : "driver   " + device.driver + ", Vulkan " + device.api);
    std::cout << "\n   memory   " << (device.memory >> 20) << " MiB\n   float64  " << (device.float64 ? "yes" : "no")
              << "\n   usable   " << (device.refusals.empty() ? "yes" : "no: " + joined(device.refusals))
              << (device.index == machine.taken ? "; auto takes it" : "") << "\n";
}

/// Vulkan may be broken: the host is there all the same.
/// \throws gpu::DeviceError, after printing, if only GPUs are asked for and none can be used
void printDevices(const DevicesOptions& options)
{
    Machine machine;
    try {
        machine.gpus = gpu::listDevices();
    } catch (const gpu::DeviceError& error) {
        if (options.gpu) throw;
        std::cerr << "palpate: the host only: " << error.what() << "\n";
    }
    if (const auto best = gpu::chooseDevice(machine.gpus, gpu::kAutoDevice)) machine.taken = machine.gpus[*best].index;
    if (options.gpu) machine.host.reset();

    if (options.json) {
        printJson(machine);
    } else {
        for (const gpu::DeviceDescription& device : machine.gpus) printText(device, machine);
        if (machine.host) printText(*machine.host, machine);
    }
    std::cout.flush();
    if (options.gpu && std::ranges::none_of(machine.gpus, [](const auto& device) { return device.refusals.empty(); }))
        throw gpu::DeviceError(
            "no GPU can be used: install the vendor's driver, or mesa-vulkan-drivers for one in software");
}

} // namespace

void addDevicesCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("devices", "what this machine can compute on");
    const auto options = std::make_shared<DevicesOptions>();
    command->add_flag("--gpu", options->gpu, "only GPUs, as Vulkan sees them; exit code 4: none can be used");
    command->add_flag("--json", options->json,
                      "machine-readable; \"auto\" is true for the one that --device auto takes");
    command->footer(
        "A GPU is named by its index or part of its name; \"host\" is this processor, with native code for the\n"
        "best instruction set that it has; the environment variable PALPATE_HOST_ISA sets a limit (portable,\n"
        "avx2 or avx512). --device auto takes a GPU, discrete before integrated before virtual, else the host;\n"
        "a device in software only if it is named, by \"lavapipe\" too.\n"
        "Examples:\n"
        "  palpate devices\n"
        "  palpate devices --gpu --json");
    command->callback([options] { printDevices(*options); });
}

} // namespace palp
