#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/enum_names.h"
#include "engine/core/grid.h"

namespace palp {

/// The support of one side of the plate.
enum class Edge {
    clamped,   ///< no deflection, no slope (the paper's only edge)
    supported, ///< no deflection, free to turn
    free,      ///< nothing holds it
    guided     ///< no slope, free to move: the line along which a symmetric plate was cut
};
constexpr auto namesOf(Edge)
{
    using enum Edge;
    return std::to_array<NamedValue<Edge>>({{clamped, "clamped"}, {supported, "supported"}, {free, "free"}, {guided, "guided"}});
}
/// Returns whether the nodes of such a side stay where they are.
[[nodiscard]] constexpr bool holdsNodes(Edge edge) noexcept
{
    return edge == Edge::clamped || edge == Edge::supported;
}
/// Returns whether such a side keeps the plate from turning about it; one that does not has no bending moment.
[[nodiscard]] constexpr bool holdsSlope(Edge edge) noexcept
{
    return edge == Edge::clamped || edge == Edge::guided;
}

struct PlateEdges {
    Edge x0 = Edge::clamped; ///< side x = 0
    Edge x1 = Edge::clamped; ///< side x = sizeX
    Edge z0 = Edge::clamped; ///< side z = 0
    Edge z1 = Edge::clamped; ///< side z = sizeZ

    bool operator==(const PlateEdges&) const = default;
};

/// Reads "free", or "x0=free,z1=supported" with the other sides clamped.
/// \throws Error naming `what`, the wrong part and the known words
[[nodiscard]] PlateEdges parseEdges(std::string_view text, const std::string& what);
/// Writes what parseEdges() reads: one name if all sides are alike.
[[nodiscard]] std::string edgesText(const PlateEdges& edges);

/// A Kirchhoff plate of varying flexural rigidity on an elastic foundation: everything but the load.
///
///     E(w) = 1/2 int D [ (w_xx + w_zz)^2 - 2 (1-nu)(w_xx w_zz - w_xz^2) ] + 1/2 int k s w^2 - int q w
///
/// Deflection w [m] is positive along the load.
/// \source  Kumari & Chaudhuri 2016, eqs 6 to 8: the equation that minimises E where D is smooth, k = 0 and nu constant
/// \differs (a) the energy itself is discretised: it is symmetric and positive for every D > 0, however rough; the
///          paper's expanded equation in central differences is off by 22 % at a wart of contrast 1000 on 64 cells.
///          (b) a foundation k, which the paper lacks: without it the size of the patch window decides what is felt.
///          (c) supported and free edges beside the paper's clamped ones, without which an ear lobe could not bend
struct Plate {
    PlateGrid  grid;
    PlateEdges edges;
    double     poissonRatio = 0.3; ///< nu [1], see isPoissonRatio
    double     foundation   = 0;   ///< k [Pa/m], >= 0; 0 in the paper
    NodeField  rigidity;           ///< D [N m] at the nodes, > 0
    NodeField  foundationShape{};  ///< s [1], the foundation at the nodes over k, >= 0; empty: 1 everywhere
};

/// The largest number of a foundation's shape: the solver computes with it in 32 bits [1].
inline constexpr double kMostFoundationShape = 1e9;

/// Returns the foundation at a node [Pa/m].
[[nodiscard]] inline double foundationAt(const Plate& plate, int i, int j) noexcept
{
    return plate.foundationShape.values().empty() ? plate.foundation : plate.foundation * plate.foundationShape(i, j);
}

/// Returns whether a side holds the node of column i, row j.
[[nodiscard]] inline bool isHeld(const Plate& plate, int i, int j) noexcept
{
    const PlateEdges& e = plate.edges;
    return (i == 0 && holdsNodes(e.x0)) || (i == plate.grid.cellsX && holdsNodes(e.x1)) ||
           (j == 0 && holdsNodes(e.z0)) || (j == plate.grid.cellsZ && holdsNodes(e.z1));
}

/// Fewest cells per side: with fewer, the conditions of two opposite edges meet in one second difference.
inline constexpr int kFewestPlateCells = 4;

/// Returns whether nu [1] can be a plate's Poisson's ratio: beyond these bounds the energy is not positive, or the
/// material grows under pressure.
[[nodiscard]] constexpr bool isPoissonRatio(double nu) noexcept
{
    return nu > -1 && nu <= 0.5; // false for NaN
}

/// Returns in one sentence why a plate cannot be solved; empty if it can. The shape may be wrong, the rigidity not
/// positive or Poisson's ratio out of range, or the edges leave the plate free to move as a rigid body on a foundation
/// that doubles cannot distinguish from none.
[[nodiscard]] std::optional<std::string> whyUnsolvable(const Plate& plate);
/// Returns the same for the plate with this rigidity [N m] and shape of the foundation [1] in place of its own.
[[nodiscard]] std::optional<std::string> whyUnsolvable(const Plate& plate, const NodeField& rigidity,
                                                       const NodeField& foundationShape);

/// A solver's report about one answer. A number that a solver does not have is empty.
struct SolveReport {
    std::string           solver; ///< "reference", or the processor: "host" or the name of a GPU
    std::optional<int>    iterations;
    std::optional<double> errorEstimate;    ///< [1] relative, in the norm that the solver documents
    std::optional<double> workUnits;        ///< applications of the operator on the finest grid
    bool                  converged = true; ///< false: the estimate exceeds the tolerance, or may be too low
    double setUpMilliseconds = 0; ///< wall time from the rigidity to a ready solver: a factorisation, coarser grids
    double milliseconds      = 0; ///< wall time of this solve
    std::optional<double> processorMilliseconds; ///< part of it in which the processor was busy; empty without a clock
};

struct PlateSolution {
    NodeField   deflection; ///< w [m]
    SolveReport report;
};

} // namespace palp
