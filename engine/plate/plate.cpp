#include "engine/plate/plate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/core/contract.h"
#include "engine/core/extremes.h"
#include "engine/core/nearest_name.h"

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

std::optional<std::string> whyRigidityIsBad(const PlateGrid& grid, const NodeField& rigidity)
{
    if (!rigidity.on(grid))
        return sentence("the rigidity must have one value per node, expected ", grid.nodesX(), " x ", grid.nodesZ(),
                        ", found ", rigidity.nodesX(), " x ", rigidity.nodesZ());
    const Extremes of = extremesOf(rigidity.values());
    if (of.finite && of.least > 0) return std::nullopt;
    const auto bad   = std::find_if_not(rigidity.values().begin(), rigidity.values().end(), isPositive);
    const auto index = bad - rigidity.values().begin();
    return sentence("the rigidity must be positive and finite, found ", *bad, " N m at node [",
                    index / rigidity.nodesZ(), ", ", index % rigidity.nodesZ(), "]");
}

/// Returns whether the sides stop the rigid motions a + b x + c z. A side across x that holds its nodes stops a + b x0
/// and c, one that holds its slope stops b.
bool isHeldBySides(const Plate& plate)
{
    const auto [x0, x1, z0, z1] = plate.edges;
    const bool b =
        holdsSlope(x0) || holdsSlope(x1) || holdsNodes(z0) || holdsNodes(z1) || (holdsNodes(x0) && holdsNodes(x1));
    const bool c =
        holdsSlope(z0) || holdsSlope(z1) || holdsNodes(x0) || holdsNodes(x1) || (holdsNodes(z0) && holdsNodes(z1));
    return b && c && (holdsNodes(x0) || holdsNodes(x1) || holdsNodes(z0) || holdsNodes(z1));
}

std::optional<std::string> whyShapeIsBad(const PlateGrid& grid, const NodeField& shape)
{
    if (shape.values().empty()) return std::nullopt;
    if (!shape.on(grid))
        return sentence("the foundation must have one value per node, expected ", grid.nodesX(), " x ", grid.nodesZ(),
                        ", found ", shape.nodesX(), " x ", shape.nodesZ());
    const auto isGood = [](double s) { return s >= 0 && s <= kMostFoundationShape; };
    const auto bad    = std::ranges::find_if_not(shape.values(), isGood);
    if (bad == shape.values().end()) return std::nullopt;
    const auto index = bad - shape.values().begin();
    return sentence("the foundation must be finite and not negative, at most ", kMostFoundationShape,
                    " times its unit, found ", *bad, " times at node [", index / shape.nodesZ(), ", ",
                    index % shape.nodesZ(), "]");
}

/// Returns at least how firmly a foundation of this shape holds a rigid plate beside one that is 1 everywhere (which
/// has 0.44) [1]: the least of the shares with which it resists a shift and turns about two axes, all of them together.
double shareOfRigidMotions(const NodeField& shape)
{
    if (shape.values().empty()) return 1;
    glm::dmat3 held(0);
    glm::dvec3 whole(0); // of an even foundation, for which the three motions do not mix
    for (int i = 0; i < shape.nodesX(); ++i)
        for (int j = 0; j < shape.nodesZ(); ++j) {
            const glm::dvec3 motion(1, 2.0 * i / (shape.nodesX() - 1) - 1, 2.0 * j / (shape.nodesZ() - 1) - 1);
            whole += motion * motion;
            held += shape(i, j) * glm::outerProduct(motion, motion);
        }
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) held[a][b] /= std::sqrt(whole[a] * whole[b]);
    // The product of the two larger eigenvalues is at most the square of their mean.
    const double trace = held[0][0] + held[1][1] + held[2][2];
    return trace > 0 ? std::clamp(glm::determinant(held) / (trace * trace / 4), 0.0, 1.0) : 0;
}

/// Returns why the foundation does not hold the plate; empty if it does. A foundation stops every motion, unless its
/// force vanishes beside the forces of bending between neighbouring nodes: with less than kLeast of them (the rounding
/// of doubles is 2e-16) answers were found to be off by a tenth and more.
std::optional<std::string> whyFoundationIsTooSoft(const Plate& plate, const NodeField& rigidity, const NodeField& shape)
{
    constexpr double kLeast = 1e-14; // [1]
    const double     most   = extremesOf(rigidity.values()).most;
    const double     area   = plate.grid.spacingX * plate.grid.spacingZ;
    const double     holds  = plate.foundation * shareOfRigidMotions(shape);
    if (holds * area * area >= kLeast * most) return std::nullopt;
    return sentence("only its foundation holds the plate, and ", holds, " Pa/m are lost beside a rigidity of ", most,
                    " N m on this grid: take fewer cells, a stiffer foundation, or clamp or support a side");
}

Edge edgeNamed(std::string_view word, const std::string& what)
{
    if (const auto edge = valueNamed<Edge>(word)) return *edge;
    std::vector<std::string_view> known;
    for (const auto& edge : namesOf(Edge{})) known.emplace_back(edge.name);
    const auto meant = nearestName(word, known);
    throw Error(what + ": expected " + wordsOf<Edge>() + ", found \"" + std::string(word) + "\"" +
                (meant ? "; did you mean \"" + std::string(*meant) + "\"?" : ""));
}

} // namespace

PlateEdges parseEdges(std::string_view text, const std::string& what)
{
    if (text.find('=') == std::string_view::npos) {
        const Edge all = edgeNamed(text, what);
        return {all, all, all, all};
    }
    constexpr std::array<std::string_view, 4> kSides{"x0", "x1", "z0", "z1"};
    std::array<std::string_view, 4>           said; // about each side
    std::array<Edge, 4>                       edges{};
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t      end  = std::min(text.find(',', begin), text.size());
        const std::string_view part = text.substr(begin, end - begin);
        const auto             side = std::size_t(std::ranges::find(kSides, part.substr(0, 2)) - kSides.begin());
        if (part.size() < 4 || part[2] != '=' || side == kSides.size())
            throw Error(what + ": expected SIDE=EDGE with side x0, x1, z0 or z1, found \"" + std::string(part) + "\"");
        if (!said[side].empty())
            throw Error(what + ": expected each side once, found \"" + std::string(said[side]) + "\" and \"" +
                        std::string(part) + "\"; omit one of the two");
        said[side]  = part;
        edges[side] = edgeNamed(part.substr(3), what);
        begin       = end + 1;
    }
    return {edges[0], edges[1], edges[2], edges[3]};
}

std::string edgesText(const PlateEdges& edges)
{
    if (edges == PlateEdges{edges.x0, edges.x0, edges.x0, edges.x0}) return name(edges.x0);
    return std::string("x0=") + name(edges.x0) + ",x1=" + name(edges.x1) + ",z0=" + name(edges.z0) +
           ",z1=" + name(edges.z1);
}

std::optional<std::string> whyUnsolvable(const Plate& plate)
{
    return whyUnsolvable(plate, plate.rigidity, plate.foundationShape);
}

std::optional<std::string> whyUnsolvable(const Plate& plate, const NodeField& rigidity,
                                         const NodeField& foundationShape)
{
    if (auto why = whyGridIsBad(plate.grid)) return why;
    if (!isPoissonRatio(plate.poissonRatio))
        return sentence("Poisson's ratio must be above -1 and at most 0.5, found ", plate.poissonRatio);
    if (!(std::isfinite(plate.foundation) && plate.foundation >= 0))
        return sentence("the foundation must be finite and not negative, found ", plate.foundation, " Pa/m");
    if (auto why = whyRigidityIsBad(plate.grid, rigidity)) return why;
    if (auto why = whyShapeIsBad(plate.grid, foundationShape)) return why;
    if (isHeldBySides(plate)) return std::nullopt;
    if (plate.foundation == 0)
        return "the plate is free to move as a rigid body: clamp one side, support two, or give it a foundation";
    return whyFoundationIsTooSoft(plate, rigidity, foundationShape);
}

} // namespace palp
