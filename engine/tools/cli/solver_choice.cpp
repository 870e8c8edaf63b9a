#include "engine/tools/cli/solver_choice.h"

#include <iostream>
#include <sstream>

#include "engine/core/contract.h"
#include "engine/plate/multigrid/multigrid_plate_solver.h"

namespace palp {

void SolverChoice::addTo(CLI::App& command)
{
    command
        .add_option(
            "--device", device,
            "where the plate is solved: auto (the best GPU, else the host), host (the shaders' arithmetic as native "
            "code "
            "on this processor), lavapipe (Vulkan in software: much slower), an index or part of a name "
            "from \"palpate devices\", or reference (sparse Cholesky in double precision)")
        ->capture_default_str();
    command
        .add_option("--tolerance", tolerance,
                    "of the solver's error, relative in the energy norm; the reference has none of its own")
        ->capture_default_str();
}

PlateSolver SolverChoice::open() const
{
    checkTolerance(tolerance);
    PlateSolver opened = orTheReference([&] { return PlateSolver(device); });
    sayPassedOver(opened.name(), opened.note());
    return opened;
}

void sayPassedOver(const std::string& name, const std::string& note)
{
    if (!note.empty()) std::cerr << "palpate: auto takes " << name << ": " << note << "\n";
}

void checkTolerance(double tolerance)
{
    if (tolerance >= MultigridPlateSolver::kLeastTolerance && tolerance < 1) return;
    std::ostringstream text;
    text << "--tolerance: expected at least " << MultigridPlateSolver::kLeastTolerance
         << " (what 32-bit rigidities and cycles can give) and below 1, found " << tolerance;
    throw Error(text.str());
}

} // namespace palp
