#include "engine/plate/shell.h"

#include <algorithm>
#include <cmath>

namespace palp {
namespace {

bool isFinite(const NodeField& field)
{
    return std::ranges::all_of(field.values(), [](double value) { return std::isfinite(value); });
}

} // namespace

Plate membraneOf(const Shell& shell)
{
    Plate membrane;
    membrane.grid         = shell.bending.grid;
    membrane.edges        = shell.stressEdges;
    membrane.poissonRatio = -shell.bending.poissonRatio;
    membrane.rigidity     = shell.membraneCompliance;
    return membrane;
}

bool isStressFree(const Shell& shell) noexcept
{
    return shell.stressEdges == PlateEdges{Edge::free, Edge::free, Edge::free, Edge::free};
}

std::optional<std::string> whyUnsolvable(const Shell& shell)
{
    if (auto why = whyUnsolvable(shell.bending)) return why;
    const PlateGrid& grid = shell.bending.grid;
    if (!shell.membraneCompliance.on(grid)) return "the membrane's compliance is on another grid than the rigidity";
    if (!std::ranges::all_of(shell.membraneCompliance.values(), [](double c) { return c > 0 && std::isfinite(c); }))
        return "the membrane's compliance has to be positive and finite everywhere";
    for (const NodeField* curvature : {&shell.curvatureX, &shell.curvatureZ, &shell.curvatureXZ}) {
        if (!curvature->on(grid)) return "a curvature is on another grid than the rigidity";
        if (!isFinite(*curvature)) return "a curvature is not finite";
    }
    if (shell.bending.poissonRatio < 0) return "a shell's Poisson's ratio has to be at least 0";
    if (isStressFree(shell)) return std::nullopt;
    if (const auto why = whyUnsolvable(membraneOf(shell)))
        return "the edges of the membrane: " + *why + " (let all four be free or hold two neighbouring sides)";
    return std::nullopt;
}

} // namespace palp
