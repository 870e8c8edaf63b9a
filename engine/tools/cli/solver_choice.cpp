#include "engine/tools/cli/solver_choice.h"

#include <iostream>

#include "engine/core/contract.h"
#include "engine/session/scene_keys.h"

namespace palp {

void SolverChoice::addTo(CLI::App& command)
{
    command.add_option("--solver", solver, std::string(sceneKey("solver").help))->capture_default_str();
    command.add_option("--tolerance", tolerance, std::string(sceneKey("tolerance").help))->capture_default_str();
}

PlateSolver SolverChoice::open() const
{
    checkTolerance(tolerance);
    return openSolver(solver);
}

PlateSolver openSolver(const std::string& name)
{
    PlateSolver opened = orTheReference([&] { return PlateSolver(name); });
    sayPassedOver(opened.name(), opened.note());
    return opened;
}

void sayPassedOver(const std::string& name, const std::string& note)
{
    if (!note.empty()) std::cerr << "palpate: auto takes " << name << ": " << note << "\n";
}

void sayTakeover(const std::string& sentence)
{
    if (!sentence.empty()) std::cerr << "palpate: " << sentence << "\n";
}

std::string sayTakeovers(const PlateSolver& solver, int told, const std::string& inSession)
{
    const std::string last = solver.takeoverSince(0);
    std::string       now  = solver.takeoverSince(told);
    if (now.empty() && inSession != last) now = inSession; // the same: both found the same processor broken
    sayTakeover(now);
    return now.empty() ? last : now;
}

void checkTolerance(double tolerance)
{
    const SceneKey& key = sceneKey("tolerance");
    if (tolerance >= key.bounds->least && tolerance <= key.bounds->most) return;
    throw Error("--tolerance: expected " + key.expected() + ", found " + plainNumber(tolerance));
}

} // namespace palp
