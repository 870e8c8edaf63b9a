#include "engine/chart/detail/log_mean.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
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
// those which reach the same nodes are made in registers. Elsewhere a point's factors along z stay in registers while
// rows go by; they begin where a register of the sums does, because one that lies across two lines of the cache takes
// twice as long. Each sum adds its points in their order, however wide registers are: bits do not depend on that.

namespace palp {
namespace {

constexpr int  kLanes     = 4;
constexpr int  kMostLanes = 8; ///< of the widest registers
typedef double Numbers __attribute__((vector_size(8 * kLanes)));

template <int kWide>
struct Register {
    typedef double Type __attribute__((vector_size(8 * kWide)));
};
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
    std::vector<double> table(std::size_t(most + kMostLanes));
    for (int m = 0; m < most; ++m)
        table[std::size_t(m)] = std::exp(-(m * spacing) * (m * spacing) / (2 * width * width));
    return table;
}

/// The weights of one point, and those times each logarithm, along z.
/// \tparam kWide  numbers in a register
template <std::size_t kSums, int kWide>
struct FactorsAlongZ {
    double*     numbers; ///< of all sums; the first node of a register of the sums is the first number [1]
    std::size_t margin;  ///< numbers of one sum

    /// Adds them times the factors of some rows, `kCount` registers of each.
    template <int kCount>
    PALPATE_PART void addTo(double* sums, std::size_t stride, const double* alongX, int rows) const
    {
        using Wide = typename Register<kWide>::Type;
        Wide factors[kSums][kCount];
        for (std::size_t s = 0; s < kSums; ++s) std::memcpy(factors[s], numbers + s * margin, sizeof factors[s]);
        for (int r = 0; r < rows; ++r)
            for (std::size_t s = 0; s < kSums; ++s, sums += stride)
                for (int v = 0; v < kCount; ++v) {
                    Wide there;
                    std::memcpy(&there, sums + v * kWide, sizeof there);
                    there += alongX[r] * factors[s][v];
                    std::memcpy(sums + v * kWide, &there, sizeof there);
                }
    }
    /// Does the same for any number of registers.
    PALPATE_PART void addAllTo(double* sums, std::size_t stride, const double* alongX, int rows, int registers) const
    {
        FactorsAlongZ left = *this;
        for (; registers > kAtOnce; registers -= kAtOnce, sums += kAtOnce * kWide, left.numbers += kAtOnce * kWide)
            left.template addTo<kAtOnce>(sums, stride, alongX, rows);
        if (registers == 1) left.template addTo<1>(sums, stride, alongX, rows);
        if (registers == 2) left.template addTo<2>(sums, stride, alongX, rows);
        if (registers == 3) left.template addTo<3>(sums, stride, alongX, rows);
        if (registers == 4) left.template addTo<4>(sums, stride, alongX, rows);
    }

    static constexpr int kAtOnce = 4; ///< registers: those of three sums are twelve of the sixteen that there are
};

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

/// Where the factors of a point are made, of all its sums.
struct FactorTables {
    std::vector<double> tableX, tableZ; ///< the factors' parts that points have in common [1]
    std::size_t         margin;         ///< numbers along z of one sum
    std::vector<double> numbers;        ///< along x, then along z those of each sum [1]

    FactorTables(const PlateGrid& grid, double width, std::size_t sums)
        : tableX(tableOf(grid.spacingX, width, grid.nodesX())), tableZ(tableOf(grid.spacingZ, width, grid.nodesZ())),
          margin((tableZ.size() + 2 * kMostLanes) / kMostLanes * kMostLanes), numbers(tableX.size() + sums * margin)
    {
    }
};

/// Adds one point to the sums of nodes that are more than 4 x 4.
/// \param alongZ  room for the factors of all sums
/// \param nearest the weight of the first node, but for the tables [1]
template <std::size_t kValues, int kWide>
PALPATE_PART void spreadWide(const Task<kValues>& task, const FactorTables& tables, const Reach& x, const Reach& z,
                             std::size_t n, double nearest, const std::array<double, kValues>& logarithms,
                             const double* alongX, double* alongZ)
{
    const int before = z.first[n] % kWide; // nodes between the register's first and the point's
    const int filled =
        before + kLanes * factorsOf(z.ratio[n], nearest, tables.tableZ.data(), z.count[n], alongZ + before);
    const int registers = (filled + kWide - 1) / kWide;
    std::fill(alongZ, alongZ + before, 0.0);
    std::fill(alongZ + filled, alongZ + registers * kWide, 0.0);
    for (std::size_t v = 0; v < kValues; ++v)
        for (int m = 0; m < registers * kWide; ++m)
            alongZ[(v + 1) * tables.margin + std::size_t(m)] = alongZ[m] * logarithms[v];
    double* row = task.sums + std::size_t(x.first[n]) * task.kSums * task.stride + std::size_t(z.first[n] - before);
    FactorsAlongZ<1 + kValues, kWide>{alongZ, tables.margin}.addAllTo(row, task.stride, alongX, x.count[n], registers);
}

template <std::size_t kValues, int kWide>
PALPATE_PART void spreadAll(const Task<kValues>& task)
{
    const PlateGrid&     grid = task.window.grid;
    FactorTables         tables(grid, task.width, task.kSums);
    double* const        alongX = tables.numbers.data();
    double* const        alongZ = alongX + tables.tableX.size();
    Reach                x, z;
    double               nearest[kPiece]; // the weight of the first node, but for the tables [1]
    double               logarithmOf[kValues][kPiece];
    RunOfPoints<kValues> run(task);
    NearPoints<kValues>  near(task);
    while (const std::size_t count = near.next()) {
        const auto positions = std::span<const ChartPoint>(near.positions, count);
        x.find(positions, &ChartPoint::x, task.window.corner.x, task.width, grid.spacingX, grid.nodesX());
        z.find(positions, &ChartPoint::z, task.window.corner.z, task.width, grid.spacingZ, grid.nodesZ());
        for (std::size_t n = 0; n < count; ++n) nearest[n] = x.from[n] * x.from[n] + z.from[n] * z.from[n];
        exponentials(-0.5 / (task.width * task.width), nearest, nearest, count);
        for (std::size_t v = 0; v < kValues; ++v) logarithms(near.values[v], logarithmOf[v], count);
        for (std::size_t n = 0; n < count; ++n) {
            if (x.count[n] == 0 || z.count[n] == 0) continue;
            std::array<double, kValues> own;
            for (std::size_t v = 0; v < kValues; ++v) own[v] = logarithmOf[v][n];
            factorsOf(x.ratio[n], 1, tables.tableX.data(), x.count[n], alongX);
            if (x.count[n] > kLanes || z.count[n] > kLanes) {
                spreadWide<kValues, kWide>(task, tables, x, z, n, nearest[n], own, alongX, alongZ);
                continue;
            }
            factorsOf(z.ratio[n], nearest[n], tables.tableZ.data(), z.count[n], alongZ);
            run.add(x.first[n], z.first[n], alongX, alongZ, own);
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
    spreadAll<kValues, kLanes>(task);
}
void meansPortable(const double* weight, const double* logarithm, std::span<double> row)
{
    meansOf(weight, logarithm, row);
}
#if defined(__x86_64__)
// Products and sums stay apart, so that every processor gives the same bits.
#define PALPATE_AVX512 __attribute__((target("avx512f,avx512dq,avx512vl")))
template <std::size_t kValues>
__attribute__((target("avx2"))) void spreadAvx2(const Task<kValues>& task)
{
    spreadAll<kValues, kLanes>(task);
}
template <std::size_t kValues>
PALPATE_AVX512 void spreadAvx512(const Task<kValues>& task)
{
    spreadAll<kValues, kMostLanes>(task);
}
__attribute__((target("avx2"))) void meansAvx2(const double* weight, const double* logarithm, std::span<double> row)
{
    meansOf(weight, logarithm, row);
}
PALPATE_AVX512 void meansAvx512(const double* weight, const double* logarithm, std::span<double> row)
{
    meansOf(weight, logarithm, row);
}
#endif

template <std::size_t kValues>
void spread(const Task<kValues>& task, [[maybe_unused]] Instructions with)
{
#if defined(__x86_64__)
    if (with == Instructions::avx512) return spreadAvx512(task);
    if (with == Instructions::avx2) return spreadAvx2(task);
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

std::vector<Instructions> logMeanInstructions()
{
    std::vector<Instructions> all{Instructions::portable};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) all.push_back(Instructions::avx2);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
        all.push_back(Instructions::avx512);
#endif
    return all;
}

LogMeanSums::LogMeanSums(const PatchWindow& window, std::span<const ChartPoint> positions,
                         std::span<const PointValues> values, double width, Instructions with)
    : grid_(window.grid), with_(with), stride_(std::size_t(grid_.nodesZ() / kMostLanes + 2) * kMostLanes),
      sumsPerRow_(1 + values.size()),
      storage_(sumsPerRow_ * std::size_t(grid_.nodesX() + kLanes) * stride_ + kMostLanes)
{
    PALP_EXPECT(values.size() == 1 || values.size() == kTogether, std::to_string(values.size()) + " quantities");
    void*       begin = storage_.data();
    std::size_t space = storage_.size() * sizeof(double);
    sums_             = static_cast<double*>(std::align(kMostLanes * sizeof(double), sizeof(double), begin, space));
    if (values.size() == 1)
        spread(Task<1>{window, positions, {values[0]}, width, stride_, sums_}, with);
    else
        spread(Task<2>{window, positions, {values[0], values[1]}, width, stride_, sums_}, with);
}

void LogMeanSums::means(int i, std::size_t quantity, std::span<double> row) const
{
    const double* const weight    = sums_ + sumsPerRow_ * std::size_t(i) * stride_;
    const double* const logarithm = weight + (1 + quantity) * stride_;
#if defined(__x86_64__)
    if (with_ == Instructions::avx512) return meansAvx512(weight, logarithm, row);
    if (with_ == Instructions::avx2) return meansAvx2(weight, logarithm, row);
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
