#include "engine/plate/host/frame.h"
#include "engine/plate/host/kernels.h"

// plate_restrict.comp and plate_prolong.comp: along z row by row, then along x rows with rows. The shaders nest the
// same sums node by node, so each sum along z is theirs, computed once.

namespace palp::PALPATE_ISA {
namespace {

/// The entries of a transfer table, each weight of all nodes together, so that a row of nodes is a loop.
template <class Real>
struct Weights {
    const int*  first;
    const Real* weights; ///< weight n of node j at [n nodes + j]
    int         nodes;

    /// \param table   of one axis, from the entry of the first node
    Weights(const float* table, int count, int stride, int perNode, Scratch<int>& firsts, Scratch<Real>& scratch)
        : nodes(count)
    {
        int*  f = firsts.of(count);
        Real* w = scratch.of(std::ptrdiff_t(count) * perNode);
        for (int j = 0; j < count; ++j) {
            f[j] = int(table[j * stride]);
            for (int n = 0; n < perNode; ++n) w[n * count + j] = Real(table[j * stride + 1 + n]);
        }
        first   = f;
        weights = w;
    }
};

/// Row (firstX + m) along z times the m-th weight along x, summed as the shader does.
template <class Real>
void addRow(Real weight, const Real* row, Real* sum, int nodes)
{
#pragma GCC ivdep
    for (int j = 0; j < nodes; ++j) sum[j] += weight * row[j];
}

/// Interpolates a coarse field; visit(i, values of fine row i).
template <class Real, class Coarse, class Visit>
void prolong(const TransferPush& push, const float* tableX, const float* tableZ, const Coarse* coarse, Visit&& visit)
{
    static thread_local Scratch<int>  firsts;
    static thread_local Scratch<Real> weightScratch, rowScratch, sumScratch;
    const int                         fineNodes = push.fine.cellsZ + 1, coarseNodes = push.coarse.cellsZ + 1;
    const Weights<Real>               z(tableZ, fineNodes, kFineStride, kFineWeights, firsts, weightScratch);

    // Coarse rows interpolated along z, the last kFineWeights of them.
    Real*      rows   = rowScratch.of(std::ptrdiff_t(kFineWeights) * fineNodes);
    Real*      sum    = sumScratch.of(fineNodes);
    int        made   = 0;
    const auto alongZ = [&](int row) {
        const Coarse* from = coarse + std::ptrdiff_t(row) * coarseNodes;
        Real*         to   = rows + std::ptrdiff_t(row % kFineWeights) * fineNodes;
        for (int j = 0; j < fineNodes; ++j) {
            const Coarse* at    = from + z.first[j];
            Real          value = 0;
            for (int n = 0; n < kFineWeights; ++n) value += z.weights[n * fineNodes + j] * Real(at[n]);
            to[j] = value;
        }
    };
    for (int i = 0; i <= push.fine.cellsX; ++i) {
        const float* entry = tableX + i * kFineStride;
        const int    first = int(entry[0]);
        for (; made < first + kFineWeights; ++made) alongZ(made);
        for (int j = 0; j < fineNodes; ++j) sum[j] = 0;
        for (int m = 0; m < kFineWeights; ++m)
            addRow(Real(entry[1 + m]), rows + std::ptrdiff_t((first + m) % kFineWeights) * fineNodes, sum, fineNodes);
        visit(i, sum);
    }
}

template <class Real, class Coarse>
void interpolateFrom(const HostDispatch& d)
{
    const auto& push   = pushed<TransferPush>(d);
    const auto* coarse = bound<const Coarse>(d, 2);
    auto*       fine   = bound<Real>(d, 3);
    const int   nodes  = push.fine.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load)
        prolong<Real>(push, bound<const float>(d, 0), bound<const float>(d, 1), coarse + load * nodesOf(push.coarse),
                      [&](int i, const Real* row) {
                          Real* to = fine + load * nodesOf(push.fine) + std::ptrdiff_t(i) * nodes;
                          for (int j = 0; j < nodes; ++j) to[j] = row[j];
                      });
}

} // namespace

void correct(const HostDispatch& d)
{
    const auto& push   = pushed<TransferPush>(d);
    const auto* coarse = bound<const float>(d, 2);
    auto*       after  = bound<float>(d, 3);
    const auto* before = bound<const float>(d, 4);
    const int   nodes  = push.fine.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load)
        prolong<float>(push, bound<const float>(d, 0), bound<const float>(d, 1), coarse + load * nodesOf(push.coarse),
                       [&](int i, const float* row) {
                           const std::ptrdiff_t at = load * nodesOf(push.fine) + std::ptrdiff_t(i) * nodes;
#pragma GCC ivdep
                           for (int j = 0; j < nodes; ++j) after[at + j] = before[at + j] + row[j];
                       });
}

void interpolate_f32(const HostDispatch& d)
{
    interpolateFrom<float, float>(d);
}

void interpolate_f64(const HostDispatch& d)
{
    interpolateFrom<double, double>(d);
}

void interpolateFirst_f32(const HostDispatch& d)
{
    interpolateFrom<float, float>(d);
}

void interpolateFirst_f64(const HostDispatch& d)
{
    interpolateFrom<double, float>(d);
}

void restrict(const HostDispatch& d)
{
    static thread_local Scratch<int>   firsts;
    static thread_local Scratch<float> weightScratch, rowScratch;
    const auto&                        push      = pushed<TransferPush>(d);
    const int                          fineNodes = push.fine.cellsZ + 1, coarseNodes = push.coarse.cellsZ + 1;
    const int                          fineRows = push.fine.cellsX + 1, coarseRows = push.coarse.cellsX + 1;
    const auto*                        tableX = bound<const float>(d, 0) + std::ptrdiff_t(kFineStride) * fineRows;
    const auto*                        tableZ = bound<const float>(d, 1) + std::ptrdiff_t(kFineStride) * fineNodes;
    const Weights<float>               z(tableZ, coarseNodes, kCoarseStride, kCoarseWeights, firsts, weightScratch);
    float*                             rows = rowScratch.of(std::ptrdiff_t(kCoarseWeights) * coarseNodes);
    for (std::ptrdiff_t load = 0; load < std::ptrdiff_t(d.groups.z); ++load) {
        const float* fine   = bound<const float>(d, 2) + load * nodesOf(push.fine);
        float*       coarse = bound<float>(d, 3) + load * nodesOf(push.coarse);
        int          made   = 0;
        const auto   alongZ = [&](int row) {
            const float* from = fine + std::ptrdiff_t(row) * fineNodes;
            float*       to   = rows + std::ptrdiff_t(row % kCoarseWeights) * coarseNodes;
            for (int j = 0; j < coarseNodes; ++j) {
                float value = 0;
                for (int n = 0; n < kCoarseWeights; ++n)
                    value += z.weights[n * coarseNodes + j] * from[min(z.first[j] + n, fineNodes - 1)];
                to[j] = value;
            }
        };
        for (int i = 0; i < coarseRows; ++i) {
            const float* entry = tableX + std::ptrdiff_t(i) * kCoarseStride;
            const int    first = int(entry[0]);
            if (made < first) made = first;
            for (; made < min(first + kCoarseWeights, fineRows); ++made) alongZ(made);
            float* sum = coarse + std::ptrdiff_t(i) * coarseNodes;
            for (int j = 0; j < coarseNodes; ++j) sum[j] = 0;
            for (int m = 0; m < kCoarseWeights; ++m)
                addRow(entry[1 + m], rows + std::ptrdiff_t(min(first + m, fineRows - 1) % kCoarseWeights) * coarseNodes,
                       sum, coarseNodes);
        }
    }
}

} // namespace palp::PALPATE_ISA
