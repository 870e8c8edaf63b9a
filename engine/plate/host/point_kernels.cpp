#include "compute_shaders/shared/point_layout.h"
#include "engine/plate/host/frame.h"
#include "engine/plate/host/kernels.h"

// Between points and nodes: rigidity_nearest.comp, rigidity_log_mean.comp and plate_lift.comp.

namespace palp::PALPATE_ISA {
namespace {

struct Buckets {
    const uint*           starts;
    const ScatteredPoint* points;

    static float floor(float a) { return __builtin_floorf(a); }
    static float exp(float a) { return __builtin_expf(a); }

    int   bucketStart(int n) const { return int(starts[n]); }
    float pointX(int n) const { return points[n].x; }
    float pointZ(int n) const { return points[n].z; }
    float pointLogarithm(int n) const { return points[n].logarithm; }
    uint  pointNumber(int n) const { return points[n].number; }

#include "compute_shaders/shared/log_mean.h"
#include "compute_shaders/shared/nearest_point.h"
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
    for (int i = 0; i <= g.cellsX; ++i)
        for (int j = 0; j <= g.cellsZ; ++j) {
            const auto mean = buckets.logMeanAt(g, i, j);
            *D++            = mean.weight > 0 ? Buckets::exp(mean.logarithm / mean.weight)
                                              : buckets.points[buckets.nearestPoint(g, i, j).at].rigidity;
            *without++      = mean.nearest2 > g.nearby2 ? 1U : 0U;
        }
}

PALPATE_IN_BOTH_PRECISIONS(lift)

} // namespace palp::PALPATE_ISA
