#include "engine/tools/bench/damped_jacobi.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <utility>

#include "engine/core/contract.h"

namespace palp::bench {
namespace {

struct Sweep {
    std::size_t                    nodes;
    const double*                  w;
    double*                        next;
    const double*                  push;
    std::array<const double*, 13>  factor;
    std::array<std::ptrdiff_t, 13> offset;
};

inline __attribute__((always_inline)) void sweepBody(const Sweep& s)
{
    const double* w    = s.w;
    double*       next = s.next;
    const auto&   o    = s.offset;
    const auto&   f    = s.factor;
    const double *f0 = f[0], *f1 = f[1], *f2 = f[2], *f3 = f[3], *f4 = f[4], *f5 = f[5], *f6 = f[6], *f7 = f[7],
                 *f8 = f[8], *f9 = f[9], *f10 = f[10], *f11 = f[11], *f12 = f[12];
    const double *w0 = w + o[0], *w1 = w + o[1], *w2 = w + o[2], *w3 = w + o[3], *w4 = w + o[4], *w5 = w + o[5],
                 *w6 = w + o[6], *w7 = w + o[7], *w8 = w + o[8], *w9 = w + o[9], *w10 = w + o[10], *w11 = w + o[11],
                 *w12 = w + o[12];
    // The arrays do not overlap. Without this word compilers would have to test that for all pairs of arrays; then the
    // loop is not vectorised and takes three times as long.
#if defined(__clang__)
#pragma clang loop vectorize(assume_safety)
#else
#pragma GCC ivdep
#endif
    for (std::size_t n = 0; n < s.nodes; ++n) // sums of pairs, so that additions need not wait for each other
        next[n] = ((s.push[n] + f0[n] * w0[n]) + (f1[n] * w1[n] + f2[n] * w2[n])) +
                  ((f3[n] * w3[n] + f4[n] * w4[n]) + (f5[n] * w5[n] + f6[n] * w6[n])) +
                  (((f7[n] * w7[n] + f8[n] * w8[n]) + (f9[n] * w9[n] + f10[n] * w10[n])) +
                   (f11[n] * w11[n] + f12[n] * w12[n]));
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void sweepAvx2(const Sweep& s)
{
    sweepBody(s);
}
#endif

void sweepPortable(const Sweep& s)
{
    sweepBody(s);
}

void sweepOnce(const Sweep& s)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return sweepAvx2(s);
#endif
    sweepPortable(s);
}

} // namespace

DampedJacobi::DampedJacobi(const Plate& plate, const NodeField& force, double omega)
    : nodesX_(plate.grid.nodesX()), nodesZ_(plate.grid.nodesZ())
{
    const PlateMatrix   matrix(plate);
    const std::size_t   nodes = plate.grid.nodes();
    std::vector<double> diagonal(nodes, 1);
    for (int c = 0; c < matrix.unknowns(); ++c) // rows ascend: the diagonal comes first in its column
        diagonal[std::size_t(matrix.nodeOf()[std::size_t(c)])] =
            matrix.value()[std::size_t(matrix.columnStart()[std::size_t(c)])];

    // There is one array of factors for each offset between a node and a node on which it depends.
    std::map<std::ptrdiff_t, std::size_t> numberOf{{0, 0}};
    for (auto& factors : factor_) factors.assign(nodes, 0);
    const auto set = [&](int row, int column, double value) {
        const auto [at, isNew] = numberOf.emplace(column - row, numberOf.size());
        PALP_EXPECT(at->second < factor_.size(), "a node with more than 12 neighbours");
        offset_[at->second]                   = at->first;
        factor_[at->second][std::size_t(row)] = (row == column) - omega * value / diagonal[std::size_t(row)];
    };
    for (int c = 0; c < matrix.unknowns(); ++c)
        for (int k = matrix.columnStart()[std::size_t(c)]; k < matrix.columnStart()[std::size_t(c) + 1]; ++k) {
            const int row    = matrix.nodeOf()[std::size_t(matrix.row()[std::size_t(k)])];
            const int column = matrix.nodeOf()[std::size_t(c)];
            set(row, column, matrix.value()[std::size_t(k)]);
            if (row != column) set(column, row, matrix.value()[std::size_t(k)]);
        }
    margin_ = 0;
    for (const auto& [offset, number] : numberOf) margin_ = std::max(margin_, std::size_t(std::abs(offset)));

    push_.assign(nodes, 0);
    for (const int node : matrix.nodeOf())
        push_[std::size_t(node)] = omega * force.values()[std::size_t(node)] / diagonal[std::size_t(node)];
    w_.assign(nodes + 2 * margin_, 0);
    next_ = w_;
}

void DampedJacobi::sweep(int times)
{
    for (int n = 0; n < times; ++n) {
        Sweep s{push_.size(), w_.data() + margin_, next_.data() + margin_, push_.data(), {}, offset_};
        for (std::size_t k = 0; k < factor_.size(); ++k) s.factor[k] = factor_[k].data();
        sweepOnce(s);
        std::swap(w_, next_);
    }
}

NodeField DampedJacobi::answer() const
{
    NodeField field(nodesX_, nodesZ_);
    std::copy(w_.begin() + std::ptrdiff_t(margin_), w_.end() - std::ptrdiff_t(margin_), field.values().begin());
    return field;
}

} // namespace palp::bench
