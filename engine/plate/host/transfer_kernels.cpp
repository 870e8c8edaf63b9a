#include "engine/plate/host/together.h"

// plate_restrict.comp and plate_prolong.comp. The shaders nest sums along x and z node by node; each inner sum is made
// once here, a row at a time. Weights of 0 are omitted, and away from the sides all entries of a table are alike.

namespace palp::PALPATE_ISA {
namespace {

/// The part of a transfer table for one of the two levels: per node a first node and weights.
struct Table {
    const float* entries;
    int          count;   ///< nodes
    int          weights; ///< of each

    const float* entry(int node) const { return entries + std::ptrdiff_t(node) * (weights + 1); }
    int          first(int node) const { return int(entry(node)[0]); }

    bool areAlike(int node, int next, int move) const
    {
        bool same = first(next) == first(node) + move;
        for (int n = 1; n <= weights; ++n) same = same && entry(node)[n] == entry(next)[n];
        return same;
    }
};

/// Nodes from begin to before end, each with the weights of the node `period` before it, `move` further on; the first
/// such nodes.
struct Run {
    int begin = 0, end = 0;

    Run(const Table& table, int period, int move)
    {
        const auto goesOn = [&](int node) {
            return node + period < table.count && table.areAlike(node, node + period, move);
        };
        int alike = 0; // such nodes in a row
        for (; end < table.count && alike < period; ++end) alike = goesOn(end) ? alike + 1 : 0;
        if (alike < period) {
            end = 0;
            return;
        }
        begin = end - period;
        while (goesOn(end)) ++end;
        end += period;
    }
};

/// A sum of rows times weights.
template <class Real, class Term = Real>
struct Terms {
    static constexpr int kMost = kCoarseWeights;
    int                  count = 0;
    NumberOf<Real>       weights[kMost];
    const Term*          rows[kMost];

    void add(NumberOf<Real> weight, const Term* row)
    {
        if (weight == 0) return;
        weights[count] = weight;
        rows[count++]  = row;
    }

    /// Calls put(j, sum) for every place of the rows.
    template <class Put>
    void sum(int nodes, Put&& put) const
    {
        switch (count) {
        case 0:
            for (int j = 0; j < nodes; ++j) put(j, Real(0));
            return;
        case 1:
            return sumOf<1>(nodes, put); // a coarse row on a fine one
        case 4:
            return sumOf<4>(nodes, put); // between coarse rows
        case 5:
            return sumOf<5>(nodes, put); // the transpose of both
        default:
            return padded().template sumOf<kMost>(nodes, put);
        }
    }

private:
    template <int kCount, class Put>
    void sumOf(int nodes, Put&& put) const
    {
        NumberOf<Real> w[kCount];
        const Term*    r[kCount];
        for (int n = 0; n < kCount; ++n) {
            w[n] = weights[n];
            r[n] = rows[n];
        }
#pragma GCC ivdep
        for (int j = 0; j < nodes; ++j) {
            Real value = w[0] * Real(r[0][j]);
#pragma GCC unroll 8
            for (int n = 1; n < kCount; ++n) value += w[n] * Real(r[n][j]);
            put(j, value);
        }
    }

    Terms padded() const
    {
        Terms all = *this;
        for (; all.count < kMost; ++all.count) {
            all.weights[all.count] = 0;
            all.rows[all.count]    = rows[0];
        }
        return all;
    }
};

/// Interpolates a coarse row at the fine nodes of table z.
/// \param halves  room for as many numbers, plus two
template <class Real, class Coarse>
void prolongRow(const Table& z, const Run& run, const Coarse* from, Real* halves, Real* to)
{
    const auto one = [&](int j) {
        const float* entry = z.entry(j);
        Real         value = Real(0);
        for (int n = 0; n < kFineWeights; ++n) value += NumberOf<Real>(entry[1 + n]) * Real(from[int(entry[0]) + n]);
        to[j] = value;
    };
    const int pairs = max((run.end - run.begin) / 2, 0), end = run.begin + 2 * pairs;
    for (int j = 0; j < run.begin; ++j) one(j);
    for (int j = end; j < z.count; ++j) one(j);
    if (pairs == 0) return;

    Real* const half[2] = {halves, halves + pairs};
    for (int odd : {0, 1}) {
        const float*        entry = z.entry(run.begin + odd);
        Terms<Real, Coarse> terms;
        for (int n = 0; n < kFineWeights; ++n) terms.add(NumberOf<Real>(entry[1 + n]), from + int(entry[0]) + n);
        terms.sum(pairs, [put = half[odd]](int n, const Real& value) { put[n] = value; });
    }
    const Real *even = half[0], *odd = half[1];
    Real*       out = to + run.begin;
#pragma GCC ivdep
    for (int n = 0; n < pairs; ++n) {
        out[2 * n]     = even[n];
        out[2 * n + 1] = odd[n];
    }
}

/// Interpolates a coarse field; visitRow(i) gives what to call with (j, value) for every node of fine row i.
template <class Real, class Coarse, class VisitRow>
void prolong(const TransferPush& push, const float* tableX, const float* tableZ, const Coarse* coarse,
             VisitRow&& visitRow)
{
    static thread_local Scratch<Real> scratch;
    const int                         fineNodes = push.fine.cellsZ + 1, coarseNodes = push.coarse.cellsZ + 1;
    const Table                       x{tableX, push.fine.cellsX + 1, kFineWeights}, z{tableZ, fineNodes, kFineWeights};
    const Run                         run(z, 2, 1);
    Real*                             rows   = scratch.of(std::ptrdiff_t(kFineWeights + 1) * fineNodes + 2);
    Real*                             halves = rows + std::ptrdiff_t(kFineWeights) * fineNodes;
    int                               made   = 0;
    const auto rowOf = [&](int row) { return rows + std::ptrdiff_t(row % kFineWeights) * fineNodes; };
    for (int i = 0; i < x.count; ++i) {
        const float* entry = x.entry(i);
        for (; made < x.first(i) + kFineWeights; ++made)
            prolongRow(z, run, coarse + std::ptrdiff_t(made) * coarseNodes, halves, rowOf(made));
        Terms<Real> terms;
        for (int m = 0; m < kFineWeights; ++m) terms.add(NumberOf<Real>(entry[1 + m]), rowOf(x.first(i) + m));
        terms.sum(fineNodes, visitRow(i));
    }
}

template <class Real, class Coarse>
void interpolateFrom(const HostDispatch& d)
{
    const auto& push   = pushed<TransferPush>(d);
    const auto* coarse = bound<const Coarse>(d, 2);
    auto*       fine   = bound<Real>(d, 3);
    const int   nodes  = push.fine.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load)
        prolong<Real>(push, bound<const float>(d, 0), bound<const float>(d, 1), coarse + load * nodesOf(push.coarse),
                      [&](int i) {
                          Real* to = fine + load * nodesOf(push.fine) + std::ptrdiff_t(i) * nodes;
                          return [=](int j, const Real& value) { to[j] = value; };
                      });
}

/// Gathers a row of column sums at the coarse nodes of table z.
/// \param halves  room for as many numbers
template <class Real>
void restrictRow(const Table& z, const Run& run, const Real* column, int fineNodes, Real* halves, Real* to)
{
    const auto one = [&](int j) {
        const float* entry = z.entry(j);
        Real         value = Real(0.0f);
        for (int n = 0; n < kCoarseWeights; ++n) value += entry[1 + n] * column[min(int(entry[0]) + n, fineNodes - 1)];
        to[j] = value;
    };
    for (int j = 0; j < run.begin; ++j) one(j);
    for (int j = run.end; j < z.count; ++j) one(j);
    if (run.end <= run.begin) return;

    // Every second number has a row of its own, so that the numbers for coarse nodes lie side by side.
    const Real* from = column + z.first(run.begin);
    const int   each = (fineNodes - z.first(run.begin)) / 2, uneven = (fineNodes - z.first(run.begin)) % 2;
    Real *      even = halves, *odd = halves + each + 1;
#pragma GCC ivdep
    for (int n = 0; n < each; ++n) {
        even[n] = from[2 * n];
        odd[n]  = from[2 * n + 1];
    }
    if (uneven) even[each] = from[2 * each];
    Terms<Real> terms;
    for (int n = 0; n < kCoarseWeights; ++n) terms.add(z.entry(run.begin)[1 + n], (n % 2 ? odd : even) + n / 2);
    Real* out = to + run.begin;
    terms.sum(run.end - run.begin, [=](int j, const Real& value) { out[j] = value; });
}

template <class Real>
void correctOf(const HostDispatch& d)
{
    const auto& push   = pushed<TransferPush>(d);
    const auto* coarse = bound<const Real>(d, 2);
    auto*       after  = bound<Real>(d, 3);
    const auto* before = bound<const Real>(d, 4);
    const int   nodes  = push.fine.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load)
        prolong<Real>(push, bound<const float>(d, 0), bound<const float>(d, 1), coarse + load * nodesOf(push.coarse),
                      [&](int i) {
                          const std::ptrdiff_t at = load * nodesOf(push.fine) + std::ptrdiff_t(i) * nodes;
                          const Real*          w  = before + at;
                          Real*                to = after + at;
                          return [=](int j, const Real& value) { to[j] = w[j] + value; };
                      });
}

template <class Real>
void interpolateOf(const HostDispatch& d)
{
    interpolateFrom<Real, Real>(d);
}

template <class Real>
void interpolateFirstOf(const HostDispatch& d)
{
    interpolateFrom<Real, AsMany<float, Real>>(d);
}

template <class Real>
void restrictOf(const HostDispatch& d)
{
    static thread_local Scratch<Real> scratch;
    const auto&                       push      = pushed<TransferPush>(d);
    const int                         fineNodes = push.fine.cellsZ + 1, coarseNodes = push.coarse.cellsZ + 1;
    const int                         fineRows = push.fine.cellsX + 1;
    const Table x{bound<const float>(d, 0) + std::ptrdiff_t(kFineStride) * fineRows, push.coarse.cellsX + 1,
                  kCoarseWeights};
    const Table z{bound<const float>(d, 1) + std::ptrdiff_t(kFineStride) * fineNodes, coarseNodes, kCoarseWeights};
    const Run   run(z, 1, 2);
    Real*       column = scratch.of(2 * std::ptrdiff_t(fineNodes) + 2);
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load) {
        const Real* fine   = bound<const Real>(d, 2) + load * nodesOf(push.fine);
        Real*       coarse = bound<Real>(d, 3) + load * nodesOf(push.coarse);
        for (int i = 0; i < x.count; ++i) {
            Terms<Real> terms;
            for (int m = 0; m < kCoarseWeights; ++m)
                terms.add(x.entry(i)[1 + m], fine + std::ptrdiff_t(min(x.first(i) + m, fineRows - 1)) * fineNodes);
            terms.sum(fineNodes, [=](int j, const Real& value) { column[j] = value; });
            restrictRow(z, run, column, fineNodes, column + fineNodes, coarse + std::ptrdiff_t(i) * coarseNodes);
        }
    }
}

} // namespace

PALPATE_ALONE_AND_TOGETHER(correct, float)
PALPATE_ALONE_AND_TOGETHER(restrict, float)
PALPATE_REALS_ALONE_AND_TOGETHER(interpolate)
PALPATE_REALS_ALONE_AND_TOGETHER(interpolateFirst)

} // namespace palp::PALPATE_ISA
