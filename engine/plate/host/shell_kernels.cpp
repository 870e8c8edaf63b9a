#include <type_traits>

#include "engine/plate/host/shell_view.h"
#include "engine/plate/host/together.h"

// The cycle and the gradients of shells: two fields, relaxed together. See
// engine/plate/multigrid/multigrid_shell_solver.h. The shaders of shells (compute_shaders/shell_*.comp)
// do the same in the same order.
//
// All arithmetic is in vectors of eight numbers, of eight nodes or of eight loads, in one order: the bits are the same
// on every instruction set, though one load alone has other ones than among eight.

namespace palp::PALPATE_ISA {
namespace {

constexpr int kLanes = kLoadsTogether;

/// Eight numbers in the precision of the arithmetic.
template <class Real, class Stored>
[[gnu::always_inline]] inline Together<Real> read(const Stored* from)
{
    if constexpr (sizeof(Real) == sizeof(Stored))
        return eightOf(from);
    else
        return Together<Real>(eightOf(from));
}

/// Numbers at a node: of one load or eight.
constexpr int loadsOf(bool together)
{
    return together ? kLanes : 1;
}

std::ptrdiff_t rowOfFields(const ShellLayout& l)
{
    return std::ptrdiff_t(4) * l.span;
}

/// Returns the place of the n-th node of a row among those of its row.
int placeOf(int n, int span)
{
    return (n & 1) * span + (n >> 1);
}

/// How many nodes of a row have an index of that parity.
int countOf(int cells, int parity)
{
    return (cells - parity) / 2 + 1;
}

/// A layout's span that a compiler knows, so that all places of a stencil are a fixed way from its node; 0: it does
/// not.
template <int kSpan>
struct KnownSpan {
};

/// Calls call(KnownSpan) with the spans of the levels of usual grids, of 32, 64 and 128 cells.
template <class Call>
void bySpan(int span, const Call& call)
{
    switch (span) {
    case 24:
        return call(KnownSpan<24>{});
    case 40:
        return call(KnownSpan<40>{});
    case 72:
        return call(KnownSpan<72>{});
    default:
        return call(KnownSpan<0>{});
    }
}

/// What a part of memory says of the nodes of one parity in a row.
///
/// \tparam kSpan  see KnownSpan
/// \tparam kOdd   of their index along z
/// \tparam Real   of the arithmetic; coefficients and fields are stored as they are
template <int kSpan, bool kTogether, int kOdd, class Real, class Entry, class Stored>
struct RowOfShell {
    static constexpr int kLoads = loadsOf(kTogether);
    using Values                = Together<Real>;

    const Entry*   entries; ///< of the row, plane 0, this parity
    const Stored*  fields;  ///< of the row, w, this parity
    std::ptrdiff_t anySpan;

    RowOfShell(const ShellLayout& l, const Entry* allEntries, const Stored* allFields, int i)
        : entries(allEntries + (std::ptrdiff_t(i + kShellRim) * kShellPlanes * 2 + kOdd) * l.span),
          fields(allFields + (std::ptrdiff_t(i + kShellRim) * 4 + kOdd) * l.span * kLoads), anySpan(l.span)
    {
    }

    [[gnu::always_inline]] [[nodiscard]] std::ptrdiff_t span() const { return kSpan > 0 ? kSpan : anySpan; }

    /// Returns how far a neighbour lies from a node in its row of places.
    [[gnu::always_inline]] [[nodiscard]] std::ptrdiff_t along(int dj) const
    {
        if (dj % 2 == 0) return dj / 2;
        return (kOdd ? -span() : span()) + (dj < 0 ? kOdd - 1 : kOdd);
    }

    [[gnu::always_inline]] [[nodiscard]] Values field(int which, int di, int dj, std::ptrdiff_t m) const
    {
        return read<Real>(fields + ((std::ptrdiff_t(di) * 4 + which * 2) * span() + along(dj) + m) * kLoads);
    }
    [[gnu::always_inline]] [[nodiscard]] auto entry(int plane, int di, int dj, std::ptrdiff_t m) const
    {
        const Entry* at = entries + (std::ptrdiff_t(di) * kShellPlanes + plane) * 2 * span() + along(dj) + m;
        if constexpr (kTogether)
            return Real(*at);
        else
            return read<Real>(at);
    }

    /// A of a field, or C, by changes from the node.
    [[gnu::always_inline]] [[nodiscard]] Values own(int plane, const Values (&near)[8], const Values (&far)[4],
                                                    std::ptrdiff_t m) const
    {
        Values sum = entry(plane + kBendEast, 0, 0, m) * near[0] + entry(plane + kBendEast, -1, 0, m) * near[1];
        sum += entry(plane + kBendNorth, 0, 0, m) * near[2] + entry(plane + kBendNorth, 0, -1, m) * near[3];
        sum += entry(plane + kBendNorthEast, 0, 0, m) * near[4] + entry(plane + kBendSouthEast, -1, 1, m) * near[5];
        sum += entry(plane + kBendSouthEast, 0, 0, m) * near[6] + entry(plane + kBendNorthEast, -1, -1, m) * near[7];
        sum += entry(plane + kBendEast2, 0, 0, m) * far[0] + entry(plane + kBendEast2, -2, 0, m) * far[1];
        sum += entry(plane + kBendNorth2, 0, 0, m) * far[2] + entry(plane + kBendNorth2, 0, -2, m) * far[3];
        return sum;
    }

    /// Changes of a field to the neighbours: east, west, north, south, north-east, north-west, south-east, south-west.
    [[gnu::always_inline]] void changes(int which, const Values& here, std::ptrdiff_t m, Values (&near)[8],
                                        Values (&far)[4]) const
    {
        constexpr int kNear[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
        constexpr int kFar[4][2]  = {{2, 0}, {-2, 0}, {0, 2}, {0, -2}};
        for (int n = 0; n < 8; ++n) near[n] = field(which, kNear[n][0], kNear[n][1], m) - here;
        for (int n = 0; n < 4; ++n) far[n] = field(which, kFar[n][0], kFar[n][1], m) - here;
    }

    /// K x at a node: A w + B phi, and B' w - C phi.
    [[gnu::always_inline]] void apply(std::ptrdiff_t m, Values& ofW, Values& ofF) const
    {
        const Values w = field(0, 0, 0, m), f = field(1, 0, 0, m);
        Values       near[8], far[4];
        changes(0, w, m, near, far);
        ofW = own(kBendEast, near, far, m) + entry(kBed, 0, 0, m) * w;
        ofF = entry(kCoupleWest, 1, 0, m) * near[0] + entry(kCoupleEast, -1, 0, m) * near[1];
        ofF += entry(kCoupleSouth, 0, 1, m) * near[2] + entry(kCoupleNorth, 0, -1, m) * near[3];
        ofF += entry(kCoupleSouthWest, 1, 1, m) * near[4] + entry(kCoupleSouthEast, -1, 1, m) * near[5];
        ofF += entry(kCoupleNorthWest, 1, -1, m) * near[6] + entry(kCoupleNorthEast, -1, -1, m) * near[7];
        ofF += entry(kColumnSum, 0, 0, m) * w;
        changes(1, f, m, near, far);
        ofF -= own(kStressEast, near, far, m) + entry(kStressBed, 0, 0, m) * f;
        ofW += entry(kCoupleEast, 0, 0, m) * near[0] + entry(kCoupleWest, 0, 0, m) * near[1];
        ofW += entry(kCoupleNorth, 0, 0, m) * near[2] + entry(kCoupleSouth, 0, 0, m) * near[3];
        ofW += entry(kCoupleNorthEast, 0, 0, m) * near[4] + entry(kCoupleNorthWest, 0, 0, m) * near[5];
        ofW += entry(kCoupleSouthEast, 0, 0, m) * near[6] + entry(kCoupleSouthWest, 0, 0, m) * near[7];
    }
};

/// Calls visit(m) for the places of a row's nodes of one parity, as many at a time as are computed together.
template <bool kTogether, class Visit>
[[gnu::always_inline]] inline void eachPlace(int cells, int odd, Visit&& visit)
{
    const int count = countOf(cells, odd);
    for (int m = 0; m < count; m += kTogether ? 1 : kLanes) visit(std::ptrdiff_t(m));
}

// The residual b - K x, or without b the product K x.

/// What applyRow does with the results besides.
struct NoSums {
    template <class Stored>
    void add(const Together<Stored>&, const Stored*, const Stored*)
    {
    }
};
/// Sums of x and of the right side times what comes out, so that memory is not gone over again.
struct ProductSums {
    Together<double> ofX{0.0}, ofRight{0.0}; ///< results times x; x times the right side, if there is one

    [[gnu::always_inline]] void add(const Together<float>& result, const float* x, const float* b)
    {
        const Together<double> at(eightOf(x));
        ofX += at * Together<double>(result);
        if (b) ofRight += at * Together<double>(eightOf(b));
    }
};

/// Adds x K x of a row's nodes of one parity, of eight loads, by K in floats.
template <int kSpan, int kOdd>
void addSteepness(const ShellLayout& l, const float* entries, const float* x, int i, Together<double>& sums)
{
    const RowOfShell<kSpan, true, kOdd, float, float, float> row(l, entries, x, i);
    const std::ptrdiff_t                                     other = std::ptrdiff_t(2) * l.span * kLanes;
    eachPlace<true>(l.cellsZ, kOdd, [&](std::ptrdiff_t m) {
        Together<float> w, f;
        row.apply(m, w, f);
        const float* at = row.fields + m * kLanes;
        sums += Together<double>(eightOf(at)) * Together<double>(w) +
                Together<double>(eightOf(at + other)) * Together<double>(f);
    });
}

template <int kSpan, bool kTogether, int kOdd, class Real, class Entry, class Stored, class Sums>
void applyRow(const ShellLayout& l, const Entry* entries, const Stored* b, const Stored* x, Stored* to, int i,
              Sums& sums)
{
    constexpr int                                                 kLoads = loadsOf(kTogether);
    const RowOfShell<kSpan, kTogether, kOdd, Real, Entry, Stored> row(l, entries, x, i);
    const std::ptrdiff_t at = row.fields - x, other = std::ptrdiff_t(2) * l.span * kLoads;
    eachPlace<kTogether>(l.cellsZ, kOdd, [&](std::ptrdiff_t m) {
        Together<Real> w, f;
        row.apply(m, w, f);
        const std::ptrdiff_t ofW = at + m * kLoads, ofF = ofW + other;
        if (b) {
            w = read<Real>(b + ofW) - w;
            f = read<Real>(b + ofF) - f;
        }
        const Together<Stored> storedW(w), storedF(f);
        store(to + ofW, storedW);
        store(to + ofF, storedF);
        sums.add(storedW, x + ofW, b ? b + ofW : nullptr);
        sums.add(storedF, x + ofF, b ? b + ofF : nullptr);
    });
}

template <bool kTogether, class Real, class Entry, class Stored, class Sums = NoSums>
Sums applyAll(const HostDispatch& d, const Stored* b, int fieldsFrom)
{
    const ShellLayout& l       = pushed<ShellPush>(d).layout;
    const Entry*       entries = bound<const Entry>(d, 0);
    const Stored*      x       = bound<const Stored>(d, fieldsFrom);
    Stored*            to      = bound<Stored>(d, fieldsFrom + 1);
    Sums               sums;
    bySpan(l.span, [&]<int kSpan>(KnownSpan<kSpan>) {
        for (int i = 0; i <= l.cellsX; ++i) {
            applyRow<kSpan, kTogether, 0, Real>(l, entries, b, x, to, i, sums);
            applyRow<kSpan, kTogether, 1, Real>(l, entries, b, x, to, i, sums);
        }
    });
    return sums;
}

// Relaxation of one colour. Nodes of the same colour count with their values from before: changes wait until no row
// that is still to come needs what was.

template <int kSpan, bool kTogether, int kOdd>
void relaxRow(const ShellLayout& l, const float* entries, const float* b, const float* x, float* changes, int i)
{
    constexpr int                                                 kLoads = loadsOf(kTogether);
    const RowOfShell<kSpan, kTogether, kOdd, float, float, float> row(l, entries, x, i);
    const std::ptrdiff_t at = row.fields - x, other = std::ptrdiff_t(2) * l.span * kLoads;
    eachPlace<kTogether>(l.cellsZ, kOdd, [&](std::ptrdiff_t m) {
        Together<float> w, f;
        row.apply(m, w, f);
        const std::ptrdiff_t place = at + m * kLoads;
        w                          = eightOf(b + place) - w;
        f                          = eightOf(b + place + other) - f;
        const auto ww = row.entry(kInverseW, 0, 0, m), wf = row.entry(kInverseWF, 0, 0, m),
                   ff = row.entry(kInverseF, 0, 0, m);
        store(changes + m * kLoads, ww * w + wf * f);
        store(changes + m * kLoads + std::ptrdiff_t(l.span) * kLoads, wf * w + ff * f);
    });
}

template <bool kTogether>
void addChanges(const ShellLayout& l, const float* changes, float* x, int i, int odd)
{
    constexpr int kLoads = loadsOf(kTogether);
    float*        w      = x + (std::ptrdiff_t(i + kShellRim) * 4 + odd) * l.span * kLoads;
    eachPlace<kTogether>(l.cellsZ, odd, [&](std::ptrdiff_t m) {
        float *atW = w + m * kLoads, *atF = atW + std::ptrdiff_t(2) * l.span * kLoads;
        store(atW, eightOf(atW) + eightOf(changes + m * kLoads));
        store(atF, eightOf(atF) + eightOf(changes + (m + l.span) * kLoads));
    });
}

/// Sets the fields to what the first half sweep makes of zeros.
template <int kSpan, bool kTogether, int kOdd>
void relaxZeros(const ShellLayout& l, const float* entries, const float* b, float* x, int i)
{
    constexpr int                                                 kLoads = loadsOf(kTogether);
    const RowOfShell<kSpan, kTogether, kOdd, float, float, float> row(l, entries, x, i);
    const std::ptrdiff_t at = row.fields - x, other = std::ptrdiff_t(2) * l.span * kLoads;
    eachPlace<kTogether>(l.cellsZ, kOdd, [&](std::ptrdiff_t m) {
        const std::ptrdiff_t place = at + m * kLoads;
        const auto           w = eightOf(b + place), f = eightOf(b + place + other);
        const auto           ww = row.entry(kInverseW, 0, 0, m), wf = row.entry(kInverseWF, 0, 0, m),
                   ff = row.entry(kInverseF, 0, 0, m);
        store(x + place, ww * w + wf * f);
        store(x + place + other, wf * w + ff * f);
    });
    float* const zeros = x + (std::ptrdiff_t(i + kShellRim) * 4 + (1 - kOdd)) * l.span * kLoads;
    for (int field = 0; field < 2; ++field)
        for (std::ptrdiff_t n = 0; n < std::ptrdiff_t(l.span) * kLoads; ++n) zeros[field * other + n] = 0;
}

/// One half sweep of relaxation, row by row.
template <int kSpan, bool kTogether>
struct HalfSweep {
    static constexpr int kWaiting = kShellRim + 1; ///< rows of changes

    const ShellLayout& l;
    const float *      entries, *b;
    float*             x;
    float*             changes;
    int                colour;
    bool               fromZero;

    [[nodiscard]] static std::ptrdiff_t rowOfChanges(const ShellLayout& l)
    {
        return std::ptrdiff_t(2) * l.span * loadsOf(kTogether);
    }
    [[nodiscard]] float* waiting(int i) const { return changes + i % kWaiting * rowOfChanges(l); }

    /// Computes row i, and changes the row that no later one needs as it was.
    void advance(int i) const
    {
        const int odd = (i + colour) & 1, done = i - kShellRim;
        if (i < 0 || done > l.cellsX) return;
        if (i <= l.cellsX) {
            if (fromZero)
                odd ? relaxZeros<kSpan, kTogether, 1>(l, entries, b, x, i)
                    : relaxZeros<kSpan, kTogether, 0>(l, entries, b, x, i);
            else
                odd ? relaxRow<kSpan, kTogether, 1>(l, entries, b, x, waiting(i), i)
                    : relaxRow<kSpan, kTogether, 0>(l, entries, b, x, waiting(i), i);
        }
        if (!fromZero && done >= 0) addChanges<kTogether>(l, waiting(done), x, done, odd);
    }
};

// All half sweeps, and the residual behind them if it is wanted, go over the rows at once, each some rows behind the
// one before: a level is read from memory once and not five times. The numbers are those of one after the other.
template <int kSpan, bool kTogether>
void smoothKnown(const HostDispatch& d)
{
    using Sweep           = HalfSweep<kSpan, kTogether>;
    constexpr int kBehind = 2 * kShellRim; // rows that a half sweep reads, and changes, to one side
    static thread_local Scratch<float> scratch;
    const ShellPush&                   push    = pushed<ShellPush>(d);
    const ShellLayout&                 l       = push.layout;
    const float *                      entries = bound<const float>(d, 0), *b = bound<const float>(d, 1);
    float *                            x = bound<float>(d, 2), *r = bound<float>(d, 3);
    const std::ptrdiff_t               changes    = Sweep::kWaiting * Sweep::rowOfChanges(l);
    float* const                       allChanges = scratch.of(push.halfSweeps * changes);
    NoSums                             none;
    for (int front = 0; front <= l.cellsX + kBehind * push.halfSweeps; ++front) {
        for (int n = 0; n < push.halfSweeps; ++n)
            Sweep{l, entries, b, x, allChanges + n * changes, (push.colour + n) % 2, push.fromZero && n == 0}.advance(
                front - kBehind * n);
        const int last = front - kBehind * push.halfSweeps;
        if (!r || last < 0) continue;
        applyRow<kSpan, kTogether, 0, float>(l, entries, b, x, r, last, none);
        applyRow<kSpan, kTogether, 1, float>(l, entries, b, x, r, last, none);
    }
}

template <bool kTogether>
void smoothOf(const HostDispatch& d)
{
    bySpan(pushed<ShellPush>(d).layout.span, [&]<int kSpan>(KnownSpan<kSpan>) { smoothKnown<kSpan, kTogether>(d); });
}

// Transfers, by the tables of the plate's kernels, of each field with its own. Those along x go by whole rows.

/// Sums up to kMost weighted rows of memory; none counts whose weight is 0.
template <int kMost, bool kAdd>
void sumRows(const float* entry, const float* from, std::ptrdiff_t row, float* to, std::ptrdiff_t numbers)
{
    const float* rows[kMost];
    float        weights[kMost];
    int          count = 0;
    const int    first = int(entry[0]);
    for (int m = 0; m < kMost; ++m)
        if (entry[1 + m] != 0) {
            rows[count]      = from + (first + m) * row;
            weights[count++] = entry[1 + m];
        }
    for (std::ptrdiff_t n = 0; n < numbers; n += kLanes) {
        Together<float> sum = kAdd ? eightOf(to + n) : Together<float>(0.0F);
        for (int m = 0; m < count; ++m) sum += weights[m] * eightOf(rows[m] + n);
        store(to + n, sum);
    }
}

/// Sums up to kMost weighted nodes of a row.
template <int kMost, bool kTogether>
[[gnu::always_inline]] inline void sumNodes(const float* entry, const float* from, int fromSpan, float* to)
{
    constexpr int                                         kLoads = loadsOf(kTogether);
    std::conditional_t<kTogether, Together<float>, float> sum(0.0F);
    const int                                             first = int(entry[0]);
    for (int m = 0; m < kMost; ++m) {
        if (entry[1 + m] == 0) continue;
        const float* at = from + std::ptrdiff_t(placeOf(first + m, fromSpan)) * kLoads;
        if constexpr (kTogether)
            sum += entry[1 + m] * eightOf(at);
        else
            sum += entry[1 + m] * *at;
    }
    __builtin_memcpy(to, &sum, sizeof sum);
}

template <bool kTogether>
void prolongOf(const HostDispatch& d)
{
    static thread_local Scratch<float> scratch;
    constexpr int                      kLoads = loadsOf(kTogether);
    const ShellPush&                   push   = pushed<ShellPush>(d);
    const ShellLayout &                fine = push.layout, &coarse = push.coarse;
    const float*                       from = bound<const float>(d, 4);
    float*                             to   = bound<float>(d, 5);
    const std::ptrdiff_t row = std::ptrdiff_t(2) * fine.span * kLoads, fromRow = rowOfFields(coarse) * kLoads,
                         toRow = rowOfFields(fine) * kLoads;
    float* between             = scratch.of((coarse.cellsX + 1) * row);
    for (int field = 0; field < 2; ++field) {
        const float *tableX = bound<const float>(d, field), *tableZ = bound<const float>(d, 2 + field);
        for (int i = 0; i <= coarse.cellsX; ++i) {
            for (const int odd : {0, 1}) // empty places stay empty
                for (std::ptrdiff_t n = (std::ptrdiff_t(odd) * fine.span + countOf(fine.cellsZ, odd)) * kLoads;
                     n < std::ptrdiff_t(odd + 1) * fine.span * kLoads; ++n)
                    between[i * row + n] = 0;
            for (int j = 0; j <= fine.cellsZ; ++j)
                sumNodes<kFineWeights, kTogether>(tableZ + std::ptrdiff_t(kFineStride) * j,
                                                  from + (i + kShellRim) * fromRow +
                                                      std::ptrdiff_t(2) * field * coarse.span * kLoads,
                                                  coarse.span, between + i * row + placeOf(j, fine.span) * kLoads);
        }
        for (int i = 0; i <= fine.cellsX; ++i)
            sumRows<kFineWeights, true>(tableX + std::ptrdiff_t(kFineStride) * i, between, row,
                                        to + (i + kShellRim) * toRow + field * row, row);
    }
}

template <bool kTogether>
void restrictOf(const HostDispatch& d)
{
    static thread_local Scratch<float> scratch;
    constexpr int                      kLoads = loadsOf(kTogether);
    const ShellPush&                   push   = pushed<ShellPush>(d);
    const ShellLayout &                fine = push.layout, &coarse = push.coarse;
    const float*                       from = bound<const float>(d, 4);
    float*                             to   = bound<float>(d, 5);
    const std::ptrdiff_t row = std::ptrdiff_t(2) * fine.span * kLoads, fromRow = rowOfFields(fine) * kLoads,
                         toRow = rowOfFields(coarse) * kLoads;
    float* between             = scratch.of(row);
    for (int field = 0; field < 2; ++field) {
        const float *tableX = bound<const float>(d, field) + std::ptrdiff_t(kFineStride) * (fine.cellsX + 1),
                    *tableZ = bound<const float>(d, 2 + field) + std::ptrdiff_t(kFineStride) * (fine.cellsZ + 1);
        for (int i = 0; i <= coarse.cellsX; ++i) {
            sumRows<kCoarseWeights, false>(tableX + std::ptrdiff_t(kCoarseStride) * i,
                                           from + kShellRim * fromRow + field * row, fromRow, between, row);
            float* const at = to + (i + kShellRim) * toRow + std::ptrdiff_t(2) * field * coarse.span * kLoads;
            for (int j = 0; j <= coarse.cellsZ; ++j)
                sumNodes<kCoarseWeights, kTogether>(tableZ + std::ptrdiff_t(kCoarseStride) * j, between, fine.span,
                                                    at + placeOf(j, coarse.span) * kLoads);
        }
    }
}

// The coarsest level, in doubles.

/// Takes two columns at a time from what lies below them.
template <bool kTogether>
void solveLower(const double* factors, double* y, int unknowns, int band)
{
    const std::ptrdiff_t stride = band + 1;
    for (int c = 0; c < unknowns; c += 2) { // behind the last column lie zeros
        const double *l0 = factors + c * stride, *l1 = l0 + stride - 1;
        if constexpr (kTogether) {
            const auto first = eightOf(y + c * kLanes), second = eightOf(y + (c + 1) * kLanes) - l0[1] * first;
            store(y + (c + 1) * kLanes, second);
            for (int m = 2; m <= band; ++m) {
                double* at = y + (c + m) * kLanes;
                store(at, (eightOf(at) - l0[m] * first) - l1[m] * second);
            }
            double* at = y + (c + band + 1) * kLanes;
            store(at, eightOf(at) - l1[band + 1] * second);
        } else {
            const double first = y[c], second = y[c + 1] -= l0[1] * first;
#pragma GCC ivdep
            for (int m = 2; m <= band; ++m) y[c + m] = (y[c + m] - l0[m] * first) - l1[m] * second;
            y[c + band + 1] -= l1[band + 1] * second;
        }
    }
}

/// What lies below the pivot of a column times the unknowns there, of eight loads.
inline Together<double> dotOfColumn(const double* l, const double* y, int band)
{
    Together<double> even(0.0), odd(0.0);
    int              m = 1;
    for (; m < band; m += 2) {
        even += l[m] * eightOf(y + m * kLanes);
        odd += l[m + 1] * eightOf(y + (m + 1) * kLanes);
    }
    if (m == band) even += l[m] * eightOf(y + m * kLanes);
    return even + odd;
}

/// The same of one load.
inline double sumOfColumn(const double* l, const double* y, int band)
{
    Together<double> sums(0.0);
    int              m = 1;
    for (; m + kLanes <= band + 1; m += kLanes) sums += eightOf(l + m) * eightOf(y + m);
    double sum = 0;
    for (; m <= band; ++m) sum += l[m] * y[m];
    for (int n = 0; n < kLanes; ++n) sum += sums[n];
    return sum;
}

template <bool kTogether>
void solveBandOf(const HostDispatch& d)
{
    static thread_local Scratch<double> scratch;
    constexpr int                       kLoads  = loadsOf(kTogether);
    const BandPush&                     p       = pushed<BandPush>(d);
    const double*                       factors = bound<const double>(d, 0);
    const float*                        b       = bound<const float>(d, 1);
    float*                              x       = bound<float>(d, 2);
    const int                           band = p.halfBand, stride = band + 1;
    double* const                       y = scratch.of(std::ptrdiff_t(p.unknowns + stride + kLanes) * kLoads);
    for (int u = 0; u < p.unknowns; ++u)
        for (int n = 0; n < kLoads; ++n) y[u * kLoads + n] = double(b[p.places[u] * kLoads + n]);
    for (std::ptrdiff_t n = std::ptrdiff_t(p.unknowns) * kLoads;
         n < std::ptrdiff_t(p.unknowns + stride + kLanes) * kLoads; ++n)
        y[n] = 0;
    solveLower<kTogether>(factors, y, p.unknowns, band);
    for (int c = p.unknowns - 1; c >= 0; --c) {
        const double* l = factors + std::ptrdiff_t(c) * stride;
        if constexpr (kTogether)
            store(y + c * kLanes, l[0] * eightOf(y + c * kLanes) - dotOfColumn(l, y + c * kLanes, band));
        else
            y[c] = l[0] * y[c] - sumOfColumn(l, y + c, band);
    }
    for (int u = 0; u < p.unknowns; ++u)
        for (int n = 0; n < kLoads; ++n) x[p.places[u] * kLoads + n] = float(y[u * kLoads + n]);
}

// Conjugate gradients: sums are in doubles.

/// Writes sums over all nodes; of one load they are in eight parts, which are added in order.
template <bool kTogether>
void putSums(const Together<double>& sums, double* to)
{
    if constexpr (kTogether) {
        store(to, sums);
    } else {
        *to = 0;
        for (int n = 0; n < kLanes; ++n) *to += sums[n];
    }
}

template <bool kTogether>
auto factorOf(const double* factors)
{
    if constexpr (kTogether)
        return eightOf(factors);
    else
        return *factors;
}

/// Calls visit(n) for all numbers of a vector by eights, and ofPart() behind each part of shell_layout.h: sums have one
/// order on all processors.
template <bool kTogether, class Visit, class OfPart>
[[gnu::always_inline]] inline void eachPart(const HostDispatch& d, const Visit& visit, const OfPart& ofPart)
{
    const std::ptrdiff_t numbers = pushed<VectorSize>(d).numbers * loadsOf(kTogether),
                         part    = std::ptrdiff_t(shared::shellPart(unsigned(numbers)));
    for (std::ptrdiff_t first = 0; first < numbers; first += part) {
        const std::ptrdiff_t end = first + part < numbers ? first + part : numbers;
        for (std::ptrdiff_t n = first; n < end; n += kLanes) visit(n);
        ofPart();
    }
}

} // namespace

void shellSmooth(const HostDispatch& d)
{
    smoothOf<false>(d);
}
void shellSmooth_together(const HostDispatch& d)
{
    smoothOf<true>(d);
}
void shellResidual(const HostDispatch& d)
{
    applyAll<false, float, float>(d, bound<const float>(d, 1), 2);
}
void shellResidual_together(const HostDispatch& d)
{
    applyAll<true, float, float>(d, bound<const float>(d, 1), 2);
}
void shellApply(const HostDispatch& d)
{
    applyAll<false, double, double, double>(d, nullptr, 1);
}
// Buffers: entries, x, K x; of eight loads the sums of x K x too.
void shellApply_together(const HostDispatch& d)
{
    store(bound<double>(d, 3), applyAll<true, double, double, float, ProductSums>(d, nullptr, 1).ofX);
}
// Buffers: entries, x of eight loads; sums of x K x, by K in floats.
void shellSteepness(const HostDispatch& d)
{
    const ShellLayout& l       = pushed<ShellPush>(d).layout;
    const float *      entries = bound<const float>(d, 0), *x = bound<const float>(d, 1);
    Together<double>   sums(0.0);
    bySpan(l.span, [&]<int kSpan>(KnownSpan<kSpan>) {
        for (int i = 0; i <= l.cellsX; ++i) {
            addSteepness<kSpan, 0>(l, entries, x, i, sums);
            addSteepness<kSpan, 1>(l, entries, x, i, sums);
        }
    });
    store(bound<double>(d, 2), sums);
}
// Buffers: entries, right side, answer, what is missing of the right side; of eight loads the sums of both times the
// answer too.
void shellMissing(const HostDispatch& d)
{
    applyAll<false, double, double, double>(d, bound<const double>(d, 1), 2);
}
void shellMissing_together(const HostDispatch& d)
{
    const auto sums = applyAll<true, double, double, float, ProductSums>(d, bound<const float>(d, 1), 2);
    store(bound<double>(d, 4), sums.ofRight + sums.ofX);
}
void shellProlong(const HostDispatch& d)
{
    prolongOf<false>(d);
}
void shellProlong_together(const HostDispatch& d)
{
    prolongOf<true>(d);
}
void shellRestrict(const HostDispatch& d)
{
    restrictOf<false>(d);
}
void shellRestrict_together(const HostDispatch& d)
{
    restrictOf<true>(d);
}
void shellBandSolve(const HostDispatch& d)
{
    solveBandOf<false>(d);
}
void shellBandSolve_together(const HostDispatch& d)
{
    solveBandOf<true>(d);
}

void shellBandFactor(const HostDispatch& d)
{
    const BandPush& p       = pushed<BandPush>(d);
    double*         factors = bound<double>(d, 0);
    const int       band = p.halfBand, stride = band + 1;
    for (int c = 0; c < p.unknowns; ++c) {
        double* const column  = factors + std::ptrdiff_t(c) * stride;
        const double  inverse = 1 / column[0];
        const int     last    = min(band, p.unknowns - 1 - c);
        for (int m = 1; m <= last; ++m) {
            const double l = column[m] * inverse;
            if (l == 0) continue;
            double* const to = factors + std::ptrdiff_t(c + m) * stride - m;
#pragma GCC ivdep
            for (int n = m; n <= last; ++n) to[n] -= l * column[n];
        }
        for (int m = 1; m <= last; ++m) column[m] *= inverse;
        column[0] = inverse;
    }
}

namespace {

// Buffers: two vectors, and the sums of their products.
template <bool kTogether, class A, class B>
void dotsOf(const HostDispatch& d)
{
    const A*         a = bound<const A>(d, 0);
    const B*         b = bound<const B>(d, 1);
    Together<double> all(0.0), sums(0.0);
    eachPart<kTogether>(
        d, [&](std::ptrdiff_t n) { sums += read<double>(a + n) * read<double>(b + n); },
        [&] {
            all += sums;
            sums = Together<double>(0.0);
        });
    putSums<kTogether>(all, bound<double>(d, 2));
}

// Buffers: x, r, p, q, b, factors; sums of b x and r x. x += factor p, r -= factor q.
template <bool kTogether, class Real>
void advanceOf(const HostDispatch& d)
{
    Real *           x = bound<Real>(d, 0), *r = bound<Real>(d, 1);
    const Real *     p = bound<const Real>(d, 2), *q = bound<const Real>(d, 3), *b = bound<const Real>(d, 4);
    const auto       by = factorOf<kTogether>(bound<const double>(d, 5));
    Together<double> bx(0.0), rx(0.0), allBx(0.0), allRx(0.0);
    eachPart<kTogether>(
        d,
        [&](std::ptrdiff_t n) {
            const Together<Real> xNow(read<double>(x + n) + by * read<double>(p + n)),
                rNow(read<double>(r + n) - by * read<double>(q + n));
            store(x + n, xNow);
            store(r + n, rNow);
            const Together<double> exact(xNow);
            bx += read<double>(b + n) * exact;
            rx += Together<double>(rNow) * exact;
        },
        [&] {
            allBx += bx;
            allRx += rx;
            bx = rx = Together<double>(0.0);
        });
    double* sums = bound<double>(d, 6);
    putSums<kTogether>(allBx, sums);
    putSums<kTogether>(allRx, sums + loadsOf(kTogether));
}

// Buffers: z, p, factors. p := z + factor p.
template <bool kTogether, class Real>
void turnOf(const HostDispatch& d)
{
    const float* z  = bound<const float>(d, 0);
    Real*        p  = bound<Real>(d, 1);
    const auto   by = factorOf<kTogether>(bound<const double>(d, 2));
    eachPart<kTogether>(
        d, [&](std::ptrdiff_t n) { store(p + n, Together<Real>(read<double>(z + n) + by * read<double>(p + n))); },
        [] {});
}

} // namespace

void shellDots(const HostDispatch& d)
{
    dotsOf<false, double, double>(d);
}
void shellDots_together(const HostDispatch& d)
{
    dotsOf<true, float, float>(d);
}
void shellDotsOfCycle(const HostDispatch& d)
{
    dotsOf<false, double, float>(d);
}
void shellDotsOfCycle_together(const HostDispatch& d)
{
    dotsOf<true, float, float>(d);
}
void shellAdvance(const HostDispatch& d)
{
    advanceOf<false, double>(d);
}
void shellAdvance_together(const HostDispatch& d)
{
    advanceOf<true, float>(d);
}
void shellTurn(const HostDispatch& d)
{
    turnOf<false, double>(d);
}
void shellTurn_together(const HostDispatch& d)
{
    turnOf<true, float>(d);
}

} // namespace palp::PALPATE_ISA
