#include "engine/program/solver_choice.h"

#include <iostream>
#include <sstream>

#include "engine/core/contract.h"
#include "engine/plate/plate_solver_vulkan.h"

namespace palp {

void SolverChoice::addTo(CLI::App& command)
{
    command
        .add_option(
            "--device", device,
            "where the plate is solved: auto (the best Vulkan device), lavapipe (Vulkan in software), an index or "
            "part of a name from \"palpate devices\", or reference (sparse Cholesky in double precision)")
        ->capture_default_str();
    command
        .add_option("--tolerance", tolerance,
                    "of the solver's error, relative in the energy norm; the reference has none of its own")
        ->capture_default_str();
}

PlateDevice SolverChoice::open() const
{
    if (!(tolerance >= VulkanPlateSolver::kLeastTolerance && tolerance < 1)) {
        std::ostringstream text;
        text << "--tolerance: expected " << VulkanPlateSolver::kLeastTolerance
             << " (what 32-bit rigidities and cycles can give) to 1, found " << tolerance;
        throw Error(text.str());
    }
    PlateDevice opened(device);
    if (!opened.note().empty())
        std::cerr << "palpate: no Vulkan device, so the reference solver takes over: " << opened.note() << "\n";
    return opened;
}

} // namespace palp
