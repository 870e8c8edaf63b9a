#pragma once
#include "engine/plate/host/rim_view.h"
#include "engine/plate/host/together.h"

// Dense fronts of a sparse factor: what the rims of plates and whole shells have in common. See
// engine/plate/multigrid/detail/rim.h.
//
// All arithmetic is in vectors of eight numbers whatever the instruction set, in one order: the bits are the same.

namespace palp::PALPATE_ISA {

inline constexpr int kLanes = kLoadsTogether;

inline std::ptrdiff_t max(std::ptrdiff_t a, std::ptrdiff_t b)
{
    return a < b ? b : a;
}

/// The signs of pivots that are all positive.
struct AllPositive {
    template <class Real>
    static Real of(int, Real value)
    {
        return value;
    }
    static bool suits(int, double pivot) { return pivot > 0; }
};

/// The signs that pivots must have, by own unknown of the front: 1 or -1.
struct GivenSigns {
    const double* signs;

    [[nodiscard]] double of(int k, double value) const { return signs[k] * value; }
    [[nodiscard]] bool   suits(int k, double pivot) const { return signs[k] * pivot > 0; }
};

/// Subtracts columns [from, to) of a front from kColumns columns beside each other, the first of them c, in the rows
/// [row, end), whole vectors.
template <int kColumns, class Real, class Signs>
void subtractColumns(Real* front, int rows, int c, int from, int to, int row, int end, const Signs& signs)
{
    constexpr int kVectors = sizeof(Real) == sizeof(double) ? 1 : 2; // what registers hold
    const auto    subtract = [&]<int kMany>() {
        Together<Real> sums[kColumns][kMany];
        Real*          column = front + std::ptrdiff_t(c) * rows + row;
        for (int n = 0; n < kColumns; ++n)
            for (int v = 0; v < kMany; ++v) sums[n][v] = eightOf(column + std::ptrdiff_t(n) * rows + v * kLanes);
        for (int k = from; k < to; ++k) {
            const Real*    other = front + std::ptrdiff_t(k) * rows;
            Together<Real> here[kMany];
            for (int v = 0; v < kMany; ++v) here[v] = eightOf(other + row + v * kLanes);
            for (int n = 0; n < kColumns; ++n) {
                const Real factor = signs.of(k, other[c + n]);
                for (int v = 0; v < kMany; ++v) sums[n][v] -= factor * here[v];
            }
        }
        for (int n = 0; n < kColumns; ++n)
            for (int v = 0; v < kMany; ++v) store(column + std::ptrdiff_t(n) * rows + v * kLanes, sums[n][v]);
    };
    for (; row + kVectors * kLanes <= end; row += kVectors * kLanes) subtract.template operator()<kVectors>();
    for (; row < end; row += kLanes) subtract.template operator()<1>();
}

/// Does the same for up to four columns.
template <class Real, class Signs>
void subtractPanel(int columns, Real* front, int rows, int c, int before, int row, int end, const Signs& signs)
{
    constexpr int kNear = 64; // columns whose rows stay in the nearest cache
    for (int k = 0; k < before; k += kNear) {
        const int to = min(k + kNear, before);
        if (columns == 4)
            subtractColumns<4>(front, rows, c, k, to, row, end, signs);
        else
            for (int n = 0; n < columns; ++n) subtractColumns<1>(front, rows, c + n, k, to, row, end, signs);
    }
}

/// A front while it is factored.
template <class Real>
struct FrontAtWork {
    Real* numbers; ///< by columns, those of own unknowns first
    int   rows;    ///< of a column in memory, whole vectors
    int   own, all;
    int   ownEnd, borderEnd; ///< rows that own columns and those of the border have, whole vectors
};

/// Eliminates a front's own unknowns: with P = L S L', S the signs of the pivots, its own columns become L and B L^-'
/// S; what is left of C is at its end.
/// \param least    returns the size of a pivot of which rounding leaves nothing, by own unknown
/// \param inverse  becomes 1 / L of the diagonal, by own unknown, times its sign
/// \return whether rounding leaves something of each pivot
template <class Real, class Signs, class Least>
bool eliminate(const FrontAtWork<Real>& f, const Least& least, Real* inverse, const Signs& signs)
{
    constexpr int kPanel = 4; // columns that are subtracted from together
    int           width  = 0;
    for (int first = 0; first < f.all; first += width) {
        const bool isOwn = first < f.own;
        width            = min(kPanel, (isOwn ? f.own : f.all) - first);
        subtractPanel(width, f.numbers, f.rows, first, min(first, f.own), first / kLanes * kLanes,
                      isOwn ? f.ownEnd : f.borderEnd, signs);
        for (int c = first; isOwn && c < first + width; ++c) {
            Real*     column = f.numbers + std::ptrdiff_t(c) * f.rows;
            const int from   = c / kLanes * kLanes;
            subtractColumns<1>(f.numbers, f.rows, c, first, c, from, f.ownEnd, signs);
            const Real pivot = column[c];
            if (!(abs(pivot) > least(c)) || !signs.suits(c, double(pivot))) return false;
            inverse[c] = signs.of(c, Real(1) / sqrt(abs(pivot)));
            for (int row = from; row < f.ownEnd; row += kLanes) store(column + row, inverse[c] * eightOf(column + row));
        }
    }
    return true;
}

/// Adds what a front before it left of its border.
/// \param rows     of a column of `front`
/// \param localOf  rows of the border's unknowns in it
/// \param local    room for two rows of numbers, mostRows each
template <class Real>
void extendAdd(const int* border, const RimFront& from, const Real* left, const RimFront& f, int rows,
               const int* localOf, int* local, int mostRows, Real* front)
{
    const int  stride = from.borderRows;
    int* const ends   = local + mostRows; // of runs of neighbours
    for (int n = from.border - 1; n >= 0; --n) {
        local[n] = border[n] < f.first + f.own ? border[n] - f.first : localOf[border[n]];
        ends[n]  = n + 1 < from.border && local[n + 1] == local[n] + 1 ? ends[n + 1] : n + 1;
    }
    for (int c = 0; c < from.border; ++c) {
        Real*       column = front + std::ptrdiff_t(local[c]) * rows;
        const Real* own    = left + std::ptrdiff_t(c) * stride;
        for (int n = c; n < from.border; n = ends[n]) {
            Real* to = column + local[n];
#pragma GCC ivdep
            for (int m = n; m < ends[n]; ++m) to[m - n] += own[m];
        }
    }
}

/// What fronts left of their borders and no later one has taken yet, one above the other.
class Left {
public:
    struct One {
        int            front;
        std::ptrdiff_t at;
    };

    std::ptrdiff_t put(int n, const RimFront& f)
    {
        const std::ptrdiff_t at = height_;
        all_[count_++]          = {n, at};
        height_ += std::ptrdiff_t(f.borderRows) * f.border;
        return at;
    }
    One take()
    {
        height_ = all_[--count_].at;
        return all_[count_];
    }
    [[nodiscard]] std::ptrdiff_t height() const { return height_; }

private:
    One            all_[kMostOpenFronts + 1];
    int            count_  = 0;
    std::ptrdiff_t height_ = 0;
};

/// Returns how high they come to lie [numbers].
inline std::ptrdiff_t stackOf(const RimFront* fronts, int count)
{
    Left           left;
    std::ptrdiff_t most = 0;
    for (int n = 0; n < count; ++n) {
        if (!fronts[n].isLeaf) {
            left.take();
            left.take();
        }
        left.put(n, fronts[n]);
        most = max(most, left.height());
    }
    return most;
}

} // namespace palp::PALPATE_ISA
