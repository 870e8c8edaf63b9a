#pragma once
#include "engine/plate/host/together.h"

// The operator row by row. Moments, and changes from row to row, are computed once per node and cell and kept, where an
// invocation of a shader computes those around its node anew: the numbers are the same, with a third of the work.

namespace palp::PALPATE_ISA {

// The rules of the sides depend on the distance to a side. A column far from both is like the middle one of eight
// cells, which is a constant, so loops along a row have no branch.
inline constexpr int kMiddle = 4, kMiddleCells = 8;

inline PlateLevel middleOf(PlateLevel g)
{
    g.cellsX = kMiddleCells;
    g.cellsZ = kMiddleCells;
    return g;
}

inline PlateLevel middleOfZ(PlateLevel g)
{
    g.cellsZ = kMiddleCells;
    return g;
}

/// The shared headers for one precision. The fields that they ask for are not used here.
template <class Real>
struct Rules {
    using real = Real;

    [[noreturn]] static real rigidity(int, int) { __builtin_unreachable(); }
    [[noreturn]] static real foundationShape(int, int) { __builtin_unreachable(); }
    [[noreturn]] static real deflection(int, int) { __builtin_unreachable(); }
    [[noreturn]] static real otherColour(int, int) { __builtin_unreachable(); }

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/plate_operator.h"
#include "compute_shaders/shared/plate_relax.h"
};

/// The nodes of a row from `first` to `last`.
struct ColumnRange {
    int first, last;
};

/// Computes rows of A w in a part of the grid, one after the other: each call of next() gives a row.
///
/// \tparam Field  has `const Real* row(int i)`: row i of the deflection, valid while rows up to i + 2 are asked for.
///                The number before its first one may be read.
template <class Real, class Field>
class OperatorRows {
public:
    OperatorRows(const PlateLevel& level, const float* rigidity, Field& field)
        : OperatorRows(level, rigidity, field, 0, {0, level.cellsZ})
    {
    }

    OperatorRows(const PlateLevel& level, const float* rigidity, Field& field, int firstRow, ColumnRange wanted)
        : g(level), middle(middleOfZ(level)), field_(field), nodes_(level.cellsZ + 1), wanted_(wanted),
          first_(max(wanted.first - 1, 0)), count_(min(wanted.last + 1, level.cellsZ) - first_ + 1),
          D_(rigidity + first_)
    {
        static thread_local Scratch<Real> scratch;
        // Room at either end, where no moment acts. The first node lies on a cache line: loops begin there.
        const std::ptrdiff_t line = 64 / sizeof(Real), stride = (count_ + 1 + line + line - 1) / line * line;
        Real*                at = scratch.of(kRows * stride);
        for (std::ptrdiff_t n = 0; n < kRows * stride; ++n) at[n] = Real(0);
        for (Real** row : {&slope_[0], &slope_[1], &mz_[0], &mz_[1], &bending_.moment, &bending_.change,
                           &bending_.second, &twisting_.moment, &twisting_.change}) {
            *row = at + line;
            at += stride;
        }
        const int   before = max(firstRow - 1, 0);
        const Real *w = row(before), *outside = row(rules.mirrored(before - 1, g.cellsX));
        for (int n = 0; n < count_; ++n) slope_[(before + 1) & 1][n] = rules.change(outside[n], w[n]);
        moments<false>(before);
        if (rules.isGuidedX(g, 0) && before == 0)
            for (int n = 0; n < count_; ++n) bending_.change[n] = Real(0); // the moment beyond is that on the side
        if (firstRow > 0) moments<true>(firstRow);
    }

    /// Calls to.put(j, to.value(j, A w)) for the wanted nodes of row i; i goes up by 1 from the first row.
    ///
    /// So that loops begin where the row does and end with a whole vector, put(0, ...) is called twice, the second time
    /// with the right value; it must not change what value() reads elsewhere.
    template <class To>
    void next(int i, To&& to)
    {
        if (i < g.cellsX)
            moments<true>(i + 1);
        else
            afterTheLast();
        if (g.shapeAt == 0) return writeRow(i, to, [](Real bed, int) { return bed; });
        const float* shape = D_ + g.shapeAt + std::ptrdiff_t(i) * nodes_;
        writeRow(i, to, [shape](Real bed, int n) { return bed * Real(shape[n]); });
    }

private:
    static constexpr int kRows = 9;

    /// \param weight  (foundation of a node in a row, its index) -> what the foundation's shape makes of it
    template <class To, class Weight>
    void writeRow(int i, To&& to, const Weight& weight)
    {
        const Real *mz = mz_[i & 1], *second = bending_.second, *twist = twisting_.change, *w = row(i);
        const Real  bed        = Real(g.bed) * rules.nodeShare(middle, i, kMiddle);
        const Real  bedAtSides = Real(g.bed) * rules.nodeShare(g, i, 0);
        const auto  force      = [&](int n, Real held) {
            return rules.forceFrom(second[n], rules.secondDifference(mz[n - 1], mz[n], mz[n + 1]),
                                         rules.change(twist[n - 1], twist[n]), weight(held, n), w[n]);
        };
        const int  first = first_, begin = wanted_.first - first, end = min(wanted_.last, nodes_ - 2) - first;
        const bool atFirst = wanted_.first == 0, atLast = wanted_.last == nodes_ - 1;
        const auto atSide0 = atFirst ? to.value(0, force(0, bedAtSides)) : Real(0);
#pragma GCC ivdep
        for (int n = begin; n <= end; ++n) to.put(first + n, to.value(first + n, force(n, bed)));
        if (atFirst) to.put(0, atSide0);
        if (atLast) to.put(nodes_ - 1, to.value(nodes_ - 1, force(count_ - 1, bedAtSides)));
    }
    const Real* row(int i) const
    {
        return field_.row(i) + first_;
    }

    // Bending moments of row i and, of the cells between it and the row before, twisting moments.
    template <bool kCells>
    void moments(int i)
    {
        if (rules.isHingedX(g, i))
            moments<kCells, RowOf::hingedSide>(i);
        else if (rules.isGuidedX(g, i))
            moments<kCells, RowOf::guidedSide>(i);
        else
            moments<kCells, RowOf::others>(i);
    }

    enum class RowOf { hingedSide, guidedSide, others };

    template <bool kCells, RowOf kRow>
    void moments(int i)
    {
        const PlateLevel level = g; // a copy that no store can change
        const Real *     w = row(i), *after = row(rules.mirrored(i + 1, level.cellsX));
        const Real*      was   = slope_[(i + 1) & 1];
        Real *           slope = slope_[i & 1], *mz = mz_[i & 1];
        const float*     D     = D_ + std::ptrdiff_t(i) * nodes_;
        const Bending    x     = bending_;
        const Twisting   cells = twisting_;

        constexpr bool kHinged = kRow == RowOf::hingedSide;

        const auto atSide = [&](int j) {
            const int n = j - first_, south = rules.mirrored(j - 1, level.cellsZ) - first_,
                      north = rules.mirrored(j + 1, level.cellsZ) - first_;
            slope[n]        = rules.change(w[n], after[n]);
            const Real p    = rules.change(was[n], slope[n]);
            const Real q    = rules.secondDifference(w[south], w[n], w[north]);
            mz[n]           = rules.momentZ(level, i, j, Real(D[n]), p, q);
            x.goOn(n, rules.momentX(level, i, j, Real(D[n]), p, q));
        };
        const bool atFirst = first_ == 0, atLast = first_ + count_ == nodes_;
        const Real moment0 = x.moment[0], change0 = x.change[0]; // the loop takes node 0 for one inside
        const int  end = atLast ? count_ - 1 : count_;
#pragma GCC ivdep
        for (int n = 0; n < end; ++n) {
            const Real along = rules.change(w[n], after[n]);
            const Real p     = rules.change(was[n], along);
            const Real q     = rules.secondDifference(w[n - 1], w[n], w[n + 1]);
            slope[n]         = along;
            mz[n]            = Real(D[n]) * rules.bendingZ(level, kHinged, p, q);
            if (kRow == RowOf::guidedSide) mz[n] = Real(0.5F) * mz[n];
            x.goOn(n, kHinged ? Real(0) : Real(D[n]) * rules.bendingX(level, false, p, q));
            if (kCells) cells.goOn(n, twistOf(D, was, n));
        }
        if (atFirst) {
            x.moment[0] = moment0;
            x.change[0] = change0;
            atSide(0);
        }
        if (atLast) atSide(level.cellsZ);
        if (atFirst && rules.isGuidedZ(level, 0)) mz[-1] = mz[0];
        if (atLast && rules.isGuidedZ(level, level.cellsZ)) mz[count_] = mz[count_ - 1];
    }

    void afterTheLast()
    {
        const bool guided = rules.isGuidedX(g, g.cellsX);
        for (int n = 0; n < count_; ++n) {
            bending_.goOn(n, guided ? bending_.moment[n] : Real(0));
            twisting_.goOn(n, Real(0));
        }
    }

    // Twisting moment of the cell between a row of the rigidity and the one before.
    Real twistOf(const float* D, const Real* changes, int n) const
    {
        using Number    = NumberOf<Real>;
        const float* Dw = D - nodes_;
        return rules.twistingMoment(middleOf(g), kMiddle, kMiddle,
                                    Real((Number(Dw[n]) + Number(D[n])) + (Number(Dw[n + 1]) + Number(D[n + 1]))),
                                    changes[n], changes[n + 1]);
    }

    /// Twisting moments of a row of cells and how they differ from the row before.
    struct Twisting {
        Real *moment, *change;

        void goOn(int j, Real now) const
        {
            change[j] = rules.change(moment[j], now);
            moment[j] = now;
        }
    };

    /// Bending moments along x of a row of nodes, how they differ from the row before, and how that differs.
    struct Bending {
        Real *moment, *change, *second;

        void goOn(int j, Real now) const
        {
            const Real moved = rules.change(moment[j], now);
            second[j]        = rules.change(change[j], moved);
            moment[j]        = now;
            change[j]        = moved;
        }
    };

    static inline Rules<Real> rules{};

    const PlateLevel g, middle;
    Field&           field_;
    int              nodes_; ///< of a row of the grid
    ColumnRange      wanted_;
    int              first_, count_; ///< columns that are read: those wanted and one to either side
    const float*     D_;
    Real*            slope_[2]; ///< change of w from a row to the next, of two rows
    Real*            mz_[2];
    Bending          bending_;
    Twisting         twisting_;
};

/// The use of a row of A w.
template <class Value, class Put>
struct RowTo {
    Value value; ///< (j, A w)
    Put   put;   ///< (j, result of value)
};
template <class Value, class Put>
RowTo(Value, Put) -> RowTo<Value, Put>;

/// A field as it lies in memory.
template <class Real>
struct PlainField {
    const Real* first;
    int         stride;

    const Real* row(int i) const { return first + std::ptrdiff_t(i) * stride; }
};

} // namespace palp::PALPATE_ISA
