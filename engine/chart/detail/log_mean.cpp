#include "engine/chart/detail/log_mean.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>

#include "engine/core/contract.h"

// A point is spread over the nodes around it, which costs one multiplication and one sum per node and sum: the square's
// side is eight widths, so nothing that treats points by cells is shorter at the accuracy of doubles (moments about the
// nodes would have to be of order 17 along either axis where the square holds 12 x 12 nodes).
//
// With the first node at distance a and others h further each, exp(-(a - m h)^2 / (2 s^2)) is
//     exp(-a^2 / (2 s^2))  exp(a h / s^2)^m  exp(-(m h)^2 / (2 s^2)),
// so that a point needs three exponentials and powers, which are made four at a time; the last factor is a table.
// Exponents stay below 32, so powers lose no more than some 50 units in the last place.
//
// Where points are dense, the square holds 4 x 4 nodes, and points follow each other along a curve: then the sums of
// those which reach the same nodes are made in registers.

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

/// Returns ln x to 1e-15 for normal x, without branches.
PALPATE_PART double logarithm(double x)
{
    // x = 2^n m with m from sqrt(1/2) to sqrt(2), and ln m = 2 artanh t, t = (m - 1) / (m + 1), |t| < 0.172.
    constexpr std::uint64_t kRootOfHalf = 0x3fe6a09e667f3bcd, kMantissa = 0xfffffffffffff, kOne = 0x3ff;
    constexpr double        kHigh = 0x1.62e42fefa3800p-1, kLow = 0x1.ef35793c76730p-45; // ln 2
    constexpr double        kWhole = 0x1p52; // a whole number in its lowest bits is added to it
    const auto              bits   = std::bit_cast<std::uint64_t>(x) + ((kOne << 52) - kRootOfHalf);
    const double            m      = std::bit_cast<double>((bits & kMantissa) + kRootOfHalf);
    const double            n =
        std::bit_cast<double>((bits >> 52) | std::bit_cast<std::uint64_t>(kWhole)) - (kWhole + double(kOne));
    const double t = (m - 1) / (m + 1), t2 = t * t;
    double       series = 1.0 / 21; // the sum of t^2k / (2k + 1): the first term omitted is 7e-19
    series              = series * t2 + 1.0 / 19;
    series              = series * t2 + 1.0 / 17;
    series              = series * t2 + 1.0 / 15;
    series              = series * t2 + 1.0 / 13;
    series              = series * t2 + 1.0 / 11;
    series              = series * t2 + 1.0 / 9;
    series              = series * t2 + 1.0 / 7;
    series              = series * t2 + 1.0 / 5;
    series              = series * t2 + 1.0 / 3;
    return n * kHigh + (2 * t + (2 * t * t2 * series + n * kLow));
}

/// Computes ln x [1] of positive numbers, normal ones: exponential() takes no others back either.
PALPATE_PART void logarithms(const double* x, double* to, std::size_t count)
{
#pragma GCC ivdep
    for (std::size_t n = 0; n < count; ++n) to[n] = logarithm(x[n]);
}

constexpr std::size_t kPiece = 256; ///< points that are treated together: their numbers stay in the nearest cache

/// The nodes along one axis that points of a piece reach.
struct Reach {
    int    first[kPiece], count[kPiece];
    double from[kPiece];  ///< of each point from its first node [m]
    double ratio[kPiece]; ///< of the factors of neighbouring nodes, but for the table [1]

    PALPATE_PART void find(std::span<const ChartPoint> positions, double ChartPoint::*axis, double corner, double width,
                           double spacing, int nodes)
    {
        const double reach = kResamplingReach * width, per = 1 / spacing;
        for (std::size_t n = 0; n < positions.size(); ++n) {
            const double position = positions[n].*axis - corner;
            const double low      = std::max(0.0, std::ceil((position - reach) * per));
            const double high     = std::min(nodes - 1.0, std::floor((position + reach) * per));
            first[n]              = int(std::min(low, double(nodes)));
            count[n]              = int(std::max(high - low + 1, 0.0));
            from[n]               = count[n] > 0 ? position - low * spacing : 0;
        }
        exponentials(spacing / (width * width), from, ratio, positions.size());
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

/// \tparam kValues  quantities of the points
template <std::size_t kValues>
struct Task {
    const PatchWindow&               window;
    std::span<const ChartPoint>      positions;
    std::array<PointValues, kValues> values;
    double                           width;
    std::size_t                      stride;
    double*                          sums;

    static constexpr std::size_t kSums = 1 + kValues; ///< for each node
};

std::vector<double> tableOf(double spacing, double width, int nodes)
{
    const int           most = std::min(nodes, int(2 * kResamplingReach * width / spacing) + 2);
    std::vector<double> table(std::size_t(most + kLanes));
    for (int m = 0; m < most; ++m)
        table[std::size_t(m)] = std::exp(-(m * spacing) * (m * spacing) / (2 * width * width));
    return table;
}

PALPATE_PART void addRow(double factor, const double* factors, int registers, double* sums)
{
    for (int v = 0; v < registers * kLanes; v += kLanes) {
        Numbers f, s;
        std::memcpy(&f, factors + v, sizeof f);
        std::memcpy(&s, sums + v, sizeof s);
        s += factor * f;
        std::memcpy(sums + v, &s, sizeof s);
    }
}

/// Sums at 4 x 4 nodes, of points that follow each other.
template <std::size_t kValues>
class RunOfPoints {
public:
    explicit RunOfPoints(const Task<kValues>& task) : task_(task) {}

    PALPATE_PART void add(int i, int j, const double* alongX, const double* alongZ,
                          const std::array<double, kValues>& logarithms)
    {
        if (i != i_ || j != j_) {
            handOver();
            i_ = i;
            j_ = j;
        }
        Numbers z;
        std::memcpy(&z, alongZ, sizeof z);
        sums_[0].add(alongX, z);
        for (std::size_t v = 0; v < kValues; ++v) sums_[v + 1].add(alongX, z * logarithms[v]);
    }
    PALPATE_PART void handOver()
    {
        if (i_ < 0) return;
        double* row = task_.sums + std::size_t(i_) * task_.kSums * task_.stride + std::size_t(j_);
        for (const auto part : {&FourRows::a, &FourRows::b, &FourRows::c, &FourRows::d})
            for (const FourRows& sum : sums_) {
                Numbers there;
                std::memcpy(&there, row, sizeof there);
                there += sum.*part;
                std::memcpy(row, &there, sizeof there);
                row += task_.stride;
            }
        sums_ = {};
        i_    = -1;
    }

private:
    struct FourRows {
        Numbers a{}, b{}, c{}, d{};

        PALPATE_PART void add(const double* alongX, const Numbers& z)
        {
            a += alongX[0] * z;
            b += alongX[1] * z;
            c += alongX[2] * z;
            d += alongX[3] * z;
        }
    };

    const Task<kValues>&              task_;
    int                               i_ = -1, j_ = -1; ///< the first node; -1: no point yet
    std::array<FourRows, kValues + 1> sums_{};          ///< of the weights, then of those times each logarithm
};

/// The points that come near the window, a piece at a time: where a ball is gathered about a square, a third do not.
template <std::size_t kValues>
class NearPoints {
public:
    ChartPoint positions[kPiece]; ///< [m]
    double     values[kValues][kPiece];

    explicit NearPoints(const Task<kValues>& task) : task_(task)
    {
        const double reach  = kResamplingReach * task.width;
        const auto&  corner = task.window.corner;
        low_                = {corner.x - reach, corner.z - reach};
        high_ = {corner.x + task.window.grid.sizeX() + reach, corner.z + task.window.grid.sizeZ() + reach};
    }
    /// Returns how many points the next piece has; 0: no more.
    PALPATE_PART std::size_t next()
    {
        std::size_t count = 0;
        for (; next_ < task_.positions.size() && count < kPiece; ++next_) {
            const ChartPoint p = task_.positions[next_];
            positions[count]   = p;
            for (std::size_t v = 0; v < kValues; ++v) values[v][count] = task_.values[v][next_];
            count += std::size_t((p.x >= low_.x) & (p.x <= high_.x) & (p.z >= low_.z) & (p.z <= high_.z));
        }
        return count;
    }

private:
    const Task<kValues>& task_;
    ChartPoint           low_, high_;
    std::size_t          next_ = 0;
};

template <std::size_t kValues>
PALPATE_PART void spreadAll(const Task<kValues>& task)
{
    const PlateGrid&          grid   = task.window.grid;
    const std::vector<double> tableX = tableOf(grid.spacingX, task.width, grid.nodesX());
    const std::vector<double> tableZ = tableOf(grid.spacingZ, task.width, grid.nodesZ());
    const int                 margin = int(tableZ.size());
    std::vector<double>       factors(tableX.size() + task.kSums * tableZ.size());
    double* const             alongX = factors.data();
    double* const             alongZ = alongX + tableX.size(); // then the same times each logarithm
    Reach                     x, z;
    double                    nearest[kPiece]; // the weight of the first node, but for the tables [1]
    double                    logarithmOf[kValues][kPiece];
    RunOfPoints<kValues>      run(task);
    NearPoints<kValues>       near(task);
    while (const std::size_t count = near.next()) {
        const auto positions = std::span<const ChartPoint>(near.positions, count);
        x.find(positions, &ChartPoint::x, task.window.corner.x, task.width, grid.spacingX, grid.nodesX());
        z.find(positions, &ChartPoint::z, task.window.corner.z, task.width, grid.spacingZ, grid.nodesZ());
        for (std::size_t n = 0; n < count; ++n) nearest[n] = x.from[n] * x.from[n] + z.from[n] * z.from[n];
        exponentials(-0.5 / (task.width * task.width), nearest, nearest, count);
        for (std::size_t v = 0; v < kValues; ++v) logarithms(near.values[v], logarithmOf[v], count);
        for (std::size_t n = 0; n < count; ++n) {
            if (x.count[n] == 0 || z.count[n] == 0) continue;
            factorsOf(x.ratio[n], 1, tableX.data(), x.count[n], alongX);
            const int registers = factorsOf(z.ratio[n], nearest[n], tableZ.data(), z.count[n], alongZ);
            if (x.count[n] <= kLanes && registers == 1) {
                std::array<double, kValues> own;
                for (std::size_t v = 0; v < kValues; ++v) own[v] = logarithmOf[v][n];
                run.add(x.first[n], z.first[n], alongX, alongZ, own);
                continue;
            }
            for (std::size_t v = 0; v < kValues; ++v)
                for (int m = 0; m < registers * kLanes; ++m)
                    alongZ[int(v + 1) * margin + m] = alongZ[m] * logarithmOf[v][n];
            double* row = task.sums + std::size_t(x.first[n]) * task.kSums * task.stride + std::size_t(z.first[n]);
            for (int r = 0; r < x.count[n]; ++r)
                for (std::size_t s = 0; s < task.kSums; ++s, row += task.stride)
                    addRow(alongX[r], alongZ + int(s) * margin, registers, row);
        }
    }
    run.handOver();
}

PALPATE_PART void meansOf(const double* weight, const double* logarithm, std::span<double> row)
{
    double* const to = row.data();
#pragma GCC ivdep
    for (std::size_t j = 0; j < row.size(); ++j) to[j] = exponential(logarithm[j] / weight[j]);
    for (std::size_t j = 0; j < row.size(); ++j)
        to[j] = weight[j] > 0 ? to[j] : std::numeric_limits<double>::quiet_NaN();
}

template <std::size_t kValues>
void spreadPortable(const Task<kValues>& task)
{
    spreadAll(task);
}
void meansPortable(const double* weight, const double* logarithm, std::span<double> row)
{
    meansOf(weight, logarithm, row);
}
#if defined(__x86_64__)
// Without FMA, so that every processor gives the same bits.
template <std::size_t kValues>
__attribute__((target("avx2"))) void spreadAvx2(const Task<kValues>& task)
{
    spreadAll(task);
}
__attribute__((target("avx2"))) void meansAvx2(const double* weight, const double* logarithm, std::span<double> row)
{
    meansOf(weight, logarithm, row);
}
#endif

template <std::size_t kValues>
void spread(const Task<kValues>& task)
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
                         std::span<const PointValues> values, double width)
    : grid_(window.grid), stride_(std::size_t(grid_.nodesZ() + kLanes)), sumsPerRow_(1 + values.size()),
      sums_(sumsPerRow_ * std::size_t(grid_.nodesX() + kLanes) * stride_)
{
    PALP_EXPECT(values.size() == 1 || values.size() == kTogether, std::to_string(values.size()) + " quantities");
    if (values.size() == 1)
        spread(Task<1>{window, positions, {values[0]}, width, stride_, sums_.data()});
    else
        spread(Task<2>{window, positions, {values[0], values[1]}, width, stride_, sums_.data()});
}

void LogMeanSums::means(int i, std::size_t quantity, std::span<double> row) const
{
    const double* const weight    = sums_.data() + sumsPerRow_ * std::size_t(i) * stride_;
    const double* const logarithm = weight + (1 + quantity) * stride_;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return meansAvx2(weight, logarithm, row);
#endif
    meansPortable(weight, logarithm, row);
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
