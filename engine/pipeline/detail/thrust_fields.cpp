#include "engine/pipeline/detail/thrust_fields.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "engine/pipeline/detail/node_pieces.h"
#include "engine/pipeline/detail/whole_object.h"

namespace palp {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Returns the square of the distance of each node from the nearest one of a piece [m^2]; infinite if it has none.
/// \source Felzenszwalb and Huttenlocher 2012
NodeField squaredDistances(const PlateGrid& grid, const std::vector<int>& pieceOf, int piece)
{
    const auto   at = [&](int i, int j) { return std::size_t(i) * std::size_t(grid.nodesZ()) + std::size_t(j); };
    NodeField    along(grid, kFar), squares(grid); // along z first
    const double hx2 = grid.spacingX * grid.spacingX;
    for (int i = 0; i <= grid.cellsX; ++i) {
        const auto sweep = [&](int first, int end, int step) {
            double away = kFar;
            for (int j = first; j != end; j += step) {
                away        = pieceOf[at(i, j)] == piece ? 0 : away + grid.spacingZ;
                along(i, j) = std::min(along(i, j), away);
            }
        };
        sweep(0, grid.nodesZ(), 1);
        sweep(grid.cellsZ, -1, -1);
    }
    // Then the least over x of (i - k)^2 hx^2 + along(k)^2: the lower envelope of parabolas, which the last ones of a
    // stack make up, each from a place on.
    std::vector<int>    stack(std::size_t(grid.nodesX()));
    std::vector<double> from(stack.size());
    const auto          square = [&](int k, int j) { return along(k, j) * along(k, j); };
    for (int j = 0; j <= grid.cellsZ; ++j) {
        int        count = 0;
        const auto meet  = [&](int a, int b) { // place at which b becomes lower than a, which comes before it [cells]
            return (a + b) / 2.0 + (square(b, j) - square(a, j)) / (2 * hx2 * (b - a));
        };
        for (int k = 0; k <= grid.cellsX; ++k) {
            if (along(k, j) == kFar) continue;
            while (count > 0 && meet(stack[std::size_t(count - 1)], k) <= from[std::size_t(count - 1)]) --count;
            from[std::size_t(count)]    = count > 0 ? meet(stack[std::size_t(count - 1)], k) : -kFar;
            stack[std::size_t(count++)] = k;
        }
        for (int i = 0, low = 0; i <= grid.cellsX; ++i) {
            while (low + 1 < count && from[std::size_t(low + 1)] < i) ++low;
            const int k   = count > 0 ? stack[std::size_t(low)] : 0;
            squares(i, j) = count > 0 ? (i - k) * (i - k) * hx2 + square(k, j) : kFar;
        }
    }
    return squares;
}

/// Returns the square of the distance from each piece [m^2].
std::vector<NodeField> distancesFrom(const PlateGrid& grid, const std::vector<int>& pieceOf, int pieces)
{
    std::vector<NodeField> squares;
    for (int p = 0; p < pieces; ++p) squares.push_back(squaredDistances(grid, pieceOf, p));
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

/// Puts the largest piece first, and the others in the order of their distance from the touch.
void sortByNearness(std::vector<Nodes>& pieces, const PlateGrid& grid)
{
    if (pieces.empty()) return;
    std::iter_swap(pieces.begin(), std::ranges::max_element(pieces, {}, &Nodes::size));
    const auto away = [&](const Nodes& piece) {
        double least = kFar;
        for (const std::size_t node : piece) {
            const double x = (int(node) / grid.nodesZ() - grid.cellsX / 2) * grid.spacingX;
            const double z = (int(node) % grid.nodesZ() - grid.cellsZ / 2) * grid.spacingZ;
            least          = std::min(least, x * x + z * z);
        }
        return least;
    };
    std::ranges::stable_sort(pieces.begin() + 1, pieces.end(), {}, away);
}

} // namespace

FreePieces freePieces(const Patch& patch, const HeldInPlane& held)
{
    constexpr std::size_t kFewest = 9;  // nodes: fewer are a gap between points
    constexpr std::size_t kMost   = 16; // pieces: each takes three solutions
    FreePieces            pieces{std::vector<int>(patch.plate.grid.nodes(), FreePieces::kNone)};
    if (patch.covered.values().empty()) return pieces;
    const auto isInPlane = [&](std::size_t n) { return !held.share.values().empty() && held.share.values()[n] >= 0.5; };
    std::vector<Nodes> found =
        connected(patch.plate.grid, [&](std::size_t n) { return !isOnSheet(patch, n) && !isInPlane(n); });
    std::erase_if(found, [](const Nodes& piece) { return piece.size() < kFewest; });
    sortByNearness(found, patch.plate.grid);
    pieces.count   = int(std::min(found.size(), kMost));
    pieces.leftOut = int(found.size()) - pieces.count;
    for (std::size_t p = 0; p < found.size(); ++p)
        for (const std::size_t node : found[p]) pieces.of[node] = p < kMost ? int(p) : 0;
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
