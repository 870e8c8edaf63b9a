#include "engine/plate/host/fronts.h"
#include "engine/plate/host/operator_rows.h"
#include "engine/plate/host/tile_runs.h"

// The exact correction at the rims of inclusions: a sparse factor in dense fronts, and its solves. See
// engine/plate/multigrid/detail/rim.h. There is no shader for it.

namespace palp::PALPATE_ISA {

void rimEntries(const PlateLevel& g, const float* D, const RimView& rim, float* to);
void rimEntries(const PlateLevel& g, const float* D, const RimView& rim, double* to);

namespace {

/// A front while it is factored: rows of its own unknowns and its border, then as many rows as own ones for P^-1.
struct Workplace {
    int upper; ///< rows of the first kind, whole vectors
    int rows;  ///< of both

    explicit Workplace(const RimFront& f)
        : upper((f.own + f.border + kLanes - 1) / kLanes * kLanes), rows(upper + f.ownRows)
    {
    }
};

constexpr int kSlots = 8; ///< of a node in the list of entries: the diagonal, those before it, nothing

/// Eliminates a front's own unknowns: P = L L', B L^-' and, in the rows below, L^-'; what is left of C is at its end.
/// \param entries  of all unknowns
/// \return whether rounding leaves something of each pivot
template <class Real>
bool eliminate(const RimFront& f, const Real* entries, Real* front, Real* inverse)
{
    const Real      doubtful = Real(sizeof(Real) == sizeof(double) ? kLeastPivotDouble : kDoubtfulPivot);
    const Workplace at(f);
    for (int c = 0; c < f.own; ++c) front[std::ptrdiff_t(c) * at.rows + at.upper + c] = Real(1);
    return eliminate(
        FrontAtWork<Real>{front, at.rows, f.own, f.own + f.border, at.rows, at.upper},
        [=](int c) { return doubtful * entries[std::ptrdiff_t(f.first + c) * kSlots]; }, inverse, AllPositive());
}

/// Divides what B and the unit matrix are in column k by L', in kVectors vectors from a row on; later columns are done.
template <int kVectors, class Real>
void divideColumn(const RimFront& f, const Real* from, Real inverse, int k, int row, Real* columns)
{
    const std::ptrdiff_t rows = f.rows();
    Real*                to   = columns + k * rows + row;
    Together<Real>       sums[kVectors];
    for (int v = 0; v < kVectors; ++v) sums[v] = eightOf(to + v * kLanes);
    for (int m = k + 1; m < f.own; ++m) {
        const Real* other = columns + m * rows + row;
        for (int v = 0; v < kVectors; ++v) sums[v] -= from[m] * eightOf(other + v * kLanes);
    }
    for (int v = 0; v < kVectors; ++v) store(to + v * kLanes, inverse * sums[v]);
}

/// Writes B P^-1 and P^-1 from what eliminate() left.
template <class Real>
void keepColumns(const RimFront& f, const Real* front, const Real* inverse, Real* columns)
{
    const Workplace at(f);
    const int       rows = f.rows();
    for (int k = f.own - 1; k >= 0; --k) {
        const Real* from = front + std::ptrdiff_t(k) * at.rows;
        Real*       to   = columns + std::ptrdiff_t(k) * rows;
        for (int r = 0; r < f.borderRows; ++r) to[r] = r < f.border ? from[f.own + r] : Real(0);
        for (int r = 0; r < f.ownRows; ++r) to[f.borderRows + r] = from[at.upper + r];
        int row = 0;
        for (; row + 4 * kLanes <= rows; row += 4 * kLanes) divideColumn<4>(f, from, inverse[k], k, row, columns);
        for (; row < rows; row += kLanes) divideColumn<1>(f, from, inverse[k], k, row, columns);
    }
    // Rounding must leave P^-1 symmetric, or the cycle would not be.
    for (int k = 0; k < f.own; ++k)
        for (int r = 0; r < k; ++r)
            columns[std::ptrdiff_t(k) * rows + f.borderRows + r] = columns[std::ptrdiff_t(r) * rows + f.borderRows + k];
}

constexpr int kBefore[6][2] = {{0, -1}, {0, -2}, {-1, -1}, {-1, 0}, {-1, 1}, {-2, 0}};

/// Writes what the matrix has at a front's own columns.
template <class Real>
void assemble(const PlateLevel& g, const RimView& rim, const RimFront& f, const Real* entries, const int* localOf,
              Real* front)
{
    const int nodes = g.cellsZ + 1, rows = Workplace(f).rows;
    for (int own = 0; own < f.own; ++own) {
        const int unknown = f.first + own, node = rim.nodes[unknown], i = node / nodes, j = node % nodes;
        Real*     column = front + std::ptrdiff_t(own) * rows;
        column[own]      = entries[std::ptrdiff_t(unknown) * kSlots];
        for (int n = 0; n < 6; ++n)
            for (int sign : {1, -1}) {
                const int a = i + sign * kBefore[n][0], b = j + sign * kBefore[n][1];
                if (a < 0 || b < 0 || a > g.cellsX || b > g.cellsZ) continue;
                const int other = rim.numbers[a * nodes + b];
                if (other < unknown) continue; // not of the rim, or another column's
                const int later                                                    = sign > 0 ? unknown : other;
                column[other < f.first + f.own ? other - f.first : localOf[other]] = entries[later * kSlots + 1 + n];
            }
    }
}

/// \return whether rounding leaves something of each pivot
template <class Real>
bool factorRim(const PlateLevel& g, const float* D, const RimView& rim)
{
    static thread_local Scratch<Real> listed, fronts, stacked, inverses;
    static thread_local Scratch<int>  locals;
    Real* const                       entries = listed.of(std::ptrdiff_t(rim.unknowns) * kSlots);
    Real* const                       front   = fronts.of(2 * std::ptrdiff_t(rim.mostRows) * rim.mostRows);
    Real* const                       inverse = inverses.of(rim.mostRows);
    int* const                        localOf = locals.of(std::ptrdiff_t(rim.unknowns) + 2 * rim.mostRows);
    Real* const                       stack   = stacked.of(stackOf(rim.fronts, rim.frontCount));
    rimEntries(g, D, rim, entries);

    Left left;
    for (int n = 0; n < rim.frontCount; ++n) {
        const RimFront& f = rim.fronts[n];
        const Workplace at(f);
        for (std::ptrdiff_t m = 0; m < std::ptrdiff_t(f.own + f.border) * at.rows; ++m) front[m] = Real(0);
        for (int m = 0; m < f.border; ++m) localOf[rim.borders[f.borderAt + m]] = f.own + m;
        assemble(g, rim, f, entries, localOf, front);
        if (!f.isLeaf)
            for (int half = 0; half < 2; ++half) {
                const auto      taken  = left.take();
                const RimFront& before = rim.fronts[taken.front];
                extendAdd(rim.borders + before.borderAt, before, stack + taken.at, f, at.rows, localOf,
                          localOf + rim.unknowns, rim.mostRows, front);
            }
        if (!eliminate(f, entries, front, inverse)) return false;
        keepColumns(f, front, inverse, static_cast<Real*>(rim.columns) + f.columnsAt);
        Real* to = stack + left.put(n, f);
        for (int c = 0; c < f.border; ++c)
            for (int r = c; r < f.border; ++r)
                to[std::ptrdiff_t(c) * f.borderRows + r] = front[std::ptrdiff_t(f.own + c) * at.rows + f.own + r];
    }
    return true;
}

template <class Real>
Real sumOf(const Together<Real>& v)
{
    return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

/// Subtracts B P^-1 y from the border's numbers, four columns at a time.
/// \param y  the border's numbers, then the front's own; both followed by zeros
template <class Real>
void forwardFront(const RimFront& f, const Real* columns, Real* y)
{
    const std::ptrdiff_t rows = f.rows();
    const Real*          own  = y + f.borderRows;
    int                  k    = 0;
    for (; k + 4 <= f.own; k += 4) {
        const Real* c = columns + k * rows;
        for (int r = 0; r < f.borderRows; r += kLanes)
            store(y + r,
                  eightOf(y + r) - ((own[k] * eightOf(c + r) + own[k + 1] * eightOf(c + rows + r)) +
                                    (own[k + 2] * eightOf(c + 2 * rows + r) + own[k + 3] * eightOf(c + 3 * rows + r))));
    }
    for (; k < f.own; ++k)
        for (int r = 0; r < f.borderRows; r += kLanes)
            store(y + r, eightOf(y + r) - own[k] * eightOf(columns + k * rows + r));
}

/// Computes the front's own numbers, P^-1 y - (B P^-1)' x.
/// \param y  -x of the border, then y of the front; both followed by zeros
template <class Real>
void backwardFront(const RimFront& f, const Real* columns, const Real* y, Real* x)
{
    const std::ptrdiff_t rows = f.rows();
    int                  k    = 0;
    for (; k + 4 <= f.own; k += 4) {
        const Real*    c = columns + k * rows;
        Together<Real> sums[4];
        for (auto& sum : sums) sum = Together<Real>(Real(0));
        for (int r = 0; r < rows; r += kLanes) {
            const Together<Real> here = eightOf(y + r);
            for (int n = 0; n < 4; ++n) sums[n] += eightOf(c + n * rows + r) * here;
        }
        for (int n = 0; n < 4; ++n) x[k + n] = sumOf(sums[n]);
    }
    for (; k < f.own; ++k) {
        Together<Real> sum(Real(0));
        for (int r = 0; r < rows; r += kLanes) sum += eightOf(columns + k * rows + r) * eightOf(y + r);
        x[k] = sumOf(sum);
    }
}

/// The same for loads side by side, row by row; the sums of a column are the same eight.
template <class Real>
void forwardFront(const RimFront& f, const Real* columns, Together<Real>* y)
{
    const std::ptrdiff_t  rows = f.rows();
    const Together<Real>* own  = y + f.borderRows;
    int                   k    = 0;
    for (; k + 4 <= f.own; k += 4) {
        const Real* c = columns + k * rows;
        for (int r = 0; r < f.border; ++r)
            y[r] -= (c[r] * own[k] + c[rows + r] * own[k + 1]) +
                    (c[2 * rows + r] * own[k + 2] + c[3 * rows + r] * own[k + 3]);
    }
    for (; k < f.own; ++k)
        for (int r = 0; r < f.border; ++r) y[r] -= columns[k * rows + r] * own[k];
}

template <class Real>
void backwardFront(const RimFront& f, const Real* columns, const Together<Real>* y, Together<Real>* x)
{
    const std::ptrdiff_t rows = f.rows();
    for (int k = 0; k < f.own; ++k) {
        Together<Real> v[kLanes];
        for (auto& sum : v) sum = Together<Real>(Real(0));
        for (int r = 0; r < rows; r += kLanes)
            for (int n = 0; n < kLanes; ++n) v[n] += columns[k * rows + r + n] * y[r + n];
        x[k] = ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
    }
}

/// Solves for all unknowns x in place.
/// \param needed  by front: those that have a force, and all that hold their borders; the others' x mean nothing.
///                Null: all fronts
template <class Real, class At>
void solveRim(const RimView& rim, At* x, At* y, const std::uint8_t* needed = nullptr)
{
    const auto* all = static_cast<const Real*>(rim.columns);
    for (int n = 0; n < rim.frontCount; ++n) {
        if (needed && !needed[n]) continue;
        const RimFront& f      = rim.fronts[n];
        const int*      border = rim.borders + f.borderAt;
        At* const       own    = y + f.borderRows;
        for (int m = 0; m < f.border; ++m) y[m] = x[border[m]];
        for (int m = 0; m < f.own; ++m) own[m] = x[f.first + m];
        forwardFront(f, all + f.columnsAt, y);
        for (int m = 0; m < f.border; ++m) x[border[m]] = y[m];
    }
    for (int n = rim.frontCount - 1; n >= 0; --n) {
        if (needed && !needed[n]) continue;
        const RimFront& f      = rim.fronts[n];
        const int*      border = rim.borders + f.borderAt;
        At* const       own    = y + f.borderRows;
        for (int m = 0; m < f.border; ++m) y[m] = At(Real(0)) - x[border[m]];
        for (int m = f.border; m < f.borderRows; ++m) y[m] = At(Real(0));
        for (int m = 0; m < f.own; ++m) own[m] = x[f.first + m];
        for (int m = f.own; m < f.ownRows; ++m) own[m] = At(Real(0));
        backwardFront(f, all + f.columnsAt, y, x + f.first);
    }
}

/// Calls add(node, x) with the solution for given(node) at each node of the rim.
template <class Real, class Given, class Add>
void correctRim(const RimView& rim, const Given& given, const Add& add)
{
    const auto by = [&]<class Factor>(Factor) {
        using At = AsMany<Factor, Real>;
        static thread_local Scratch<At> scratch;
        At* const                       x = scratch.of(std::ptrdiff_t(rim.unknowns) + rim.mostRows);
        for (int n = 0; n < rim.unknowns; ++n) x[n] = At(given(rim.nodes[n]));
        solveRim<Factor>(rim, x, x + rim.unknowns);
        for (int n = 0; n < rim.unknowns; ++n) add(rim.nodes[n], x[n]);
    };
    if (rim.doubles)
        by(double());
    else
        by(float());
}

template <class Real>
void rimFirstOf(const HostDispatch& d)
{
    const PlateLevel& g   = pushed<LevelPush>(d).level;
    const RimView&    rim = *bound<const RimView>(d, 0);
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load) {
        const Real* force = bound<const Real>(d, 1) + load * nodesOf(g);
        Real*       w     = bound<Real>(d, 2) + load * nodesOf(g);
        for (std::ptrdiff_t n = 0; n < nodesOf(g); ++n) w[n] = Real(NumberOf<Real>(0));
        correctRim<Real>(
            rim, [=](int node) { return force[node]; }, [=](int node, const auto& x) { w[node] = Real(x); });
    }
}

template <class Real>
void rimLastOf(const HostDispatch& d)
{
    const PlateLevel& g     = pushed<LevelPush>(d).level;
    const RimView&    rim   = *bound<const RimView>(d, 0);
    const auto*       D     = bound<const float>(d, 1);
    const int         nodes = g.cellsZ + 1;
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load) {
        const Real* force = bound<const Real>(d, 2) + load * nodesOf(g);
        Real*       w     = bound<Real>(d, 3) + load * nodesOf(g);
        Real*       left  = bound<Real>(d, 4) + load * nodesOf(g);
        forEachTileRun(g, rim.tiles + 1, rim.tiles[0], [&](int i, int lastI, ColumnRange columns) {
            PlainField<Real>                     field{w, nodes};
            OperatorRows<Real, PlainField<Real>> rows(g, D, field, i, columns);
            for (; i <= lastI; ++i) {
                const Real* f  = force + std::ptrdiff_t(i) * nodes;
                Real*       to = left + std::ptrdiff_t(i) * nodes;
                rows.next(i, RowTo{[=](int j, const Real& a) { return f[j] - a; },
                                   [=](int j, const Real& value) { to[j] = value; }});
            }
        });
        correctRim<Real>(
            rim, [=](int node) { return left[node]; }, [=](int node, const auto& x) { w[node] += Real(x); });
    }
}

template <class Real>
void rimStartOf(const HostDispatch& d)
{
    const PlateLevel& g   = pushed<LevelPush>(d).level;
    const RimView&    rim = *bound<const RimView>(d, 0);
    for (std::ptrdiff_t load = 0; load < fieldsOf<Real>(d); ++load) {
        const Real* left   = bound<const Real>(d, 1) + load * nodesOf(g);
        Real*       answer = bound<Real>(d, 2) + load * nodesOf(g);
        correctRim<Real>(
            rim, [=](int node) { return left[node]; }, [=](int node, const auto& x) { answer[node] += Real(x); });
    }
}

template <class At>
void rimSolveOf(const HostDispatch& d)
{
    static thread_local Scratch<At> scratch;
    const RimView&                  rim = *bound<const RimView>(d, 0);
    solveRim<double>(rim, bound<At>(d, 1), scratch.of(rim.mostRows), bound<const std::uint8_t>(d, 2));
}

} // namespace

void rimFactor(const HostDispatch& d)
{
    const PlateLevel& g   = pushed<LevelPush>(d).level;
    const RimView&    rim = *bound<const RimView>(d, 0);
    const auto*       D   = bound<const float>(d, 1);
    *bound<uint>(d, 2)    = (rim.doubles ? factorRim<double>(g, D, rim) : factorRim<float>(g, D, rim)) ? 0U : 1U;
}

PALPATE_ALONE_AND_TOGETHER(rimFirst, float)
PALPATE_ALONE_AND_TOGETHER(rimLast, float)
PALPATE_REALS_ALONE_AND_TOGETHER(rimStart)
PALPATE_ALONE_AND_TOGETHER(rimSolve, double)

} // namespace palp::PALPATE_ISA
