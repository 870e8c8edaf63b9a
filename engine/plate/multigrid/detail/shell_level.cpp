#include "engine/plate/multigrid/detail/shell_level.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "engine/core/extremes.h"

namespace palp {
namespace {

using namespace shared;

using real = double;
using std::abs;
using std::max;
using std::sqrt;

#include "compute_shaders/shared/plate_grid.h"
#include "compute_shaders/shared/shell_relax.h"

/// Bounds of the relaxation: see compute_shaders/shared/plate_relax.h, whose words these are in doubles.
double divisorOf(double diagonal, double sameColour)
{
    return max(diagonal / 1.1, 0.51 * (diagonal + sameColour));
}

/// What varies over a level, relative to its means; in floats, as kernels have it.
struct LevelMaps {
    std::vector<float> rigidity, compliance, shape;
    std::vector<float> curvatureX, curvatureZ, curvatureXZ; ///< times what makes them entries [1]
};

/// Reads maps as the shared headers ask for them.
struct Coarsening {
    int                       fineNodesZ;
    const std::vector<float>* fine;

    [[nodiscard]] float fineRigidity(int i, int j) const
    {
        return (*fine)[std::size_t(i) * std::size_t(fineNodesZ) + std::size_t(j)];
    }
    [[nodiscard]] float fineShape(int i, int j) const { return fineRigidity(i, j); }

#include "compute_shaders/shared/rigidity_coarsen.h"
};

struct Coupling {
    int              nodesZ;
    const LevelMaps& maps;

    [[nodiscard]] float of(const std::vector<float>& map, int i, int j) const
    {
        return map[std::size_t(i) * std::size_t(nodesZ) + std::size_t(j)];
    }
    [[nodiscard]] float curvatureX(int i, int j) const { return of(maps.curvatureX, i, j); }
    [[nodiscard]] float curvatureZ(int i, int j) const { return of(maps.curvatureZ, i, j); }
    [[nodiscard]] float curvatureXZ(int i, int j) const { return of(maps.curvatureXZ, i, j); }

#include "compute_shaders/shared/shell_coupling.h"
};

enum class Mean { geometric, arithmetic };

std::vector<float> coarser(const std::vector<float>& fine, const PlateLevel& from, const PlateLevel& to, Mean mean)
{
    if (fine.empty()) return {};
    Coarsening         coarsening{from.cellsZ + 1, &fine};
    std::vector<float> coarse;
    coarse.reserve(nodesOf(to));
    for (int i = 0; i <= to.cellsX; ++i)
        for (int j = 0; j <= to.cellsZ; ++j)
            coarse.push_back(mean == Mean::geometric ? coarsening.coarseRigidityAt(from, to, i, j)
                                                     : coarsening.coarseShapeAt(from, to, i, j));
    return coarse;
}

LevelMaps coarser(const LevelMaps& fine, const PlateLevel& from, const PlateLevel& to)
{
    return {
        coarser(fine.rigidity, from, to, Mean::geometric),    coarser(fine.compliance, from, to, Mean::geometric),
        coarser(fine.shape, from, to, Mean::arithmetic),      coarser(fine.curvatureX, from, to, Mean::arithmetic),
        coarser(fine.curvatureZ, from, to, Mean::arithmetic), coarser(fine.curvatureXZ, from, to, Mean::arithmetic)};
}

std::vector<float> scaled(const NodeField& field, double factor)
{
    std::vector<float> result;
    result.reserve(field.values().size());
    for (const double value : field.values()) result.push_back(float(value * factor));
    return result;
}

/// A difference of a few nodes near a node.
struct Stencil {
    std::size_t             count = 0;
    std::array<NodeStep, 4> node{};
    std::array<double, 4>   factor{};

    void add(int i, int j, double withFactor)
    {
        node[count]     = {i, j};
        factor[count++] = withFactor;
    }
};

/// Collects the entries of one field's own operator from the terms of its energy.
class PlateEntries {
public:
    PlateEntries(const PlateLevel& g, std::vector<ShellRow>& rows, std::array<double, 13> ShellRow::*entries)
        : g_(g), rows_(rows), entries_(entries)
    {
        for (std::size_t n = 0; n < kPlateSteps.size(); ++n) column(kPlateSteps[n]) = n;
    }

    void addAll(const std::vector<float>& rigidity, const std::vector<float>& shape)
    {
        for (int i = 0; i <= g_.cellsX; ++i)
            for (int j = 0; j <= g_.cellsZ; ++j) {
                const auto node = std::size_t(i) * std::size_t(g_.cellsZ + 1) + std::size_t(j);
                addBending(i, j, rigidity[node]);
                if (g_.bed > 0 && !isHeld(g_, i, j)) {
                    const double share = (i == 0 || i == g_.cellsX ? 0.5 : 1) * (j == 0 || j == g_.cellsZ ? 0.5 : 1);
                    entry({i, j}, {i, j}) += double(g_.bed) * share * (shape.empty() ? 1 : double(shape[node]));
                }
                if (i == g_.cellsX || j == g_.cellsZ) continue;
                const std::size_t east = node + std::size_t(g_.cellsZ + 1);
                addTwist(i, j,
                         (double(rigidity[node]) + rigidity[node + 1]) + (double(rigidity[east]) + rigidity[east + 1]));
            }
    }

private:
    [[nodiscard]] bool isHinged(int n, int cells, uint first, uint last) const
    {
        return (n == 0 && (g_.hinged & first) != 0U) || (n == cells && (g_.hinged & last) != 0U);
    }

    /// Adds the second difference along one axis at place n of that axis.
    static Stencil second(int i, int j, NodeStep along, int n, int cells)
    {
        Stencil s;
        s.add(i, j, -2);
        if (n > 0) s.add(i - along.i, j - along.j, n == cells ? 2 : 1);
        if (n < cells) s.add(i + along.i, j + along.j, n == 0 ? 2 : 1);
        return s;
    }

    void addBending(int i, int j, double rigidity)
    {
        const bool   onX = isHinged(i, g_.cellsX, kSideX0, kSideX1), onZ = isHinged(j, g_.cellsZ, kSideZ0, kSideZ1);
        const double shareX = i == 0 || i == g_.cellsX ? 0.5 : 1, shareZ = j == 0 || j == g_.cellsZ ? 0.5 : 1;
        if (onX && onZ) return;
        const Stencil p = second(i, j, {1, 0}, i, g_.cellsX), q = second(i, j, {0, 1}, j, g_.cellsZ);
        if (onZ) return addProduct(p, p, rigidity * g_.exx * shareX);
        if (onX) return addProduct(q, q, rigidity * g_.ezz * shareZ);
        const double share = rigidity * shareX * shareZ;
        addProduct(p, p, share * g_.kxx);
        addProduct(q, q, share * g_.kzz);
        addProduct(p, q, share * g_.kxz);
        addProduct(q, p, share * g_.kxz);
    }

    void addTwist(int i, int j, double sumOfRigidities)
    {
        Stencil t;
        t.add(i, j, 1);
        t.add(i + 1, j, -1);
        t.add(i, j + 1, -1);
        t.add(i + 1, j + 1, 1);
        addProduct(t, t, g_.twist * sumOfRigidities);
    }

    void addProduct(const Stencil& a, const Stencil& b, double k)
    {
        for (std::size_t m = 0; m < a.count; ++m) {
            if (isHeld(g_, a.node[m].i, a.node[m].j)) continue;
            for (std::size_t n = 0; n < b.count; ++n)
                if (!isHeld(g_, b.node[n].i, b.node[n].j)) entry(a.node[m], b.node[n]) += k * a.factor[m] * b.factor[n];
        }
    }

    double& entry(NodeStep row, NodeStep to)
    {
        ShellRow& at = rows_[std::size_t(row.i) * std::size_t(g_.cellsZ + 1) + std::size_t(row.j)];
        return (at.*entries_)[column({to.i - row.i, to.j - row.j})];
    }

    std::size_t& column(NodeStep step) { return columns_[std::size_t(step.i + 2) * 5 + std::size_t(step.j + 2)]; }

    const PlateLevel&      g_;
    std::vector<ShellRow>& rows_;
    std::array<double, 13> ShellRow::*entries_;
    std::array<std::size_t, 25>       columns_{};
};

void addCoupling(ShellLevel& level, const LevelMaps& maps)
{
    Coupling  coupling{level.stress.cellsZ + 1, maps};
    const int cellsX = level.layout.cellsX, cellsZ = level.layout.cellsZ;
    for (int i = 0; i <= cellsX; ++i)
        for (int j = 0; j <= cellsZ; ++j) {
            if (isHeld(level.bending, i, j)) continue;
            for (std::size_t n = 0; n < kCouplingSteps.size(); ++n) {
                const NodeStep step = kCouplingSteps[n];
                const int      ii = i + step.i, jj = j + step.j;
                if (ii < 0 || jj < 0 || ii > cellsX || jj > cellsZ || isHeld(level.stress, ii, jj)) continue;
                const double entry = coupling.couplingEntry(level.stress, i, j, step.i, step.j);
                level.rows[std::size_t(i) * std::size_t(cellsZ + 1) + std::size_t(j)].wf[n] = entry;
                const auto back =
                    std::ranges::find_if(kCouplingSteps, [&](NodeStep s) { return s.i == -step.i && s.j == -step.j; });
                level.rows[std::size_t(ii) * std::size_t(cellsZ + 1) + std::size_t(jj)]
                    .fw[std::size_t(back - kCouplingSteps.begin())] = entry;
            }
        }
}

/// Returns the divisor of a field at a node.
double divisorOf(const std::array<double, 13>& row)
{
    double sameColour = 0;
    for (std::size_t n = 1; n < row.size(); ++n)
        if ((kPlateSteps[n].i + kPlateSteps[n].j) % 2 == 0) sameColour += abs(row[n]);
    return divisorOf(row[0], sameColour);
}

void invertNodes(ShellLevel& level)
{
    level.inverses.clear();
    std::size_t node = 0;
    for (int i = 0; i <= level.layout.cellsX; ++i)
        for (int j = 0; j <= level.layout.cellsZ; ++j, ++node) {
            const ShellRow&    row = level.rows[node];
            const ShellInverse of  = shellInverse(divisorOf(row.w), divisorOf(row.f), row.wf[0],
                                                  !isHeld(level.bending, i, j), !isHeld(level.stress, i, j));
            level.inverses.push_back({of.ww, of.wf, of.ff});
        }
}

ShellLevel assembled(const GridHierarchy::Level& bending, const GridHierarchy::Level& stress, const LevelMaps& maps)
{
    ShellLevel level{{bending.plate.cellsX, bending.plate.cellsZ},
                     bending.plate,
                     stress.plate,
                     std::vector<ShellRow>(nodesOf(bending.plate)),
                     {},
                     bending.tableX,
                     bending.tableZ,
                     stress.tableX,
                     stress.tableZ};
    PlateEntries(level.bending, level.rows, &ShellRow::w).addAll(maps.rigidity, maps.shape);
    PlateEntries(level.stress, level.rows, &ShellRow::f).addAll(maps.compliance, {});
    addCoupling(level, maps);
    invertNodes(level);
    return level;
}

} // namespace

std::vector<ShellLevel> shellLevels(const Shell& shell)
{
    const double        rigidity   = geometricMean(shell.bending.rigidity.values());
    const double        compliance = geometricMean(shell.membraneCompliance.values());
    const PlateGrid&    grid       = shell.bending.grid;
    const double        entry      = grid.spacingX * grid.spacingZ / sqrt(rigidity * compliance); // of a curvature [m]
    const GridHierarchy bending    = gridHierarchy(shell.bending, rigidity);
    const GridHierarchy stress     = gridHierarchy(membraneOf(shell), compliance);
    LevelMaps           maps{scaled(shell.bending.rigidity, 1 / rigidity),
                   scaled(shell.membraneCompliance, 1 / compliance),
                   scaled(shell.bending.foundationShape, 1),
                   scaled(shell.curvatureX, entry),
                   scaled(shell.curvatureZ, entry),
                   scaled(shell.curvatureXZ, entry)};

    std::vector<ShellLevel> levels;
    for (std::size_t n = 0; n < bending.levels.size(); ++n) {
        if (n > 0) maps = coarser(maps, bending.levels[n - 1].plate, bending.levels[n].plate);
        levels.push_back(assembled(bending.levels[n], stress.levels[n], maps));
    }
    return levels;
}

int ShellCoarseSolver::unknownOf(int i, int j, int field) const noexcept
{
    const bool alongZ = layout_.cellsZ <= layout_.cellsX; // the shorter side first
    return 2 * (alongZ ? i * (layout_.cellsZ + 1) + j : j * (layout_.cellsX + 1) + i) + field;
}

ShellCoarseSolver::ShellCoarseSolver(const ShellLevel& level)
    : layout_(level.layout), unknowns_(2 * int(nodesOf(level.bending))),
      halfBand_(4 * (std::min(layout_.cellsX, layout_.cellsZ) + 1) + 1),
      factors_(std::size_t(unknowns_) * std::size_t(halfBand_ + 1))
{
    const auto at = [&](int column, int below) -> double& {
        return factors_[std::size_t(column) * std::size_t(halfBand_ + 1) + std::size_t(below)];
    };
    const bool free   = level.stress.free == (kSideX0 | kSideX1 | kSideZ0 | kSideZ1);
    const auto pinned = [&](int i, int j) { // a stress function that no side holds is known but for a linear one
        return free && (i == 0 || i == layout_.cellsX) && (j == 0 || j == layout_.cellsZ) && !(i > 0 && j > 0);
    };
    const auto moves = [&](int i, int j, int field) {
        return field == 0 ? !isHeld(level.bending, i, j) : !isHeld(level.stress, i, j) && !pinned(i, j);
    };
    std::size_t node = 0;
    for (int i = 0; i <= layout_.cellsX; ++i)
        for (int j = 0; j <= layout_.cellsZ; ++j, ++node) {
            const ShellRow& row = level.rows[node];
            const auto      put = [&](int field, NodeStep step, int ofField, double entry) {
                const int ii = i + step.i, jj = j + step.j;
                if (entry == 0 || !moves(i, j, field) || !moves(ii, jj, ofField)) return;
                const int r = unknownOf(i, j, field), c = unknownOf(ii, jj, ofField);
                if (r >= c) at(c, r - c) = entry;
            };
            for (std::size_t n = 0; n < kPlateSteps.size(); ++n) {
                put(0, kPlateSteps[n], 0, row.w[n]);
                put(1, kPlateSteps[n], 1, -row.f[n]);
            }
            for (std::size_t n = 0; n < kCouplingSteps.size(); ++n) {
                put(0, kCouplingSteps[n], 1, row.wf[n]);
                put(1, kCouplingSteps[n], 0, row.fw[n]);
            }
        }
    for (int c = 0; c < unknowns_; ++c) {
        const double inverse = at(c, 0) == 0 ? 0 : 1 / at(c, 0); // an unknown that does not move stays 0
        const int    last    = std::min(halfBand_, unknowns_ - 1 - c);
        for (int m = 1; m <= last; ++m) {
            const double l = at(c, m) * inverse;
            if (l == 0) continue;
            for (int n = m; n <= last; ++n) at(c + m, n - m) -= l * at(c, n);
        }
        for (int m = 1; m <= last; ++m) at(c, m) *= inverse;
        at(c, 0) = inverse;
    }
}

void ShellCoarseSolver::solve(const double* b, double* x, int loads) const
{
    std::vector<double> y(std::size_t(unknowns_) * std::size_t(loads));
    const auto          each = [&](const auto& visit) {
        for (int i = 0; i <= layout_.cellsX; ++i)
            for (int j = 0; j <= layout_.cellsZ; ++j)
                for (int field = 0; field < 2; ++field)
                    visit((layout_.at(i, j) * 2 + field) * loads, std::ptrdiff_t(unknownOf(i, j, field)) * loads);
    };
    const auto row = [&](int unknown) { return y.data() + std::ptrdiff_t(unknown) * loads; };
    each([&](std::ptrdiff_t from, std::ptrdiff_t to) { std::copy_n(b + from, loads, y.begin() + to); });
    for (int c = 0; c < unknowns_; ++c) {
        const double* l    = factors_.data() + std::ptrdiff_t(c) * (halfBand_ + 1);
        const int     last = std::min(halfBand_, unknowns_ - 1 - c);
        for (int m = 1; m <= last; ++m)
            for (int n = 0; n < loads; ++n) row(c + m)[n] -= l[m] * row(c)[n];
    }
    for (int c = unknowns_ - 1; c >= 0; --c) {
        const double* l    = factors_.data() + std::ptrdiff_t(c) * (halfBand_ + 1);
        const int     last = std::min(halfBand_, unknowns_ - 1 - c);
        for (int n = 0; n < loads; ++n) row(c)[n] *= l[0];
        for (int m = 1; m <= last; ++m)
            for (int n = 0; n < loads; ++n) row(c)[n] -= l[m] * row(c + m)[n];
    }
    each([&](std::ptrdiff_t to, std::ptrdiff_t from) { std::copy_n(y.begin() + from, loads, x + to); });
}

} // namespace palp
