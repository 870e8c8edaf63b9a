#include "engine/plate/host/fronts.h"
#include "engine/plate/host/shell_view.h"

// The factor of a whole shell in dense fronts, and its solves for eight loads. See
// engine/plate/multigrid/direct_shell.h. There is no shader for it.

namespace palp::PALPATE_ISA {

namespace {

/// Writes what the matrix has at a front's own columns.
void assemble(const ShellFronts& all, const RimFront& f, int rows, const int* localOf, double* front)
{
    const int end = f.first + f.own;
    for (int own = 0; own < f.own; ++own) {
        double* column = front + std::ptrdiff_t(own) * rows;
        for (std::ptrdiff_t n = all.starts[f.first + own]; n < all.starts[f.first + own + 1]; ++n) {
            const int row = all.rows[n];
            column[row < end ? row - f.first : localOf[row]] += all.values[n];
        }
    }
}

/// \return whether every pivot has its sign, and rounding leaves something of it
bool factorFronts(const ShellFronts& all)
{
    static thread_local Scratch<double> fronts, stacked, inverses;
    static thread_local Scratch<int>    locals;
    double* const                       front   = fronts.of(std::ptrdiff_t(all.mostRows) * all.mostRows);
    double* const                       inverse = inverses.of(all.mostRows);
    int* const                          localOf = locals.of(std::ptrdiff_t(all.unknowns) + 2 * all.mostRows);
    double* const                       stack   = stacked.of(stackOf(all.fronts, all.frontCount));

    Left left;
    for (int n = 0; n < all.frontCount; ++n) {
        const RimFront& f    = all.fronts[n];
        const int       rows = f.rowsTogether(), count = f.own + f.border;
        for (std::ptrdiff_t m = 0; m < std::ptrdiff_t(count) * rows; ++m) front[m] = 0;
        for (int m = 0; m < f.border; ++m) localOf[all.borders[f.borderAt + m]] = f.own + m;
        assemble(all, f, rows, localOf, front);
        if (!f.isLeaf)
            for (int half = 0; half < 2; ++half) {
                const auto      taken  = left.take();
                const RimFront& before = all.fronts[taken.front];
                extendAdd(all.borders + before.borderAt, before, stack + taken.at, f, rows, localOf,
                          localOf + all.unknowns, all.mostRows, front);
            }
        const double* diagonals = all.values;
        const auto least = [&](int c) { return double(kLeastPivotDouble) * abs(diagonals[all.starts[f.first + c]]); };
        if (!eliminate(FrontAtWork<double>{front, rows, f.own, count, rows, rows}, least, inverse,
                       GivenSigns{all.signs + f.first}))
            return false;
        double* to = all.columns + f.columnsAt;
        for (int c = 0; c < f.own; ++c) {
            for (int r = 0; r < rows; ++r)
                to[std::ptrdiff_t(c) * rows + r] = r < count ? front[std::ptrdiff_t(c) * rows + r] : 0;
            to[std::ptrdiff_t(c) * rows + c] = abs(inverse[c]);
        }
        to = stack + left.put(n, f);
        for (int c = 0; c < f.border; ++c)
            for (int r = c; r < f.border; ++r)
                to[std::ptrdiff_t(c) * f.borderRows + r] = front[std::ptrdiff_t(f.own + c) * rows + f.own + r];
    }
    return true;
}

using Eight = Together<double>;

/// Solves L y = x for a front's own numbers, and subtracts what they leave of its border's.
void forwardFront(const RimFront& f, const double* columns, Eight* y)
{
    constexpr int        kPanel = 4;
    const std::ptrdiff_t rows   = f.rowsTogether();
    const int            count  = f.own + f.border;
    for (int first = 0; first < f.own; first += kPanel) {
        const int     end = min(first + kPanel, f.own);
        const double* c   = columns + first * rows;
        for (int k = first; k < end; ++k) {
            const double* own = columns + k * rows;
            y[k] *= own[k];
            for (int r = k + 1; r < end; ++r) y[r] -= own[r] * y[k];
        }
        if (end == first + kPanel)
            for (int r = end; r < count; ++r)
                y[r] -= (c[r] * y[first] + c[rows + r] * y[first + 1]) +
                        (c[2 * rows + r] * y[first + 2] + c[3 * rows + r] * y[first + 3]);
        else
            for (int k = first; k < end; ++k)
                for (int r = end; r < count; ++r) y[r] -= columns[k * rows + r] * y[k];
    }
}

/// Solves L' x = y for a front's own numbers, where its border's are known.
void backwardFront(const RimFront& f, const double* columns, Eight* y)
{
    constexpr int        kPanel = 4;
    const std::ptrdiff_t rows   = f.rowsTogether();
    const int            count  = f.own + f.border;
    for (int first = (f.own - 1) / kPanel * kPanel; first >= 0; first -= kPanel) {
        const int     end = min(first + kPanel, f.own);
        const double* c   = columns + first * rows;
        if (end == first + kPanel)
            for (int r = end; r < count; ++r)
                for (int n = 0; n < kPanel; ++n) y[first + n] -= c[n * rows + r] * y[r];
        else
            for (int k = first; k < end; ++k)
                for (int r = end; r < count; ++r) y[k] -= columns[k * rows + r] * y[r];
        for (int k = end - 1; k >= first; --k) {
            const double* own = columns + k * rows;
            for (int r = k + 1; r < end; ++r) y[k] -= own[r] * y[r];
            y[k] *= own[k];
        }
    }
}

/// Solves for all unknowns x in place.
void solveFronts(const ShellFronts& all, Eight* x)
{
    static thread_local Scratch<Eight> scratch;
    Eight* const                       y    = scratch.of(all.mostRows);
    const auto                         take = [&](const RimFront& f) {
        for (int m = 0; m < f.own; ++m) y[m] = x[f.first + m];
        for (int m = 0; m < f.border; ++m) y[f.own + m] = x[all.borders[f.borderAt + m]];
    };
    // A load presses on a few fronts: the forward half is that of these and of those that they leave something of.
    const auto isZero = [&](const RimFront& f) {
        for (int m = 0; m < f.own; ++m)
            for (int lane = 0; lane < kLanes; ++lane)
                if (x[f.first + m][lane] != 0) return false;
        return true;
    };
    for (int n = 0; n < all.frontCount; ++n) {
        const RimFront& f = all.fronts[n];
        if (isZero(f)) continue;
        take(f);
        forwardFront(f, all.columns + f.columnsAt, y);
        for (int m = 0; m < f.own; ++m) x[f.first + m] = all.signs[f.first + m] * y[m];
        for (int m = 0; m < f.border; ++m) x[all.borders[f.borderAt + m]] = y[f.own + m];
    }
    for (int n = all.frontCount - 1; n >= 0; --n) {
        const RimFront& f = all.fronts[n];
        take(f);
        backwardFront(f, all.columns + f.columnsAt, y);
        for (int m = 0; m < f.own; ++m) x[f.first + m] = y[m];
    }
}

} // namespace

void shellFrontFactor(const HostDispatch& d)
{
    *bound<uint>(d, 1) = factorFronts(*bound<const ShellFronts>(d, 0)) ? 0U : 1U;
}

void shellFrontSolve(const HostDispatch& d)
{
    solveFronts(*bound<const ShellFronts>(d, 0), bound<Eight>(d, 1));
}

} // namespace palp::PALPATE_ISA
