#include "engine/chart/detail/log_mean.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>

// A point is spread over the nodes around it, which costs one multiplication and one sum per node and sum: the square's
// side is eight widths, so nothing that treats points by cells is shorter at the accuracy of doubles (moments about the
// nodes would have to be of order 17 along either axis where the square holds 12 x 12 nodes).
//
// With the first node at distance a and others h further each, exp(-(a - m h)^2 / (2 s^2)) is
//     exp(-a^2 / (2 s^2))  exp(a h / s^2)^m  exp(-(m h)^2 / (2 s^2)),
// so that a point needs three exponentials and powers, which are made four at a time; the last factor is a table.
// Exponents stay below 32, so powers lose no more than some 50 units in the last place.

namespace palp {
namespace {

constexpr int  kLanes = 4;
typedef double Numbers __attribute__((vector_size(8 * kLanes)));
#define PALPATE_PART [[gnu::always_inline]] inline

/// Returns exp(x) to 1e-15 for |x| < 700, without branches, so that loops of it become vector instructions.
PALPATE_PART double exponential(double x)
{
    constexpr double kRound = 0x1.8p52; // adding it leaves the nearest whole number in the lowest bits
    constexpr double kHigh = 0x1.62e42fefa3800p-1, kLow = 0x1.ef35793c76730p-45; // ln 2
    const double     whole = x * std::numbers::log2e + kRound, n = whole - kRound;
    const double     r      = (x - n * kHigh) - n * kLow; // |r| <= ln 2 / 2: the first term omitted is 4e-18
    double           series = 1.0 / 6227020800; // the sum of r^k / k!, unrolled: a loop would not become vectors
    series                  = series * r + 1.0 / 479001600;
    series                  = series * r + 1.0 / 39916800;
    series                  = series * r + 1.0 / 3628800;
    series                  = series * r + 1.0 / 362880;
    series                  = series * r + 1.0 / 40320;
    series                  = series * r + 1.0 / 5040;
    series                  = series * r + 1.0 / 720;
    series                  = series * r + 1.0 / 120;
    series                  = series * r + 1.0 / 24;
    series                  = series * r + 1.0 / 6;
    series                  = series * r + 0.5;
    series                  = series * r + 1.0;
    series                  = series * r + 1.0;
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(series) + (std::bit_cast<std::uint64_t>(whole) << 52));
}

/// Computes the numbers exp(factor t).
PALPATE_PART void exponentials(double factor, const double* t, double* to, std::size_t count)
{
#pragma GCC ivdep
    for (std::size_t n = 0; n < count; ++n) to[n] = exponential(factor * t[n]);
}

/// The nodes along one axis that points reach.
struct Reach {
    std::vector<int>    first, count;
    std::vector<double> from;  ///< of each point from its first node [m]
    std::vector<double> ratio; ///< of the factors of neighbouring nodes, but for the table [1]

    explicit Reach(std::size_t points) : first(points), count(points), from(points), ratio(points) {}

    PALPATE_PART void find(std::span<const ChartPoint> positions, double ChartPoint::*axis, double corner, double width,
                           double spacing, int nodes)
    {
        const double reach = kResamplingReach * width;
        for (std::size_t n = 0; n < first.size(); ++n) {
            const double position = positions[n].*axis - corner;
            const double low      = std::max(0.0, std::ceil((position - reach) / spacing));
            const double high     = std::min(nodes - 1.0, std::floor((position + reach) / spacing));
            first[n]              = int(std::min(low, double(nodes)));
            count[n]              = int(std::max(high - low + 1, 0.0));
            from[n]               = count[n] > 0 ? position - low * spacing : 0;
        }
        exponentials(spacing / (width * width), from.data(), ratio.data(), first.size());
    }
};

/// Computes powers ratio^m times a table's entries, the ones from `count` on 0; returns how many registers they fill.
PALPATE_PART int factorsOf(double ratio, double scale, const double* table, int count, double* to)
{
    const double  squared = ratio * ratio, fourth = squared * squared;
    const Numbers number{0, 1, 2, 3};
    Numbers       power{scale, scale * ratio, scale * squared, scale * (squared * ratio)};
    int           m = 0;
    for (; m < count; m += kLanes) {
        Numbers entries;
        std::memcpy(&entries, table + m, sizeof entries);
        const Numbers all = power * entries, kept = number < double(count - m) ? all : Numbers{};
        std::memcpy(to + m, &kept, sizeof kept);
        power *= fourth;
    }
    return m / kLanes;
}

struct Task {
    const PatchWindow&          window;
    std::span<const ChartPoint> positions;
    std::span<const double>     rigidities;
    double                      width;
    std::size_t                 stride;
    double*                     sums;
};

std::vector<double> tableOf(double spacing, double width, int nodes)
{
    const int           most = std::min(nodes, int(2 * kResamplingReach * width / spacing) + 2);
    std::vector<double> table(std::size_t(most + kLanes));
    for (int m = 0; m < most; ++m)
        table[std::size_t(m)] = std::exp(-(m * spacing) * (m * spacing) / (2 * width * width));
    return table;
}

PALPATE_PART void addRow(double factor, const double* factors, const double* logarithms, int registers, double* weight,
                         double* logarithm)
{
    for (int v = 0; v < registers * kLanes; v += kLanes) {
        Numbers f, g, w, l;
        std::memcpy(&f, factors + v, sizeof f);
        std::memcpy(&g, logarithms + v, sizeof g);
        std::memcpy(&w, weight + v, sizeof w);
        std::memcpy(&l, logarithm + v, sizeof l);
        w += factor * f;
        l += factor * g;
        std::memcpy(weight + v, &w, sizeof w);
        std::memcpy(logarithm + v, &l, sizeof l);
    }
}

PALPATE_PART void spreadAll(const Task& task)
{
    const PlateGrid&    grid   = task.window.grid;
    const std::size_t   points = task.positions.size();
    Reach               x(points), z(points);
    std::vector<double> nearest(points); // the weight of the first node, but for the tables [1]
    x.find(task.positions, &ChartPoint::x, task.window.corner.x, task.width, grid.spacingX, grid.nodesX());
    z.find(task.positions, &ChartPoint::z, task.window.corner.z, task.width, grid.spacingZ, grid.nodesZ());
    for (std::size_t n = 0; n < points; ++n) nearest[n] = x.from[n] * x.from[n] + z.from[n] * z.from[n];
    exponentials(-0.5 / (task.width * task.width), nearest.data(), nearest.data(), points);

    const std::vector<double> tableX = tableOf(grid.spacingX, task.width, grid.nodesX());
    const std::vector<double> tableZ = tableOf(grid.spacingZ, task.width, grid.nodesZ());
    std::vector<double>       factors(tableX.size() + 2 * tableZ.size());
    double* const             alongX     = factors.data();
    double* const             alongZ     = alongX + tableX.size();
    double* const             logarithms = alongZ + tableZ.size();
    for (std::size_t n = 0; n < points; ++n) {
        if (x.count[n] == 0 || z.count[n] == 0) continue;
        const double logarithm = std::log(task.rigidities[n]);
        factorsOf(x.ratio[n], 1, tableX.data(), x.count[n], alongX);
        const int registers = factorsOf(z.ratio[n], nearest[n], tableZ.data(), z.count[n], alongZ);
        for (int m = 0; m < registers * kLanes; ++m) logarithms[m] = alongZ[m] * logarithm;
        double* row = task.sums + std::size_t(x.first[n]) * 2 * task.stride + std::size_t(z.first[n]);
        for (int r = 0; r < x.count[n]; ++r, row += 2 * task.stride)
            addRow(alongX[r], alongZ, logarithms, registers, row, row + task.stride);
    }
}

PALPATE_PART void meansOf(const double* weight, const double* logarithm, std::span<double> row)
{
    double* const to = row.data();
#pragma GCC ivdep
    for (std::size_t j = 0; j < row.size(); ++j) to[j] = exponential(logarithm[j] / weight[j]);
    for (std::size_t j = 0; j < row.size(); ++j)
        to[j] = weight[j] > 0 ? to[j] : std::numeric_limits<double>::quiet_NaN();
}

void spreadPortable(const Task& task)
{
    spreadAll(task);
}
void meansPortable(const double* weight, const double* logarithm, std::span<double> row)
{
    meansOf(weight, logarithm, row);
}
#if defined(__x86_64__)
// Without FMA, so that every processor gives the same bits.
__attribute__((target("avx2"))) void spreadAvx2(const Task& task)
{
    spreadAll(task);
}
__attribute__((target("avx2"))) void meansAvx2(const double* weight, const double* logarithm, std::span<double> row)
{
    meansOf(weight, logarithm, row);
}
#endif

void spread(const Task& task)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return spreadAvx2(task);
#endif
    spreadPortable(task);
}

// --- what is covered

using Mark = unsigned char; // 1: yes

/// Cells of the grid, one about each node, and those around them in which a point may still matter.
struct Cells {
    int               marginX, marginZ; ///< [nodes]
    int               rows, columns;
    std::vector<Mark> marks;

    Cells(const PlateGrid& grid, int reachX, int reachZ)
        : marginX(reachX), marginZ(reachZ), rows(grid.nodesX() + 2 * reachX), columns(grid.nodesZ() + 2 * reachZ),
          marks(std::size_t(rows) * std::size_t(columns))
    {
    }

    [[nodiscard]] Mark* row(int i) { return marks.data() + std::size_t(i) * std::size_t(columns); }

    void mark(double x, double z) // [spacings]
    {
        const double i = x + 0.5 + marginX, j = z + 0.5 + marginZ;
        if (i >= 0 && i < rows && j >= 0 && j < columns) row(int(i))[int(j)] = 1;
    }
};

/// Returns how far along the other axis a cell's mark reaches, by the distance along one [nodes]; empty where it does
/// not reach even its own node, or so far that growing marks takes longer than looking for nearest points.
std::vector<int> reaches(const PlateGrid& grid, double nearby)
{
    constexpr int    kFarthest = 64; // [nodes]
    std::vector<int> across;
    if (!(nearby < kFarthest * std::min(grid.spacingX, grid.spacingZ))) return across;
    for (int a = 0;; ++a) {
        const double along = (a + 0.5) * grid.spacingX, left2 = nearby * nearby - along * along;
        const int    reach = left2 > 0 ? int(std::floor(std::sqrt(left2) / grid.spacingZ - 0.5)) : -1;
        if (reach < 0) return across;
        across.push_back(reach);
    }
}

/// Marks of a row grown to either side.
class GrownRow {
public:
    explicit GrownRow(Cells& cells) : cells_(cells), grown_(std::size_t(cells.columns)) {}

    void begin(int row)
    {
        from_ = cells_.row(row);
        by_   = 0;
        std::copy(from_, from_ + cells_.columns, grown_.begin());
    }
    void growTo(int by)
    {
        while (by_ < by) {
            ++by_;
            Mark* __restrict to  = grown_.data();
            const Mark* from     = from_;
            const int   distance = by_;
            for (int j = distance; j < cells_.columns - distance; ++j) to[j] |= from[j - distance] | from[j + distance];
        }
    }
    /// Adds the marks of the nodes.
    void addTo(Mark* __restrict row, int nodes) const
    {
        const Mark* from = grown_.data() + cells_.marginZ;
        for (int j = 0; j < nodes; ++j) row[j] |= from[j];
    }

private:
    Cells&            cells_;
    std::vector<Mark> grown_;
    const Mark*       from_ = nullptr;
    int               by_   = 0;
};

} // namespace

LogMeanSums::LogMeanSums(const PatchWindow& window, std::span<const ChartPoint> positions,
                         std::span<const double> rigidities, double width)
    : grid_(window.grid), stride_(std::size_t(grid_.nodesZ() + kLanes)),
      sums_(2 * std::size_t(grid_.nodesX()) * stride_)
{
    spread({window, positions, rigidities, width, stride_, sums_.data()});
}

void LogMeanSums::means(int i, std::span<double> row) const
{
    const double* weight = sums_.data() + 2 * std::size_t(i) * stride_;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return meansAvx2(weight, weight + stride_, row);
#endif
    meansPortable(weight, weight + stride_, row);
}

bool surelyCovered(const PatchWindow& window, std::span<const ChartPoint> positions, double width)
{
    constexpr double       kCertain = 1 - 1e-9; // of a distance: far more than rounding [1]
    const PlateGrid&       grid     = window.grid;
    const std::vector<int> across   = reaches(grid, kCertain * kResamplingNearby * width);
    if (across.empty()) return false;
    const int reachX = int(across.size()) - 1, reachZ = across.front();

    Cells        cells(grid, reachX, reachZ);
    const double perX = 1 / grid.spacingX, perZ = 1 / grid.spacingZ;
    for (const ChartPoint& p : positions) cells.mark((p.x - window.corner.x) * perX, (p.z - window.corner.z) * perZ);

    const int         nodes = grid.nodesZ();
    std::vector<Mark> covered(grid.nodes());
    GrownRow          grown(cells);
    for (int i = 0; i < cells.rows; ++i) {
        grown.begin(i);
        for (int a = reachX; a >= 0; --a) {
            grown.growTo(across[std::size_t(a)]);
            for (const int node : {i - reachX - a, i - reachX + a})
                if (node >= 0 && node < grid.nodesX())
                    grown.addTo(covered.data() + std::size_t(node) * std::size_t(nodes), nodes);
        }
    }
    return std::find(covered.begin(), covered.end(), Mark(0)) == covered.end();
}

} // namespace palp
