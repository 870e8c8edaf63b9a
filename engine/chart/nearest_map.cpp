#include "engine/chart/nearest_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>

#include "engine/core/contract.h"

// Two steps. First every point offers itself to the few nodes around it, whole rows of nodes at a time with vector
// instructions; where points are about as dense as nodes, this settles nearly all nodes without any search structure.
// Nodes whose best offer might be beaten from outside that neighbourhood, beside holes and beyond the edge of the
// cloud, then search in buckets of points, outward from the node.

namespace palp {
namespace {

constexpr int kLanes     = 4; ///< nodes that one vector of doubles serves; the columns to which a point offers itself
constexpr int kLeastRows = 2;
constexpr int kMostRows  = 4;

using Numbers  = double __attribute__((vector_size(kLanes * sizeof(double))));
using Integers = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));

/// The best offers so far, with a margin of nodes that nobody reads, so that points near the edge need no special care.
struct Offers {
    static constexpr int kMargin = 4; ///< [nodes] on each side
    static_assert(kMargin >= kLanes && kMargin >= kMostRows);

    PlateGrid                 grid;
    std::size_t               stride;    ///< [nodes] from row to row
    std::vector<double>       x;         ///< [m] of every row of nodes
    std::vector<double>       z;         ///< [m] of every column
    std::vector<double>       distance2; ///< [m^2]
    std::vector<std::int64_t> point;     ///< as wide as a distance, so that one mask serves both

    Offers(const PlateGrid& g, const ChartPoint& origin)
        : grid(g), stride(std::size_t(g.nodesZ() + 2 * kMargin)), x(std::size_t(g.nodesX() + 2 * kMargin)), z(stride),
          distance2(x.size() * stride, std::numeric_limits<double>::infinity()), point(x.size() * stride, -1)
    {
        for (std::size_t i = 0; i < x.size(); ++i) x[i] = origin.x + (double(i) - kMargin) * grid.spacingX;
        for (std::size_t j = 0; j < z.size(); ++j) z[j] = origin.z + (double(j) - kMargin) * grid.spacingZ;
    }

    [[nodiscard]] std::size_t at(int i, int j) const noexcept
    {
        return std::size_t(i + kMargin) * stride + std::size_t(j + kMargin);
    }
};

/// First of `count` nodes around a position, counted from the margin's first; in the margin if the position is far out.
/// \param u  position in grid steps from node 0
[[gnu::always_inline]] inline std::size_t firstAround(double u, int count, int nodes)
{
    const double first = u - 0.5 * count + (1 + Offers::kMargin);
    return std::size_t(std::min(std::max(first, 0.0), double(nodes + 2 * Offers::kMargin - count)));
}

/// Every point offers itself to the kRows x kLanes nodes around it, in the order of their numbers: so the lowest number
/// wins among equals.
/// \return whether all points are finite
template <int kRows>
[[gnu::always_inline]] inline bool offerAll(std::span<const ChartPoint> points, Offers& offers)
{
    const double perX   = 1 / offers.grid.spacingX;
    const double perZ   = 1 / offers.grid.spacingZ;
    const double x0     = offers.x[Offers::kMargin];
    const double z0     = offers.z[Offers::kMargin];
    const int    nodesX = offers.grid.nodesX();
    const int    nodesZ = offers.grid.nodesZ();
    for (std::size_t p = 0; p < points.size(); ++p) {
        const auto [px, pz]    = points[p];
        const std::size_t row  = firstAround((px - x0) * perX, kRows, nodesX);
        const std::size_t col  = firstAround((pz - z0) * perZ, kLanes, nodesZ);
        const Integers    mine = Integers{} + std::int64_t(p);
        Numbers           z;
        std::memcpy(&z, &offers.z[col], sizeof z);
        const Numbers dz2 = (z - pz) * (z - pz);
        for (std::size_t r = 0; r < kRows; ++r) {
            const std::size_t at    = (row + r) * offers.stride + col;
            const double      dx    = offers.x[row + r] - px;
            const Numbers     offer = dx * dx + dz2;
            Numbers           best;
            Integers          point;
            std::memcpy(&best, &offers.distance2[at], sizeof best);
            std::memcpy(&point, &offers.point[at], sizeof point);
            const Integers better = offer < best;
            best                  = better ? offer : best;
            point                 = better ? mine : point;
            std::memcpy(&offers.distance2[at], &best, sizeof best);
            std::memcpy(&offers.point[at], &point, sizeof point);
        }
    }
}

[[gnu::always_inline]] inline void offerAll(std::span<const ChartPoint> points, int rows, Offers& offers)
{
    if (rows == 2)
        offerAll<2>(points, offers);
    else if (rows == 3)
        offerAll<3>(points, offers);
    else
        offerAll<4>(points, offers);
}

void offerPortable(std::span<const ChartPoint> points, int rows, Offers& offers)
{
    offerAll(points, rows, offers);
}

#if defined(__x86_64__)
// Without FMA, which would round distances differently from processor to processor.
__attribute__((target("avx2"))) void offerAvx2(std::span<const ChartPoint> points, int rows, Offers& offers)
{
    offerAll(points, rows, offers);
}
#endif

void offer(std::span<const ChartPoint> points, int rows, Offers& offers)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return offerAvx2(points, rows, offers);
#endif
    offerPortable(points, rows, offers);
}

/// Equal intervals along an axis; the outermost two also take what lies beyond.
struct Bands {
    double low    = 0; ///< [m]
    double width  = 1; ///< [m]
    double margin = 0; ///< [m] by which rounding may put a point into the wrong band
    int    count  = 1;

    [[nodiscard]] int of(double x) const noexcept
    {
        return int(std::min(std::max((x - low) / width, 0.0), double(count - 1)));
    }
    /// Square [m^2] of a lower bound for the distance from x, in band `home`, to every point in a band.
    [[nodiscard]] double gap2(double x, int home, int band) const noexcept
    {
        if (band == home) return 0;
        const double gap = (band > home ? low + band * width - x : x - (low + (band + 1) * width)) - margin;
        return gap > 0 ? gap * gap : 0;
    }
};

/// Points in buckets, as linked lists: cheaper to make than sorted buckets, and few nodes ask.
class Buckets {
public:
    Buckets(std::span<const ChartPoint> points, const Bands& x, const Bands& z)
        : points_(points), x_(x), z_(z), first_(std::size_t(x.count) * std::size_t(z.count), kNone),
          next_(points.size())
    {
        for (std::size_t p = 0; p < points.size(); ++p) {
            std::uint32_t& first = first_[bucket(x_.of(points[p].x), z_.of(points[p].z))];
            next_[p]             = first;
            first                = std::uint32_t(p);
        }
    }

    /// The nearest point, given one that may be it.
    [[nodiscard]] std::uint32_t nearest(const ChartPoint& node, std::uint32_t guess) const
    {
        Search    search{node, guess, squaredDistance(node, guess), x_.of(node.x), z_.of(node.z)};
        const int row = search.row;
        for (int r = row; r < x_.count && scanRow(search, r); ++r) {
        }
        for (int r = row - 1; r >= 0 && scanRow(search, r); --r) {
        }
        return search.best;
    }

    [[nodiscard]] double squaredDistance(const ChartPoint& node, std::uint32_t point) const noexcept
    {
        const double dx = node.x - points_[point].x;
        const double dz = node.z - points_[point].z;
        return dx * dx + dz * dz;
    }

private:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    struct Search {
        ChartPoint    node;
        std::uint32_t best;
        double        distance2; ///< [m^2] of the best
        int           row;       ///< bucket of the node
        int           column;
    };

    [[nodiscard]] std::size_t bucket(int row, int column) const noexcept
    {
        return std::size_t(row) * std::size_t(z_.count) + std::size_t(column);
    }

    /// \return whether rows further out may hold a nearer point
    bool scanRow(Search& s, int row) const
    {
        const double gap2 = x_.gap2(s.node.x, s.row, row);
        if (gap2 > s.distance2) return false;
        for (int c = s.column; c < z_.count && gap2 + z_.gap2(s.node.z, s.column, c) <= s.distance2; ++c)
            scanBucket(s, bucket(row, c));
        for (int c = s.column - 1; c >= 0 && gap2 + z_.gap2(s.node.z, s.column, c) <= s.distance2; --c)
            scanBucket(s, bucket(row, c));
        return true;
    }

    void scanBucket(Search& s, std::size_t bucket) const
    {
        for (std::uint32_t p = first_[bucket]; p != kNone; p = next_[p]) {
            const double distance2 = squaredDistance(s.node, p);
            if (distance2 < s.distance2 || (distance2 == s.distance2 && p < s.best)) {
                s.distance2 = distance2;
                s.best      = p;
            }
        }
    }

    std::span<const ChartPoint> points_;
    Bands                       x_, z_;
    std::vector<std::uint32_t>  first_; ///< by bucket
    std::vector<std::uint32_t>  next_;  ///< by point
};

/// An axis of the grid: where its nodes and the points lie.
struct Axis {
    double first   = 0; ///< [m] first node
    double last    = 0; ///< [m] last node
    double spacing = 1; ///< [m]
    double low     = 0; ///< [m] lowest point, but at most half the grid's size beyond it
    double high    = 0; ///< [m]
    double margin  = 0; ///< [m] by which a position in steps or bands may be rounded

    Axis(double origin, double step, int cells, std::span<const ChartPoint> points, double ChartPoint::*coordinate)
        : first(origin), last(origin + cells * step), spacing(step)
    {
        double least = first, most = last;
        for (const ChartPoint& p : points) {
            least = std::min(least, p.*coordinate);
            most  = std::max(most, p.*coordinate);
        }
        const double beyond = 0.5 * (last - first) + spacing;
        low                 = std::max(least, first - beyond);
        high                = std::min(most, last + beyond);
        // Some 2^-53 of the largest numbers that take part; 32 times as much costs nothing.
        margin = 0x1p-48 * (std::abs(first) + std::abs(last) + spacing + (high - low));
    }

    /// About `width` [m] wide, but no more than `most` bands.
    [[nodiscard]] Bands bands(double width, std::size_t most) const
    {
        Bands bands;
        bands.low    = low;
        bands.margin = margin;
        if (high - low > width) {
            bands.count = int(std::min((high - low) / width, double(most)));
            bands.width = (high - low) / bands.count;
        }
        return bands;
    }
};

/// Points per cell of the grid.
[[nodiscard]] double densityOf(std::span<const ChartPoint> points, const Axis& x, const Axis& z)
{
    const auto   inside = std::count_if(points.begin(), points.end(), [&](const ChartPoint& p) {
        return p.x >= x.first && p.x <= x.last && p.z >= z.first && p.z <= z.last;
    });
    const double cells  = std::max(1.0, (x.last - x.first) / x.spacing) * std::max(1.0, (z.last - z.first) / z.spacing);
    return double(inside) / cells;
}

/// Rows of nodes to which points offer themselves, so that hardly any node of a random cloud is left without the
/// nearest point: one in exp(-pi r^2 density) at r = rows / 2 steps; at exp(-5) the search of the rest costs as much as
/// one more row.
[[nodiscard]] int rowsFor(double density)
{
    const double rows = 2 * std::sqrt(5 / (std::numbers::pi * std::max(density, 1e-9)));
    return int(std::clamp(std::ceil(rows), double(kLeastRows), double(kMostRows)));
}

/// Searches for the nodes whose best offer is further away than `reach` [m]; every node's answer is the next one's
/// first guess.
void searchBeyond(double reach, const Buckets& buckets, const Offers& offers, std::vector<std::uint32_t>& nearest)
{
    const auto  columns = std::size_t(offers.grid.nodesZ());
    std::size_t node    = 0;
    for (int i = 0; i < offers.grid.nodesX(); ++i) {
        for (int j = 0; j < offers.grid.nodesZ(); ++j, ++node) {
            const std::size_t at = offers.at(i, j);
            if (reach > 0 && offers.distance2[at] <= reach * reach) continue;
            const ChartPoint place{offers.x[std::size_t(i + Offers::kMargin)],
                                   offers.z[std::size_t(j + Offers::kMargin)]};
            std::uint32_t    guess    = offers.point[at] >= 0 ? nearest[node] : 0;
            const auto       consider = [&](std::uint32_t point) {
                if (buckets.squaredDistance(place, point) < buckets.squaredDistance(place, guess)) guess = point;
            };
            if (j > 0) consider(nearest[node - 1]);
            if (i > 0) consider(nearest[node - columns]);
            nearest[node] = buckets.nearest(place, guess);
        }
    }
}

} // namespace

std::vector<std::uint32_t> nearestPoint(const PlateGrid& grid, const ChartPoint& origin,
                                        std::span<const ChartPoint> points)
{
    PALP_EXPECT(grid.cellsX >= 0 && grid.cellsZ >= 0 && grid.spacingX > 0 && grid.spacingZ > 0,
                std::to_string(grid.cellsX) + " x " + std::to_string(grid.cellsZ) + " cells of " +
                    std::to_string(grid.spacingX) + " m x " + std::to_string(grid.spacingZ) + " m");
    PALP_EXPECT(!points.empty() && points.size() < std::numeric_limits<std::uint32_t>::max(),
                std::to_string(points.size()) + " points");
    PALP_EXPECT(std::all_of(points.begin(), points.end(),
                            [](const ChartPoint& p) { return std::isfinite(p.x) && std::isfinite(p.z); }),
                "a point is not finite");

    const Axis   x(origin.x, grid.spacingX, grid.cellsX, points, &ChartPoint::x);
    const Axis   z(origin.z, grid.spacingZ, grid.cellsZ, points, &ChartPoint::z);
    const double density = densityOf(points, x, z);
    const int    rows    = rowsFor(density);
    const double reach   = std::min(0.5 * rows * x.spacing - x.margin, 0.5 * kLanes * z.spacing - z.margin);
    Offers       offers(grid, origin);
    offer(points, rows, offers);

    std::vector<std::uint32_t> nearest;
    nearest.reserve(grid.nodes());
    bool settled = true;
    for (int i = 0; i < grid.nodesX(); ++i) {
        const std::int64_t* point     = &offers.point[offers.at(i, 0)];
        const double*       distance2 = &offers.distance2[offers.at(i, 0)];
        for (int j = 0; j < grid.nodesZ(); ++j) {
            nearest.push_back(std::uint32_t(point[j]));
            settled &= reach > 0 && distance2[j] <= reach * reach;
        }
    }
    if (settled) return nearest;

    constexpr double kPointsPerBucket = 2; // measured: 1 to 4 make little difference
    const double     width = std::sqrt(kPointsPerBucket * (x.high - x.low) * (z.high - z.low) / double(points.size()));
    searchBeyond(reach, Buckets(points, x.bands(width, points.size()), z.bands(width, points.size())), offers, nearest);
    return nearest;
}

} // namespace palp
