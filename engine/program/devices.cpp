#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "engine/gpu/device_list.h"
#include "engine/program/commands.h"

namespace palp {
namespace {

std::string joined(const std::vector<std::string>& reasons)
{
    std::string text;
    for (const std::string& reason : reasons) text += (text.empty() ? "" : ", ") + reason;
    return text;
}

void printJson(const std::vector<gpu::DeviceDescription>& devices)
{
    nlohmann::json list = nlohmann::json::array();
    for (const gpu::DeviceDescription& device : devices)
        list.push_back({{"index", device.index},
                        {"name", device.name},
                        {"kind", device.kind},
                        {"driver", device.driver},
                        {"api", device.api},
                        {"memory", device.memory},
                        {"float64", device.float64},
                        {"usable", device.refusals.empty()},
                        {"refusals", device.refusals}});
    std::cout << list.dump(2) << "\n";
}

void printText(const std::vector<gpu::DeviceDescription>& devices)
{
    for (const gpu::DeviceDescription& device : devices)
        std::cout << device.index << "  " << device.name << "\n   kind     " << device.kind << "\n   driver   "
                  << device.driver << ", Vulkan " << device.api << "\n   memory   " << (device.memory >> 20)
                  << " MiB\n   float64  " << (device.float64 ? "yes" : "no") << "\n   usable   "
                  << (device.refusals.empty() ? "yes" : "no: " + joined(device.refusals)) << "\n";
}

struct DevicesOptions {
    bool gpu  = false;
    bool json = false;
};

/// \throws gpu::DeviceError, after printing, if no device is usable
void printGpus(bool json)
{
    const std::vector<gpu::DeviceDescription> devices = gpu::listDevices();
    json ? printJson(devices) : printText(devices);
    std::cout.flush();
    (void)gpu::chooseDevice(devices, "auto");
}

} // namespace

void addDevicesCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("devices", "what this machine can compute on");
    const auto options = std::make_shared<DevicesOptions>();
    command->add_flag("--gpu", options->gpu,
                      "the GPUs, as Vulkan sees them (so far the only kind of device, hence the default)");
    command->add_flag("--json", options->json, "machine-readable");
    command->footer("A device is named by its index or part of its name. Exit code 4: none can be used.\n"
                    "Examples:\n"
                    "  palpate devices --gpu");
    command->callback([options] { printGpus(options->json); });
}

} // namespace palp
