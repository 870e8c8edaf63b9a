#include "engine/plate/plate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace palp {
namespace {

template <class... Part>
std::string sentence(const Part&... part)
{
    std::ostringstream text;
    (text << ... << part);
    return text.str();
}

bool isPositive(double value)
{
    return std::isfinite(value) && value > 0;
}

std::optional<std::string> whyGridIsBad(const PlateGrid& grid)
{
    if (grid.cellsX < kFewestPlateCells || grid.cellsZ < kFewestPlateCells)
        return sentence("the grid must have at least ", kFewestPlateCells, " x ", kFewestPlateCells, " cells, found ",
                        grid.cellsX, " x ", grid.cellsZ);
    if (!isPositive(grid.spacingX) || !isPositive(grid.spacingZ))
        return sentence("the spacing must be positive and finite, found ", grid.spacingX, " m x ", grid.spacingZ, " m");
    return std::nullopt;
}

std::optional<std::string> whyRigidityIsBad(const Plate& plate)
{
    const NodeField& rigidity = plate.rigidity;
    if (!rigidity.on(plate.grid))
        return sentence("the rigidity must have one value per node, expected ", plate.grid.nodesX(), " x ",
                        plate.grid.nodesZ(), ", found ", rigidity.nodesX(), " x ", rigidity.nodesZ());
    const auto bad = std::find_if_not(rigidity.values().begin(), rigidity.values().end(), isPositive);
    if (bad == rigidity.values().end()) return std::nullopt;
    const auto index = bad - rigidity.values().begin();
    return sentence("the rigidity must be positive and finite, found ", *bad, " N m at node [",
                    index / rigidity.nodesZ(), ", ", index % rigidity.nodesZ(), "]");
}

/// The rigid motions a + b x + c z: one clamped side stops all three, a supported side leaves the turn about itself,
/// any foundation stops all.
bool isHeld(const Plate& plate)
{
    const std::array sides = {plate.edges.x0, plate.edges.x1, plate.edges.z0, plate.edges.z1};
    return plate.foundation > 0 || std::ranges::count(sides, Edge::clamped) >= 1 ||
           std::ranges::count(sides, Edge::supported) >= 2;
}

} // namespace

const char* name(Edge edge) noexcept
{
    return edge == Edge::clamped ? "clamped" : edge == Edge::supported ? "supported" : "free";
}

std::optional<Edge> edgeNamed(std::string_view text)
{
    for (Edge edge : {Edge::clamped, Edge::supported, Edge::free})
        if (name(edge) == text) return edge;
    return {};
}

std::optional<std::string> whyUnsolvable(const Plate& plate)
{
    if (auto why = whyGridIsBad(plate.grid)) return why;
    if (!isPoissonRatio(plate.poissonRatio))
        return sentence("Poisson's ratio must be above -1 and at most 0.5, found ", plate.poissonRatio);
    if (!(std::isfinite(plate.foundation) && plate.foundation >= 0))
        return sentence("the foundation must be finite and not negative, found ", plate.foundation, " Pa/m");
    if (auto why = whyRigidityIsBad(plate)) return why;
    if (!isHeld(plate))
        return "the plate is free to move as a rigid body: clamp one side, support two, or give it a foundation";
    return std::nullopt;
}

} // namespace palp
