#include "engine/program/solver_choice.h"

#include <iostream>
#include <sstream>

#include "engine/core/contract.h"
#include "engine/gpu/device_list.h"
#include "engine/plate/plate_solver_vulkan.h"

namespace palp {

void SolverChoice::addTo(CLI::App& command)
{
    command
        .add_option(
            "--device", device,
            "where the plate is solved: auto (the best Vulkan device), host (the same kernels as native code on this "
            "processor), lavapipe (Vulkan in software), an index or part of a name from \"palpate devices\", or "
            "reference (sparse Cholesky in double precision)")
        ->capture_default_str();
    command
        .add_option("--tolerance", tolerance,
                    "of the solver's error, relative in the energy norm; the reference has none of its own")
        ->capture_default_str();
}

PlateDevice SolverChoice::open() const
{
    checkTolerance(tolerance);
    PlateDevice opened = orTheReference([&] { return PlateDevice(deviceWord(device)); });
    if (!opened.note().empty())
        std::cerr << "palpate: no Vulkan device, so the reference solver takes over: " << opened.note() << "\n";
    return opened;
}

void checkTolerance(double tolerance)
{
    if (tolerance >= VulkanPlateSolver::kLeastTolerance && tolerance < 1) return;
    std::ostringstream text;
    text << "--tolerance: expected at least " << VulkanPlateSolver::kLeastTolerance
         << " (what 32-bit rigidities and cycles can give) and below 1, found " << tolerance;
    throw Error(text.str());
}

std::string deviceWord(const std::string& given)
{
    const std::string word = CLI::ignore_case(given);
    return word == "auto" || word == "reference" || word == gpu::kHostDevice ? word : given;
}

} // namespace palp
