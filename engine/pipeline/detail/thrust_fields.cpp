#include "engine/pipeline/detail/thrust_fields.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "engine/pipeline/detail/node_distances.h"
#include "engine/pipeline/detail/node_pieces.h"
#include "engine/pipeline/detail/whole_object.h"

namespace palp {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Returns the square of the distance from each piece [m^2].
std::vector<NodeField> distancesFrom(const PlateGrid& grid, const std::vector<int>& pieceOf, int pieces)
{
    std::vector<NodeField> squares;
    for (int p = 0; p < pieces; ++p)
        squares.push_back(squaredDistances(grid, [&](std::size_t n) { return pieceOf[n] == p; }));
    return squares;
}

/// Returns the pieces whose bed holds the nodes, or kNone.
std::vector<int> piecesOfBed(const Patch& patch, const FreePieces& pieces)
{
    const std::vector<NodeField> squares = distancesFrom(patch.plate.grid, pieces.of, pieces.count);
    std::vector<int>             of(pieces.of.size(), FreePieces::kNone);
    for (std::size_t n = 0; n < of.size(); ++n)
        if (patch.stressBed.values()[n] > 0)
            of[n] = int(std::ranges::min_element(squares, {}, [&](const NodeField& s) { return s.values()[n]; }) -
                        squares.begin());
    return of;
}

/// Returns the share of a piece in a node [1].
double shareOf(const std::vector<NodeField>& squares, std::size_t piece, std::size_t node)
{
    const double own = squares[piece].values()[node];
    if (own == 0) return 1;
    double sum = 0;
    for (const NodeField& of : squares) sum += own / of.values()[node]; // infinite at another piece
    return 1 / sum;
}

} // namespace

namespace {

/// Puts pieces in the order of their distance from the touch.
void sortByNearness(std::vector<Nodes>& pieces, const PlateGrid& grid)
{
    const auto away = [&](const Nodes& piece) {
        double least = kFar;
        for (const std::size_t node : piece) {
            const double x = (int(node) / grid.nodesZ() - grid.cellsX / 2) * grid.spacingX;
            const double z = (int(node) % grid.nodesZ() - grid.cellsZ / 2) * grid.spacingZ;
            least          = std::min(least, x * x + z * z);
        }
        return least;
    };
    std::ranges::stable_sort(pieces, {}, away);
}

/// Returns pieces without the largest one around each part of the sheet, where Airy's function is 0: forces pass
/// between the others and that.
/// \param parts  of the sheet, with the pieces around them
std::vector<Nodes> besidesLargest(const std::vector<Nodes>& pieces, const std::vector<Nodes>& parts,
                                  const PlateGrid& grid)
{
    std::vector<std::size_t> partOf(grid.nodes());
    for (std::size_t p = 0; p < parts.size(); ++p)
        for (const std::size_t node : parts[p]) partOf[node] = p;
    std::vector<const Nodes*> largest(parts.size());
    for (const Nodes& piece : pieces) {
        const Nodes*& most = largest[partOf[piece.front()]];
        if (!most || most->size() < piece.size()) most = &piece;
    }
    std::vector<Nodes> others;
    for (const Nodes& piece : pieces)
        if (largest[partOf[piece.front()]] != &piece) others.push_back(piece);
    return others;
}

} // namespace

FreePieces freePieces(const Patch& patch, const HeldInPlane& held)
{
    constexpr std::size_t kFewest = 9;  // nodes: fewer are a gap between points
    constexpr std::size_t kMost   = 16; // pieces: each takes three solutions
    constexpr double      kBand   = 4;  // cells along the border: farther out the ground behind what is held may end
    FreePieces            pieces{std::vector<int>(patch.plate.grid.nodes(), FreePieces::kNone)};
    if (patch.covered.values().empty()) return pieces;
    const auto isInPlane = [&](std::size_t n) { return !held.share.values().empty() && held.share.values()[n] >= 0.5; };
    const PlateGrid& grid   = patch.plate.grid;
    const double     wide   = kBand * std::max(grid.spacingX, grid.spacingZ);
    const NodeField  away   = squaredDistances(grid, [&](std::size_t n) { return isOnSheet(patch, n); });
    const auto       isFree = [&](std::size_t n) {
        return !isOnSheet(patch, n) && !isInPlane(n) && away.values()[n] <= wide * wide;
    };
    std::vector<Nodes> found = connected(grid, isFree);
    std::erase_if(found, [](const Nodes& piece) { return piece.size() < kFewest; });
    const auto         parts  = connected(grid, [&](std::size_t n) { return isOnSheet(patch, n) || isFree(n); });
    std::vector<Nodes> others = besidesLargest(found, parts, grid);
    sortByNearness(others, grid);
    pieces.count   = found.empty() ? 0 : int(std::min(others.size() + 1, kMost));
    pieces.leftOut = found.empty() ? 0 : int(others.size() + 1) - pieces.count;
    for (const Nodes& piece : found)
        for (const std::size_t node : piece) pieces.of[node] = 0;
    for (std::size_t p = 0; int(p + 1) < pieces.count; ++p)
        for (const std::size_t node : others[p]) pieces.of[node] = int(p + 1);
    pieces.leftOut += held.without;
    return pieces;
}

std::vector<NodeField> thrustFields(const Patch& patch, const FreePieces& pieces)
{
    if (pieces.count < 2) return {};
    const PlateGrid&             grid    = patch.plate.grid;
    const std::vector<NodeField> squares = distancesFrom(grid, piecesOfBed(patch, pieces), pieces.count);
    std::vector<NodeField>       fields;
    for (std::size_t p = 1; p < squares.size(); ++p) {
        NodeField one(grid), x(grid), z(grid);
        for (int i = 0; i <= grid.cellsX; ++i)
            for (int j = 0; j <= grid.cellsZ; ++j) {
                one(i, j) = shareOf(squares, p, std::size_t(i) * std::size_t(grid.nodesZ()) + std::size_t(j));
                x(i, j)   = one(i, j) * (4.0 * i / grid.cellsX - 2);
                z(i, j)   = one(i, j) * (4.0 * j / grid.cellsZ - 2);
            }
        for (NodeField* field : {&one, &x, &z}) fields.push_back(std::move(*field));
    }
    return fields;
}

} // namespace palp
