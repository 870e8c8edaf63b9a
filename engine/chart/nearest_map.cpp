#include "engine/chart/nearest_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>

#include "engine/core/contract.h"

// There are two steps. First every point offers itself to the few nodes around it, whole rows of nodes at a time with
// vector instructions; where points are about as dense as nodes, this settles nearly all nodes without any search
// structure. Nodes whose best offer might be beaten from outside that neighbourhood, beside holes and beyond the edge
// of the cloud, then search in buckets of points, outward from the node; far from all points in squares of buckets, of
// squares, and so on, of which the empty ones are passed at once.

namespace palp {
namespace {

constexpr int kLanes     = 4; ///< nodes that one vector of doubles serves; the columns to which a point offers itself
constexpr int kLeastRows = 2;
constexpr int kMostRows  = 4;

constexpr std::uint32_t kNoPoint = std::numeric_limits<std::uint32_t>::max();

using Numbers = double __attribute__((vector_size(kLanes * sizeof(double))));

/// The best offers so far, with a margin of nodes never read, so that points near the edge need no special care.
struct Offers {
    static constexpr int kMargin = 4; ///< [nodes] on each side
    static_assert(kMargin >= kLanes && kMargin >= kMostRows);

    PlateGrid           grid;
    std::vector<double> x;    ///< [m] of every row of nodes
    std::vector<double> z;    ///< [m] of every column
    std::vector<double> best; ///< for each row the squared distances [m^2], then the points' numbers, exact in doubles;
                              ///< one array, because the C library gives two big ones back to the system each time

    Offers(const PlateGrid& g, const ChartPoint& origin)
        : grid(g), x(std::size_t(g.nodesX() + 2 * kMargin)), z(std::size_t(g.nodesZ() + 2 * kMargin)),
          best(2 * x.size() * z.size())
    {
        for (std::size_t i = 0; i < x.size(); ++i) x[i] = origin.x + (double(i) - kMargin) * grid.spacingX;
        for (std::size_t j = 0; j < z.size(); ++j) z[j] = origin.z + (double(j) - kMargin) * grid.spacingZ;
        for (std::size_t i = 0; i < x.size(); ++i)
            std::fill_n(best.begin() + std::ptrdiff_t(2 * i * z.size()), z.size(),
                        std::numeric_limits<double>::infinity());
    }

    [[nodiscard]] const double* distances2(int i) const noexcept // of the nodes of row i, [m^2]
    {
        return &best[2 * std::size_t(i + kMargin) * z.size() + kMargin];
    }
    [[nodiscard]] const double* points(int i) const noexcept { return distances2(i) + z.size(); }
};

/// Offers every point to the kRows x kLanes nodes around it, in the order of their numbers: the lowest number wins
/// among equals.
/// \return  true if all points are finite
template <int kRows>
[[gnu::always_inline]] inline bool offerAll(std::span<const ChartPoint> points, Offers& offers)
{
    // The first of kRows nodes around a position of u steps is floor(u - kRows / 2) + 1; kMargin more in the arrays.
    constexpr double kFirstRow = Offers::kMargin + 1 - 0.5 * kRows;
    constexpr double kFirstCol = Offers::kMargin + 1 - 0.5 * kLanes;
    const double     perX      = 1 / offers.grid.spacingX;
    const double     perZ      = 1 / offers.grid.spacingZ;
    const auto       rows      = double(offers.x.size() - kRows);
    const auto       cols      = double(offers.z.size() - kLanes);
    const auto*      x         = offers.x.data();
    const auto*      z         = offers.z.data();
    const double     x0        = x[Offers::kMargin];
    const double     z0        = z[Offers::kMargin];
    const auto       stride    = std::int64_t(offers.z.size());
    double* const    best      = offers.best.data();
    bool             finite    = true;
    for (std::size_t p = 0; p < points.size(); ++p) {
        const auto [px, pz] = points[p];
        const double u      = (px - x0) * perX + kFirstRow;
        const double v      = (pz - z0) * perZ + kFirstCol;
        if (!(u >= 0 && u <= rows && v >= 0 && v <= cols)) { // near no node
            finite &= std::isfinite(px) && std::isfinite(pz);
            continue;
        }
        const auto row = std::int64_t(u);
        const auto col = std::int64_t(v);
        Numbers    along;
        std::memcpy(&along, z + col, sizeof along);
        const Numbers dz2  = (along - pz) * (along - pz);
        const Numbers mine = Numbers{} + double(p);
        for (int r = 0; r < kRows; ++r) {
            double* const distances = best + 2 * (row + r) * stride + col;
            double* const numbers   = distances + stride;
            const double  dx        = x[row + r] - px;
            const Numbers distance2 = dx * dx + dz2;
            Numbers       least;
            Numbers       number;
            std::memcpy(&least, distances, sizeof least);
            std::memcpy(&number, numbers, sizeof number);
            const auto better = distance2 < least;
            least             = better ? distance2 : least;
            number            = better ? mine : number;
            std::memcpy(distances, &least, sizeof least);
            std::memcpy(numbers, &number, sizeof number);
        }
    }
    return finite;
}

[[gnu::always_inline]] inline bool offerAll(std::span<const ChartPoint> points, int rows, Offers& offers)
{
    return rows == 2   ? offerAll<2>(points, offers)
           : rows == 3 ? offerAll<3>(points, offers)
                       : offerAll<4>(points, offers);
}

bool offerPortable(std::span<const ChartPoint> points, int rows, Offers& offers)
{
    return offerAll(points, rows, offers);
}

#if defined(__x86_64__)
// Without FMA, which would round distances differently from processor to processor.
__attribute__((target("avx2"))) bool offerAvx2(std::span<const ChartPoint> points, int rows, Offers& offers)
{
    return offerAll(points, rows, offers);
}
#endif

/// Offers every point by the best instructions that the processor has.
/// \return  true if all points are finite
bool offer(std::span<const ChartPoint> points, int rows, Offers& offers)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return offerAvx2(points, rows, offers);
#endif
    return offerPortable(points, rows, offers);
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
    /// Returns the square [m^2] of a lower bound for the distance from x, in band `home`, to every point in some bands.
    [[nodiscard]] double gap2(double x, int home, int first, int last) const noexcept
    {
        return gap2(x, home, std::clamp(home, first, last));
    }
    /// Returns the same of one band.
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
        : points_(points), x_(x), z_(z), first_(std::size_t(x.count) * std::size_t(z.count), kNoPoint),
          next_(points.size())
    {
        for (std::size_t p = 0; p < points.size(); ++p) {
            std::uint32_t& first = first_[bucket(x_.of(points[p].x), z_.of(points[p].z))];
            next_[p]             = first;
            first                = std::uint32_t(p);
        }
        levels_.push_back({x.count, z.count, std::vector<std::uint8_t>(first_.size())});
        std::ranges::transform(first_, levels_[0].full.begin(), [](std::uint32_t first) { return first != kNoPoint; });
        while (levels_.back().rows > 1 || levels_.back().columns > 1) levels_.push_back(aboveOf(levels_.back()));
    }

    /// Returns the nearest point within the square root of `farthest2` [m^2], given one that may be it or kNoPoint.
    [[nodiscard]] std::uint32_t nearest(const ChartPoint& node, std::uint32_t guess, double farthest2) const
    {
        constexpr double kFar = 4; // buckets; nearer ones are looked through sooner than squares are
        Search           search{node, guess, squaredDistance(node, guess), x_.of(node.x), z_.of(node.z)};
        if (!(search.distance2 <= farthest2)) {
            search.best      = kNoPoint;
            search.distance2 = farthest2;
        }
        if (search.distance2 > kFar * kFar * x_.width * z_.width) {
            searchSquare(search, levels_.size() - 1, 0, 0);
            return search.best;
        }
        const int row = search.row;
        for (int r = row; r < x_.count && scanRow(search, r); ++r) {
        }
        for (int r = row - 1; r >= 0 && scanRow(search, r); --r) {
        }
        return search.best;
    }

    [[nodiscard]] double squaredDistance(const ChartPoint& node, std::uint32_t point) const noexcept
    {
        if (point == kNoPoint) return std::numeric_limits<double>::infinity();
        const double dx = node.x - points_[point].x;
        const double dz = node.z - points_[point].z;
        return dx * dx + dz * dz;
    }

private:
    struct Search {
        ChartPoint    node;
        std::uint32_t best;
        double        distance2; ///< [m^2] of the best
        int           row;       ///< bucket of the node
        int           column;
    };

    /// Squares of 2^k x 2^k buckets, in rows.
    struct Level {
        int                       rows = 0, columns = 0;
        std::vector<std::uint8_t> full; ///< 1: it has a point

        [[nodiscard]] std::size_t at(int row, int column) const noexcept
        {
            return std::size_t(row) * std::size_t(columns) + std::size_t(column);
        }
    };

    /// Returns the squares of two by two of these.
    static Level aboveOf(const Level& below)
    {
        Level above{(below.rows + 1) / 2, (below.columns + 1) / 2, {}};
        above.full.resize(std::size_t(above.rows) * std::size_t(above.columns));
        for (int r = 0; r < below.rows; ++r)
            for (int c = 0; c < below.columns; ++c) above.full[above.at(r / 2, c / 2)] |= below.full[below.at(r, c)];
        return above;
    }

    /// Searches one square of a level, its nearer parts first.
    void searchSquare(Search& s, std::size_t level, int row, int column) const
    {
        const Level& squares = levels_[level];
        if (!squares.full[squares.at(row, column)]) return;
        const auto   lastOf = [level](int n, int count) { return std::min(((n + 1) << level) - 1, count - 1); };
        const double gap2   = x_.gap2(s.node.x, s.row, row << level, lastOf(row, x_.count)) +
                            z_.gap2(s.node.z, s.column, column << level, lastOf(column, z_.count));
        if (gap2 > s.distance2) return;
        if (level == 0) return scanBucket(s, bucket(row, column));
        const Level& parts = levels_[level - 1];
        const int    r = 2 * row, c = 2 * column, half = 1 << (level - 1);
        const int    nearR = s.row >= (r + 1) * half, nearC = s.column >= (c + 1) * half;
        for (const int dr : {nearR, 1 - nearR})
            for (const int dc : {nearC, 1 - nearC})
                if (r + dr < parts.rows && c + dc < parts.columns) searchSquare(s, level - 1, r + dr, c + dc);
    }

    [[nodiscard]] std::size_t bucket(int row, int column) const noexcept
    {
        return std::size_t(row) * std::size_t(z_.count) + std::size_t(column);
    }

    /// Searches one row of buckets.
    /// \return  true if rows further out may hold a nearer point
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
        for (std::uint32_t p = first_[bucket]; p != kNoPoint; p = next_[p]) {
            const double distance2 = squaredDistance(s.node, p);
            if (distance2 < s.distance2 || (distance2 == s.distance2 && p < s.best)) {
                s.distance2 = distance2;
                s.best      = p;
            }
        }
    }

    std::span<const ChartPoint> points_;
    Bands                       x_, z_;
    std::vector<std::uint32_t>  first_;  ///< by bucket
    std::vector<std::uint32_t>  next_;   ///< by point
    std::vector<Level>          levels_; ///< buckets, then ever larger squares, up to one
};

/// An axis of the grid: the extent of its nodes and of the points.
struct Axis {
    double first   = 0; ///< [m] first node
    double last    = 0; ///< [m] last node
    double spacing = 1; ///< [m]
    double low     = 0; ///< [m] about the lowest of nodes and points, but at most half the grid's size beyond it
    double high    = 0; ///< [m]

    Axis(double origin, double step, int cells)
        : first(origin), last(origin + cells * step), spacing(step), low(first), high(last)
    {
    }

    void include(double x)
    {
        const double beyond = 0.5 * (last - first) + spacing;
        low                 = std::min(low, std::max(x, first - beyond));
        high                = std::max(high, std::min(x, last + beyond));
    }
    [[nodiscard]] bool   holds(double x) const noexcept { return x >= first && x <= last; }
    [[nodiscard]] double cells() const noexcept { return std::max(1.0, (last - first) / spacing); }

    /// Returns by how much rounding may move a position in steps or bands [m]: some 2^-53 of the largest numbers that
    /// take part; 32 times as much costs nothing.
    [[nodiscard]] double margin() const noexcept
    {
        return 0x1p-48 * (std::abs(first) + std::abs(last) + spacing + (high - low));
    }

    /// Returns bands about `width` [m] wide, but at most `most` of them.
    [[nodiscard]] Bands bands(double width, std::size_t most) const
    {
        Bands bands;
        bands.low    = low;
        bands.margin = margin();
        if (high - low > width) {
            bands.count = int(std::min((high - low) / width, double(most)));
            bands.width = (high - low) / bands.count;
        }
        return bands;
    }
};

/// Returns the points per cell of the grid, from some of the points, and sets the axes' extents. Only speed depends
/// on it.
[[nodiscard]] double survey(std::span<const ChartPoint> points, Axis& x, Axis& z)
{
    constexpr std::size_t kSurveyed = 1000;
    const std::size_t     stride    = (points.size() + kSurveyed - 1) / kSurveyed;
    std::size_t           inside    = 0;
    for (std::size_t p = 0; p < points.size(); p += stride) {
        x.include(points[p].x);
        z.include(points[p].z);
        inside += x.holds(points[p].x) && z.holds(points[p].z);
    }
    return double(inside * stride) / (x.cells() * z.cells());
}

/// Returns the number of rows of nodes to which points offer themselves. In a random cloud one node in
/// exp(pi r^2 density) has its nearest point further away than r = rows / 2 steps. One in exp(11) = 60000 means that
/// most grids need no buckets, which cost more than one row.
[[nodiscard]] int rowsFor(double density)
{
    const double rows = 2 * std::sqrt(11 / (std::numbers::pi * std::max(density, 1e-9)));
    return int(std::clamp(std::ceil(rows), double(kLeastRows), double(kMostRows)));
}

/// Searches for the nodes whose best offer is not within the square root of `settled2` [m^2]; every node's answer is
/// the next one's first guess. Farther than the square root of `exact2` from all points, only some nodes are searched
/// for.
void searchBeyond(double settled2, double exact2, const Buckets& buckets, const Offers& offers,
                  std::vector<std::uint32_t>& nearest)
{
    constexpr int kSome   = 4; // one in four along each axis: what is narrower may be lost
    const auto    columns = std::size_t(offers.grid.nodesZ());
    std::size_t   node    = 0;
    for (int i = 0; i < offers.grid.nodesX(); ++i) {
        const double* distances2 = offers.distances2(i);
        for (int j = 0; j < offers.grid.nodesZ(); ++j, ++node) {
            if (distances2[j] <= settled2) continue;
            const ChartPoint place{offers.x[std::size_t(i + Offers::kMargin)],
                                   offers.z[std::size_t(j + Offers::kMargin)]};
            std::uint32_t    guess    = nearest[node]; // point 0 if none has offered itself
            const auto       consider = [&](std::uint32_t point) {
                if (buckets.squaredDistance(place, point) < buckets.squaredDistance(place, guess)) guess = point;
            };
            if (j > 0) consider(nearest[node - 1]);
            if (i > 0) consider(nearest[node - columns]);
            const bool isOne = i % kSome == 0 && j % kSome == 0;
            nearest[node]    = buckets.nearest(place, guess, isOne ? std::numeric_limits<double>::infinity() : exact2);
        }
    }
}

/// Gives the nodes that have no point one of their neighbours', the nearest of those that reach them.
void takeFromNeighbours(const Buckets& buckets, const Offers& offers, std::vector<std::uint32_t>& nearest)
{
    const int                 rows = offers.grid.nodesX(), columns = offers.grid.nodesZ();
    std::vector<std::uint8_t> is(nearest.size());
    std::ranges::transform(nearest, is.begin(), [](std::uint32_t point) { return point == kNoPoint; });
    const auto consider = [&](int i, int j, int fromI, int fromJ) {
        if (fromI < 0 || fromJ < 0 || fromI >= rows || fromJ >= columns) return;
        const ChartPoint place{offers.x[std::size_t(i + Offers::kMargin)], offers.z[std::size_t(j + Offers::kMargin)]};
        std::uint32_t&   own       = nearest[std::size_t(i * columns + j)];
        const std::uint32_t beside = nearest[std::size_t(fromI * columns + fromJ)];
        if (own == kNoPoint || buckets.squaredDistance(place, beside) < buckets.squaredDistance(place, own))
            own = beside;
    };
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            if (!is[std::size_t(i * columns + j)]) continue;
            for (const int beside : {-1, 0, 1}) consider(i, j, i - 1, j + beside);
            consider(i, j, i, j - 1);
        }
    for (int i = rows - 1; i >= 0; --i)
        for (int j = columns - 1; j >= 0; --j) {
            if (!is[std::size_t(i * columns + j)]) continue;
            for (const int beside : {-1, 0, 1}) consider(i, j, i + 1, j + beside);
            consider(i, j, i, j + 1);
        }
}

} // namespace

std::vector<std::uint32_t> nearestPoint(const PlateGrid& grid, const ChartPoint& origin,
                                        std::span<const ChartPoint> points, double exact)
{
    PALP_EXPECT(grid.cellsX >= 0 && grid.cellsZ >= 0 && grid.spacingX > 0 && grid.spacingZ > 0,
                std::to_string(grid.cellsX) + " x " + std::to_string(grid.cellsZ) + " cells of " +
                    std::to_string(grid.spacingX) + " m x " + std::to_string(grid.spacingZ) + " m");
    PALP_EXPECT(!points.empty() && points.size() < kNoPoint, std::to_string(points.size()) + " points");
    Axis         x(origin.x, grid.spacingX, grid.cellsX);
    Axis         z(origin.z, grid.spacingZ, grid.cellsZ);
    const int    rows  = rowsFor(survey(points, x, z));
    const double reach = std::min(0.5 * rows * x.spacing - x.margin(), 0.5 * kLanes * z.spacing - z.margin());
    Offers       offers(grid, origin);
    const bool   finite = offer(points, rows, offers);
    PALP_EXPECT(finite, "a point is not finite");

    std::vector<std::uint32_t> nearest(grid.nodes());
    std::size_t                node     = 0;
    const double               settled2 = reach > 0 ? reach * reach : -1; // [m^2]
    bool                       settled  = true;
    for (int i = 0; i < grid.nodesX(); ++i) {
        const double* distances2 = offers.distances2(i);
        const double* numbers    = offers.points(i);
        for (int j = 0; j < grid.nodesZ(); ++j) {
            nearest[node++] = std::uint32_t(numbers[j]);
            settled &= distances2[j] <= settled2;
        }
    }
    if (settled) return nearest;

    constexpr double kPointsPerBucket = 2; // measured: 1 to 4 make little difference
    const double     width = std::sqrt(kPointsPerBucket * (x.high - x.low) * (z.high - z.low) / double(points.size()));
    const Buckets    buckets(points, x.bands(width, points.size()), z.bands(width, points.size()));
    searchBeyond(settled2, exact * exact, buckets, offers, nearest);
    if (std::isfinite(exact)) takeFromNeighbours(buckets, offers, nearest);
    return nearest;
}

} // namespace palp
