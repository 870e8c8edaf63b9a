#include "engine/plate/multigrid/detail/shell_level.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/extremes.h"
#include "engine/plate/multigrid/detail/host_call.h"

namespace palp {
namespace {

using namespace shared;

using std::sqrt;

#include "compute_shaders/shared/plate_grid.h"

/// What varies over a level, relative to its means; in floats, as kernels have it.
struct LevelMaps {
    std::vector<float> rigidity, compliance, shape, stressShape;
    std::vector<float> curvatureX, curvatureZ, curvatureXZ; ///< times what makes them entries [1]
};

/// Reads maps as the shared headers ask for them.
struct Coarsening {
    int          fineNodesZ;
    const float* fine;

    [[nodiscard]] float fineRigidity(int i, int j) const { return fine[std::ptrdiff_t(i) * fineNodesZ + j]; }
    [[nodiscard]] float fineShape(int i, int j) const { return fineRigidity(i, j); }

#include "compute_shaders/shared/rigidity_coarsen.h"
};

enum class Mean { geometric, arithmetic };

std::vector<float> coarser(const std::vector<float>& fine, const PlateLevel& from, const PlateLevel& to, Mean mean)
{
    if (fine.empty()) return {};
    Coarsening         coarsening{from.cellsZ + 1, fine.data()};
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
    return {coarser(fine.rigidity, from, to, Mean::geometric),    coarser(fine.compliance, from, to, Mean::geometric),
            coarser(fine.shape, from, to, Mean::arithmetic),      coarser(fine.stressShape, from, to, Mean::arithmetic),
            coarser(fine.curvatureX, from, to, Mean::arithmetic), coarser(fine.curvatureZ, from, to, Mean::arithmetic),
            coarser(fine.curvatureXZ, from, to, Mean::arithmetic)};
}

/// Lets the bed of a coarser level be softer than the mean of the finer one's, by (h / H)^3: one that clamps phi along
/// a border within some cells goes on doing so within some of the coarser cells. As firm as the finer one it clamps
/// nodes of the sheet beside the border as well, and twice the steps are needed; by (h / H)^4 what lies in the void is
/// corrected too far.
void soften(std::vector<float>& bed, const PlateLevel& from, const PlateLevel& to)
{
    const double cells = double(from.cellsX) * from.cellsZ / (double(to.cellsX) * to.cellsZ); // (H / h)^2
    for (float& value : bed) value *= float(1 / (cells * sqrt(cells)));
}

std::vector<float> scaled(const NodeField& field, double factor)
{
    std::vector<float> result;
    result.reserve(field.values().size());
    for (const double value : field.values()) result.push_back(float(value * factor));
    return result;
}

ShellLayout layoutOf(const PlateLevel& level)
{
    const int even = level.cellsZ / 2 + 1;
    return {level.cellsX, level.cellsZ, (even + 1 + kLoadsTogether - 1) / kLoadsTogether * kLoadsTogether};
}

std::size_t entriesOf(const ShellLayout& l)
{
    return std::size_t(l.cellsX + 1 + 2 * kShellRim) * std::size_t(kShellPlanes * 2 * l.span);
}

/// \param exact  whether coefficients are wanted in doubles too
void assemble(ShellLevel& level, const LevelMaps& maps, bool exact, const HostKernels& kernels)
{
    // Empty places are 0 and stay so while the layout does.
    const std::size_t entries = entriesOf(level.layout), doubles = exact ? entries : 0;
    if (level.entries.size() != entries) level.entries.assign(entries, 0);
    if (level.exact.size() != doubles) level.exact.assign(doubles, 0);
    ShellMaps seen{level.bending,
                   level.stress,
                   maps.rigidity.data(),
                   maps.compliance.data(),
                   maps.shape.empty() ? nullptr : maps.shape.data(),
                   maps.stressShape.empty() ? nullptr : maps.stressShape.data(),
                   maps.curvatureX.data(),
                   maps.curvatureZ.data(),
                   maps.curvatureXZ.data()};
    callHost(kernels.shellEntries, ShellPush{.layout = level.layout, .toDoubles = exact},
             {&seen, level.entries.data(), level.exact.data()});
}

/// A neighbour whose entry with a node is kept at the node.
struct SharedEntry {
    int plane, di, dj;
};
constexpr std::array<SharedEntry, 6> kOwn{{{kBendEast, 1, 0},
                                           {kBendNorth, 0, 1},
                                           {kBendEast2, 2, 0},
                                           {kBendNorth2, 0, 2},
                                           {kBendNorthEast, 1, 1},
                                           {kBendSouthEast, 1, -1}}};
constexpr std::array<SharedEntry, 8> kCoupled{{{kCoupleEast, 1, 0},
                                               {kCoupleWest, -1, 0},
                                               {kCoupleNorth, 0, 1},
                                               {kCoupleSouth, 0, -1},
                                               {kCoupleNorthEast, 1, 1},
                                               {kCoupleNorthWest, -1, 1},
                                               {kCoupleSouthEast, 1, -1},
                                               {kCoupleSouthWest, -1, -1}}};

} // namespace

std::size_t numbersOf(const ShellLayout& l) noexcept
{
    return std::size_t(l.cellsX + 1 + 2 * kShellRim) * std::size_t(4 * l.span);
}

std::ptrdiff_t placeIn(const ShellLayout& l, int i, int j, int field) noexcept
{
    return (std::ptrdiff_t(i + kShellRim) * 4 + field * 2 + j % 2) * l.span + j / 2;
}

double ShellLevel::exactAt(int plane, int i, int j) const noexcept
{
    const auto row = std::ptrdiff_t(i + kShellRim) * kShellPlanes + plane;
    return exact[std::size_t((row * 2 + j % 2) * layout.span + j / 2)];
}

PlacedLoad placed(const ShellLevel& level, const Footprint& load)
{
    const int  nodesZ = level.layout.cellsZ + 1;
    PlacedLoad parts;
    for (const Footprint::Part& part : load.parts) {
        const int i = int(part.node) / nodesZ, j = int(part.node) % nodesZ;
        if (level.exactAt(kInverseW, i, j) != 0) parts.push_back({placeIn(level.layout, i, j, 0), part.force});
    }
    return parts;
}

PlacedLoad placed(const ShellLevel& level, const ShellLoad& load, double phiUnit)
{
    const ShellLayout& l = level.layout;
    PlacedLoad         parts;
    for (int i = 0; i <= l.cellsX; ++i)
        for (int j = 0; j <= l.cellsZ; ++j) {
            if (level.exactAt(kInverseW, i, j) != 0) parts.push_back({placeIn(l, i, j, 0), load.onW(i, j)});
            if (level.exactAt(kInverseF, i, j) != 0) parts.push_back({placeIn(l, i, j, 1), phiUnit * load.onPhi(i, j)});
        }
    return parts;
}

void makeLevels(const Shell& shell, const HostKernels& kernels, std::vector<ShellLevel>& levels)
{
    const double        rigidity   = geometricMean(shell.bending.rigidity.values());
    const double        compliance = geometricMean(shell.membraneCompliance.values());
    const PlateGrid&    grid       = shell.bending.grid;
    const double        entry      = grid.spacingX * grid.spacingZ / sqrt(rigidity * compliance); // of a curvature [m]
    const Plate         membrane   = membraneOf(shell);
    const GridHierarchy bending    = gridHierarchy(shell.bending, rigidity);
    const GridHierarchy stress     = gridHierarchy(membrane, compliance);
    LevelMaps           maps{scaled(shell.bending.rigidity, 1 / rigidity),
                   scaled(shell.membraneCompliance, 1 / compliance),
                   scaled(shell.bending.foundationShape, 1),
                   scaled(membrane.foundationShape, 1),
                   scaled(shell.curvatureX, entry),
                   scaled(shell.curvatureZ, entry),
                   scaled(shell.curvatureXZ, entry)};

    levels.resize(bending.levels.size());
    for (std::size_t n = 0; n < levels.size(); ++n) {
        const GridHierarchy::Level &ofW = bending.levels[n], &ofF = stress.levels[n];
        if (n > 0) maps = coarser(maps, bending.levels[n - 1].plate, ofW.plate);
        if (n > 0) soften(maps.stressShape, levels[n - 1].bending, ofW.plate);
        ShellLevel&       level  = levels[n];
        const ShellLayout layout = layoutOf(ofW.plate);
        if (level.layout != layout) level = {};
        level.layout  = layout;
        level.bending = ofW.plate;
        level.stress  = ofF.plate;
        level.tables  = {ofW.tableX, ofF.tableX, ofW.tableZ, ofF.tableZ};
        assemble(level, maps, n == 0 || n + 1 == levels.size(), kernels);
    }
}

void ShellCoarseSolver::factorise(const ShellLevel& level, const HostKernels& kernels)
{
    number(level);
    collect(level);
    callHost(kernels.shellBandFactor, BandPush{int(places_.size()), halfBand_, places_.data()}, {factors_.data()});
}

/// Numbers what moves, along the shorter side first.
void ShellCoarseSolver::number(const ShellLevel& level)
{
    const ShellLayout& l    = level.layout;
    const bool         free = level.stress.free == (kSideX0 | kSideX1 | kSideZ0 | kSideZ1) && level.stress.bed == 0;
    const auto pinned       = [&](int i, int j) { // a stress function that no side holds is known but for a linear one
        return free && (i == 0 || i == l.cellsX) && (j == 0 || j == l.cellsZ) && !(i > 0 && j > 0);
    };
    places_.clear();
    unknowns_.assign(2 * nodesOf(level.bending), -1);
    const bool alongZ = l.cellsZ <= l.cellsX;
    const int  slow = alongZ ? l.cellsX : l.cellsZ, fast = alongZ ? l.cellsZ : l.cellsX;
    for (int a = 0; a <= slow; ++a)
        for (int b = 0; b <= fast; ++b)
            for (int field = 0; field < 2; ++field) {
                const int  i = alongZ ? a : b, j = alongZ ? b : a;
                const bool moves =
                    field == 0 ? !isHeld(level.bending, i, j) : !isHeld(level.stress, i, j) && !pinned(i, j);
                if (!moves) continue;
                unknowns_[std::size_t(2 * (i * (l.cellsZ + 1) + j) + field)] = int(places_.size());
                places_.push_back(placeIn(l, i, j, field));
            }
    halfBand_        = 1;
    const auto reach = [&](int i, int j) { // to the last unknown that the node shares an entry with
        for (int field = 0; field < 2; ++field)
            for (const SharedEntry& e : kOwn) {
                const int ii = i + e.di, jj = j + e.dj;
                if (ii > l.cellsX || jj < 0 || jj > l.cellsZ) continue;
                const int a = numberOf(l, i, j, field);
                for (int other = 0; other < 2; ++other)
                    if (const int b = numberOf(l, ii, jj, other); a >= 0 && b >= 0)
                        halfBand_ = std::max(halfBand_, std::abs(a - b));
            }
    };
    for (int i = 0; i <= l.cellsX; ++i)
        for (int j = 0; j <= l.cellsZ; ++j) reach(i, j);
}

int ShellCoarseSolver::numberOf(const ShellLayout& l, int i, int j, int field) const noexcept
{
    return unknowns_[std::size_t(2 * (i * (l.cellsZ + 1) + j) + field)];
}

/// Collects the entries below the diagonal, column by column.
void ShellCoarseSolver::collect(const ShellLevel& level)
{
    factors_.assign((places_.size() + 1) * std::size_t(halfBand_ + 1), 0); // and a column of zeros
    const ShellLayout& l   = level.layout;
    const auto         add = [&](int i, int j, int field, int ii, int jj, int ofField, double entry) {
        const int r = numberOf(l, i, j, field), c = numberOf(l, ii, jj, ofField);
        if (r < 0 || c < 0) return;
        factors_[std::size_t(std::min(r, c)) * std::size_t(halfBand_ + 1) + std::size_t(std::abs(r - c))] += entry;
    };
    for (int i = 0; i <= l.cellsX; ++i)
        for (int j = 0; j <= l.cellsZ; ++j) {
            add(i, j, 0, i, j, 0, level.exactAt(kBed, i, j));
            add(i, j, 1, i, j, 1, -level.exactAt(kStressBed, i, j));
            const auto inside = [&](const SharedEntry& e) {
                return i + e.di >= 0 && i + e.di <= l.cellsX && j + e.dj >= 0 && j + e.dj <= l.cellsZ;
            };
            for (const SharedEntry& e : kOwn) {
                if (!inside(e)) continue;
                for (int field = 0; field < 2; ++field) { // a change between two nodes pulls at both
                    const double k =
                        (field == 0 ? 1 : -1) * level.exactAt(e.plane + (field == 0 ? kBendEast : kStressEast), i, j);
                    add(i, j, field, i + e.di, j + e.dj, field, k);
                    add(i, j, field, i, j, field, -k);
                    add(i + e.di, j + e.dj, field, i + e.di, j + e.dj, field, -k);
                }
            }
            for (const SharedEntry& e : kCoupled) {
                if (!inside(e)) continue;
                const double k = level.exactAt(e.plane, i, j);
                add(i, j, 0, i + e.di, j + e.dj, 1, k);
                add(i, j, 0, i, j, 1, -k);
            }
        }
}

void ShellCoarseSolver::solve(const HostKernels& kernels, const float* b, float* x) const
{
    callHost(kernels.shellBandSolve, BandPush{int(places_.size()), halfBand_, places_.data()}, {factors_.data(), b, x});
}

} // namespace palp
