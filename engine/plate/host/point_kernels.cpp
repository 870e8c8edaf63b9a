#include "compute_shaders/shared/point_layout.h"
#include "engine/plate/host/frame.h"
#include "engine/plate/host/kernels.h"

// Between points and nodes: rigidity_nearest.comp, rigidity_log_mean.comp and plate_lift.comp.

namespace palp::PALPATE_ISA {
namespace {

/// exp(x) for |x| < 87 to two units in the last place, where Vulkan allows 3 + 2 |x|; without branches or calls, so
/// that loops of it become vector instructions.
inline float exponential(float x)
{
    constexpr float kRound = 0x1.8p23F; // adding it leaves the nearest whole number in the lowest bits
    constexpr float kHigh = 0x1.63p-1F, kLow = -0x1.bd0106p-13F; // ln 2; n kHigh is exact
    const float     whole = x * 0x1.715476p0F + kRound, n = whole - kRound;
    const float     r      = (x - n * kHigh) - n * kLow; // |r| <= ln 2 / 2: the first term left out is 5e-9
    float           series = 1.0F / 5040;
    series                 = series * r + 1.0F / 720;
    series                 = series * r + 1.0F / 120;
    series                 = series * r + 1.0F / 24;
    series                 = series * r + 1.0F / 6;
    series                 = series * r + 0.5F;
    series                 = series * r + 1.0F;
    series                 = series * r + 1.0F;
    return __builtin_bit_cast(float, __builtin_bit_cast(uint, series) + (__builtin_bit_cast(uint, whole) << 23));
}

struct Buckets {
    const uint*           starts;
    const ScatteredPoint* points;

    static float floor(float a) { return __builtin_floorf(a); }
    static float exp(float a) { return exponential(a); }

    int   bucketStart(int n) const { return int(starts[n]); }
    float pointX(int n) const { return points[n].x; }
    float pointZ(int n) const { return points[n].z; }
    float pointLogarithm(int n) const { return points[n].logarithm; }
    uint  pointNumber(int n) const { return points[n].number; }

#include "compute_shaders/shared/log_mean.h"
#include "compute_shaders/shared/nearest_point.h"
};

// Numbers are added by so many at once, which a compiler makes whole registers of; what is too many has the weight 0.
constexpr int kAtOnce = 16;

/// The nodes along one axis whose squares may hold a point, with its weights there.
struct Axis {
    float *        weights, *distances2; ///< [1], [larger spacing^2]
    int            first = 0, count = 0;
    std::ptrdiff_t groups = 0; ///< of kAtOnce nodes

    static std::ptrdiff_t room(int cells) { return (cells + 1) / kAtOnce * kAtOnce + 2 * kAtOnce; }

    void set(const PointLayout& layout, Buckets rules, float position, float reach, int cells, bool alongX)
    {
        const PointLayout g = layout; // a copy that no store can change
        // One node more on either side: isInReach() is the judge.
        first             = int(max(0.0F, min(float(cells + 1), position - reach - 1.0F)));
        count             = int(max(-1.0F, min(float(cells), position + reach + 1.0F))) + 1 - first;
        groups            = count > 0 ? (count + kAtOnce - 1) / kAtOnce : 0;
        const int    from = first;
        float *const to = weights, *const to2 = distances2;
#pragma GCC ivdep
        for (int n = 0; n < int(groups) * kAtOnce; ++n) {
            const float node = float(from + n), away = position - node;
            to2[n] = rules.squared(g, alongX ? away : 0.0F, alongX ? 0.0F : away);
            to[n]  = rules.isInReach(position, node, reach) ? rules.weightAt(g, to2[n]) : 0.0F;
        }
    }
};

/// The sums of log_mean.h at all nodes, point by point: the weight of a point is the product of one a side, so its
/// exponentials are made per row and column. A node's terms come in the order of the shader's; exp(a) exp(b) in place
/// of exp(a + b) is as far off as the exponentials of two devices.
class SpreadSums {
public:
    struct Row {
        float *weight, *logarithm, *nearest2;
    };

    explicit SpreadSums(const PointLayout& g) : stride_(Axis::room(g.cellsZ))
    {
        static thread_local Scratch<float> scratch;
        const std::ptrdiff_t               rows = g.cellsX + 1, roomX = Axis::room(g.cellsX);
        rows_         = scratch.of(3 * rows * stride_ + 2 * roomX + 2 * stride_);
        x_.weights    = rows_ + 3 * rows * stride_;
        x_.distances2 = x_.weights + roomX;
        z_.weights    = x_.distances2 + roomX;
        z_.distances2 = z_.weights + stride_;
        for (int i = 0; i < rows; ++i) {
            for (std::ptrdiff_t j = 0; j < 2 * stride_; ++j) row(i).weight[j] = 0;
            for (std::ptrdiff_t j = 0; j < stride_; ++j) row(i).nearest2[j] = 3.0e38F;
        }
    }

    [[nodiscard]] Row row(std::ptrdiff_t i) const
    {
        float* const first = rows_ + 3 * i * stride_;
        return {first, first + stride_, first + 2 * stride_};
    }

    void add(const PointLayout& g, Buckets rules, const ScatteredPoint& p)
    {
        x_.set(g, rules, p.x, g.reachX, g.cellsX, true);
        z_.set(g, rules, p.z, g.reachZ, g.cellsZ, false);
        for (int n = 0; n < x_.count; ++n) {
            if (x_.weights[n] == 0) continue;
            const Row to = row(x_.first + n);
            addTo(to.weight + z_.first, to.logarithm + z_.first, x_.weights[n], p.logarithm);
            if (x_.distances2[n] <= g.nearby2) approach(to.nearest2 + z_.first, x_.distances2[n]); // else too far away
        }
    }

private:
    void addTo(float* weights, float* logarithms, float along, float logarithm) const
    {
        const float*         across = z_.weights;
        const std::ptrdiff_t count  = z_.groups * kAtOnce;
#pragma GCC ivdep
        for (std::ptrdiff_t n = 0; n < count; ++n) {
            const float weight = along * across[n];
            weights[n] += weight;
            logarithms[n] += weight * logarithm;
        }
    }

    void approach(float* nearest2, float along2) const
    {
        const float*         across2 = z_.distances2;
        const std::ptrdiff_t count   = z_.groups * kAtOnce;
#pragma GCC ivdep
        for (std::ptrdiff_t n = 0; n < count; ++n) nearest2[n] = min(nearest2[n], along2 + across2[n]);
    }

    std::ptrdiff_t stride_; ///< of one sum of a row
    float*         rows_;
    Axis           x_{}, z_{};
};

template <class Real>
struct Lift {
    using real = Real;
    const Real* answer;
    int         stride;

    Real deflection(int i, int j) const { return answer[i * stride + j]; }

#include "compute_shaders/shared/plate_lift.h"
};

Buckets bucketsOf(const HostDispatch& d)
{
    return {bound<const uint>(d, 1), bound<const ScatteredPoint>(d, 2)};
}

template <class Real>
void liftOf(const HostDispatch& d)
{
    const auto&          g      = *bound<const PointLayout>(d, 0);
    const auto*          points = bound<const ScatteredPoint>(d, 1);
    const std::ptrdiff_t nodes  = std::ptrdiff_t(g.cellsX + 1) * (g.cellsZ + 1);
    auto*                w      = bound<float>(d, 4);
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        const float metres = bound<const float>(d, 3)[load];
        Lift<Real>  lift{bound<const Real>(d, 2) + load * nodes, g.cellsZ + 1};
        for (uint n = 0; n < g.points; ++n)
            w[load * g.points + points[n].number] = float(lift.liftedAt(g, points[n].x, points[n].z)) * metres;
    }
}

} // namespace

void rigidityNearest(const HostDispatch& d)
{
    const auto& g       = *bound<const PointLayout>(d, 0);
    Buckets     buckets = bucketsOf(d);
    auto*       D       = bound<float>(d, 3);
    auto*       without = bound<uint>(d, 4);
    for (int i = 0; i <= g.cellsX; ++i)
        for (int j = 0; j <= g.cellsZ; ++j) {
            const auto nearest = buckets.nearestPoint(g, i, j);
            *D++               = buckets.points[nearest.at].rigidity;
            *without++         = nearest.distance2 > g.nearby2 ? 1U : 0U;
        }
}

void rigidityLogMean(const HostDispatch& d)
{
    const auto& g       = *bound<const PointLayout>(d, 0);
    Buckets     buckets = bucketsOf(d);
    auto*       D       = bound<float>(d, 3);
    auto*       without = bound<uint>(d, 4);
    SpreadSums  sums(g);
    for (uint n = 0; n < g.points; ++n) sums.add(g, buckets, buckets.points[n]);
    const int nodes = g.cellsZ + 1;
    for (int i = 0; i <= g.cellsX; ++i, D += nodes, without += nodes) {
        const auto row = sums.row(i);
#pragma GCC ivdep
        for (int j = 0; j < nodes; ++j) {
            D[j]       = Buckets::exp(row.logarithm[j] / row.weight[j]);
            without[j] = row.nearest2[j] > g.nearby2 ? 1U : 0U;
        }
        for (int j = 0; j < nodes; ++j)
            if (!(row.weight[j] > 0)) D[j] = buckets.points[buckets.nearestPoint(g, i, j).at].rigidity;
    }
}

PALPATE_IN_BOTH_PRECISIONS(lift)

} // namespace palp::PALPATE_ISA
