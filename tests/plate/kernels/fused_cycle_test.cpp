#include <algorithm>
#include <cmath>

#include "compute_shaders/shared/cg_state.h"
#include "compute_shaders/shared/region_layout.h"
#include "compute_shaders/shared/tile_layout.h"
#include "engine/plate/multigrid/detail/plate_tail.h"
#include "tests/plate/kernels/plate_shader_test.h"

// Tests of the cycle in few dispatches: plate_down.comp, plate_up.comp and plate_tail.comp, against single passes in
// C++.

namespace palp {
namespace {

/// Where a driver fuses, rounding spreads through half sweeps, each of which multiplies it by a few; the deflection
/// that it is relative to is that of the whole level.
constexpr Rounding kCycleRounding{1e4, "half sweeps carry the rounding of 60 terms on, where stiff nodes enlarge it"};

/// Both colours, `sweeps` times, the colour `first` first.
std::vector<float> swept(const RoughLevel& level, std::vector<float> w, const std::vector<float>& force, unsigned first,
                         int sweeps)
{
    const std::vector<float> inverse = host::inverseDivisor(level.g, level.rigidity);
    for (int n = 0; n < 2 * sweeps; ++n) w = host::relaxed(level, {inverse, force, w, w, w}, (first + unsigned(n)) % 2);
    return w;
}

std::vector<float> sum(std::vector<float> a, const std::vector<float>& b)
{
    for (std::size_t n = 0; n < a.size(); ++n) a[n] += b[n];
    return a;
}

/// A plate's levels with their rigidities, as prepare() makes them.
struct Levels {
    GridHierarchy           grids;
    std::vector<RoughLevel> levels;

    explicit Levels(const Plate& plate)
        : grids(gridHierarchy(plate, 1, shared::kTailCoarseCells)), levels(grids.levels.size(), RoughLevel(plate))
    {
        for (std::size_t l = 0; l < levels.size(); ++l) {
            levels[l].g = grids.levels[l].plate;
            if (l > 0) levels[l].rigidity = host::coarsened(pair(l - 1), levels[l - 1].rigidity);
        }
    }

    /// Levels l and l + 1.
    [[nodiscard]] LevelPair pair(std::size_t l) const
    {
        const auto& fine = grids.levels[l];
        LevelPair   both(fine.plate, grids.levels[l + 1].plate);
        both.tableX = fine.tableX;
        both.tableZ = fine.tableZ;
        return both;
    }

    /// The coarsest level's answer, in the order of plate_tail.glsl: as many parts as a workgroup has invocations for,
    /// each in four sums.
    template <class Real>
    [[nodiscard]] std::vector<float> coarsest(const std::vector<float>& force, const std::vector<Real>& inverse,
                                              std::size_t lanes) const
    {
        const std::size_t  nodes = nodesOf(levels.back().g);
        const std::size_t  room  = levels.size() > 1 ? nodesOf(levels.front().g) / (2 * nodes) : 0;
        const std::size_t  parts = std::max<std::size_t>(1, std::min(lanes / nodes, 1 + room));
        const std::size_t  share = (nodes + parts - 1) / parts;
        std::vector<float> w(force.size());
        for (std::size_t n = 0; n < w.size(); ++n) {
            const std::size_t row = n % nodes;
            const auto        of  = [&](std::size_t m) { return inverse[m * nodes + row] * Real(force[n - row + m]); };
            Real              total{};
            for (std::size_t part = 0; part < parts; ++part) {
                const std::size_t   end = std::min(nodes, (part + 1) * share);
                std::size_t         m   = part * share;
                std::array<Real, 4> sums{};
                for (; m + 4 <= end; m += 4)
                    for (std::size_t k = 0; k < 4; ++k) sums[k] += of(m + k);
                for (; m < end; ++m) sums[0] += of(m);
                const Real  sum  = (sums[0] + sums[1]) + (sums[2] + sums[3]);
                const float high = float(sum);
                total += part == 0 ? sum : Real(high) + Real(float(sum - Real(high)));
            }
            w[n] = float(total);
        }
        return w;
    }

    /// The cycle from level l down, pass by pass; `inverse` of the coarsest level column after column.
    template <class Real>
    [[nodiscard]] std::vector<float> cycle(std::size_t l, const std::vector<float>& force,
                                           const std::vector<Real>& inverse, int sweeps, std::size_t lanes) const
    {
        const RoughLevel& level = levels[l];
        if (l + 1 == levels.size()) return coarsest(force, inverse, lanes);
        std::vector<float> w(force.size(), 0.0F);
        w                     = swept(level, w, force, 0, sweeps);
        const LevelPair both  = pair(l);
        const auto      left  = host::residual(level.g, level.rigidity, force, w);
        const auto      below = cycle(l + 1, host::restricted(both, left), inverse, sweeps, lanes);
        return swept(level, sum(w, host::interpolated(both, below)), force, 1, sweeps);
    }

    /// Nested iteration for one load of a level, pass by pass, to its answer after so many steps.
    /// \param lanes  of the workgroup, which add a dot product
    template <class Real>
    [[nodiscard]] std::vector<float> nested(std::size_t top, const std::vector<float>& load,
                                            const std::vector<Real>& inverse, int steps, std::size_t lanes) const
    {
        if (top + 1 == levels.size()) return coarsest(load, inverse, lanes);
        const RoughLevel&  level = levels[top];
        std::vector<float> x =
            host::interpolated(pair(top), nested(top + 1, host::restricted(pair(top), load), inverse, 1, lanes));
        std::vector<float> r      = host::residual(level.g, level.rigidity, load, x), p(x.size(), 0.0F);
        float              lastRz = 0;
        for (int step = 0; step < steps; ++step) {
            const auto  z    = cycle(top, r, inverse, shared::kNestedSweeps, lanes);
            const float rz   = dotOf(r, z, lanes);
            const float beta = step == 0 ? 0 : rz / lastRz;
            for (std::size_t n = 0; n < z.size(); ++n) p[n] = z[n] + beta * p[n];
            const auto  q     = host::applied(level.g, level.rigidity, p);
            const float alpha = rz / dotOf(p, q, lanes);
            for (std::size_t n = 0; n < z.size(); ++n) {
                x[n] += alpha * p[n];
                r[n] -= alpha * q[n];
            }
            lastRz = rz;
        }
        return x;
    }

private:
    /// In the order of plate_nested.comp: each lane adds its nodes, then lanes are added by kTailSums, then by halves.
    static float dotOf(const std::vector<float>& a, const std::vector<float>& b, std::size_t lanes)
    {
        std::vector<float> sums(lanes, 0.0F);
        for (std::size_t n = 0; n < a.size(); ++n) sums[n % lanes] += a[n] * b[n];
        for (std::size_t n = shared::kTailSums; n < lanes; ++n) sums[n % shared::kTailSums] += sums[n];
        for (std::size_t reach = shared::kTailSums / 2; reach > 0; reach /= 2)
            for (std::size_t n = 0; n < reach; ++n) sums[n] += sums[n + reach];
        return sums[0];
    }
};

/// Rigidities and inverse divisors of all levels of a tail, where it has them.
std::pair<std::vector<float>, std::vector<float>> fieldsOf(const Levels& levels, const TailLayout& tail)
{
    std::vector<float> rigidity(tail.nodes, -1.0F), divisor(tail.nodes, -1.0F); // -1 between the levels
    for (std::size_t l = 0; l < levels.levels.size(); ++l) {
        const RoughLevel& level = levels.levels[l];
        std::ranges::copy(level.rigidity, rigidity.begin() + tail.levels[l].field);
        std::ranges::copy(host::inverseDivisor(level.g, level.rigidity), divisor.begin() + tail.levels[l].field);
    }
    return {rigidity, divisor};
}

constexpr int kFinestSweeps = 2; ///< before and after each correction on the finest level

class FusedCycleTest : public PlateShaderTest {
protected:
    /// The last ones need several regions along both axes, with a last one that is cut off.
    static std::vector<Plate> regionPlates()
    {
        using enum Edge;
        std::vector<Plate> all = plates();
        all.push_back(onRoughBed(roughPlate(66, 35, {supported, free, clamped, supported}, 1, 1.3)));
        if (!isSlow()) all.push_back(roughPlate(35, 100, {clamped, clamped, clamped, clamped}));
        return all;
    }

    static std::vector<compute::Workgroup> shapes()
    {
        if (isSlow() || compilesSlowly(context())) return {{256, 1, 1}};
        return {{128, 1, 1}, mostOfRegions()}; // fewer take long to compile
    }

    /// As on hardware, see Shapes in plate_kernels.cpp.
    static compute::Workgroup mostOfRegions() { return {std::min(context().limits().invocations, 1024U), 1, 1}; }

    /// As many as hardware has, and as few as Vulkan's devices have at the least where they are chosen.
    static std::vector<compute::Workgroup> shapesOfTail()
    {
        std::vector<compute::Workgroup> shapes;
        for (const std::uint32_t lanes : {640U, 512U, 256U})
            if (lanes <= context().limits().invocations) shapes.push_back({lanes, 1, 1});
        return shapes;
    }

    /// Sweeps before and after a correction.
    static std::vector<int> sweepCounts()
    {
        if (compilesSlowly(context())) return {2};
        return {1, 2};
    }

    /// \param beyond  nodes on which the result is needed too, on either side of those that a workgroup owns
    static compute::Groups regionsOf(const shared::PlateLevel& g, int sweeps, int beyond)
    {
        const int owned = shared::kRegion - 2 * (sweeps * shared::kRimPerSweep + beyond);
        return {std::uint32_t(g.cellsZ / owned + 1), std::uint32_t(g.cellsX / owned + 1), kLoads};
    }

    static compute::Kernel kernelOf(const compute::KernelCode& code, compute::Workgroup shape, int sweeps)
    {
        const auto constant = std::uint32_t(sweeps);
        return {context(), code, shape, {&constant, 1}};
    }

    static std::vector<double> sizesOf(const std::vector<float>& values)
    {
        const auto all = magnitudes(values);
        return std::vector<double>(values.size(), *std::max_element(all.begin(), all.end()));
    }
};

/// Half as many cells along each side, and a few more.
std::vector<LevelPair> pairsBelow(const Plate& plate)
{
    const int x = plate.grid.cellsX, z = plate.grid.cellsZ;
    return {LevelPair(plate, std::max(3, (x + 1) / 2), std::max(3, (z + 1) / 2)),
            LevelPair(plate, (x + 1) / 2 + 1, std::max(3, z - 1))};
}

/// What a sum of residuals is relative to, at each coarse node.
std::vector<double> gatheredSizes(const std::vector<double>& sizes, std::size_t count)
{
    constexpr double kWeights = 4; // about: of the absolute weights along both axes [1]
    return std::vector<double>(count, kWeights * *std::ranges::max_element(sizes));
}

TEST_F(FusedCycleTest, TheWayDownIsSweepsFromZeroAndTheForcesBelow)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    for (const compute::Workgroup shape : shapes())
        for (const int sweeps : sweepCounts()) {
            const compute::Kernel down = kernelOf(kernels::down(), shape, sweeps);
            for (const Plate& plate : regionPlates())
                for (const LevelPair& pair : pairsBelow(plate)) {
                    SCOPED_TRACE(describe(plate) + " by " + describe(shape) + ", sweeps: " + std::to_string(sweeps));
                    const RoughLevel   level(plate);
                    const auto         force = roughValues<float>(kLoads * nodesOf(level.g), 31);
                    const auto         w     = swept(level, std::vector<float>(force.size(), 0.0F), force, 0, sweeps);
                    const auto         left  = host::residual(level.g, level.rigidity, force, w);
                    const auto         below = host::restricted(pair, left);
                    std::vector<float> measuredW(w.size()), measuredBelow(below.size());
                    dispatchTwice(down,
                                  {in(level.rigidity), in(host::inverseDivisor(level.g, level.rigidity)),
                                   in(pair.tableX), in(pair.tableZ), out(measuredW), out(measuredBelow), in(force)},
                                  shared::TransferPush{level.g, pair.coarse},
                                  regionsOf(level.g, sweeps, shared::kGathered));
                    EXPECT_TRUE(agree(measuredW, w, sizesOf(w), kCycleRounding));
                    EXPECT_TRUE(agree(measuredBelow, below, gatheredSizes(operatorSizes(level, w), below.size()),
                                      kCycleRounding));
                }
        }
}

TEST_F(FusedCycleTest, TheWayDownTakesTheLastStepFirst)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    if (isSlow()) GTEST_SKIP() << "time";
    inEachPrecision([](auto number) {
        using Real                 = decltype(number);
        const compute::Kernel down = kernelOf(kernels::downUpdating<Real>(), mostOfRegions(), kFinestSweeps);
        for (const Plate& plate : regionPlates()) {
            SCOPED_TRACE(describe(plate));
            const RoughLevel        level(plate);
            const LevelPair         pair  = pairsBelow(plate).front();
            const std::size_t       nodes = nodesOf(level.g), count = kLoads * nodes;
            const std::vector<Real> p = roughValues<Real>(count, 91), q = roughValues<Real>(count, 92),
                                    r     = roughValues<Real>(count, 93),
                                    state = roughValues<Real>(kLoads * std::size_t(shared::kStateWords), 94);
            std::vector<Real>  x = roughValues<Real>(count, 95), newX = x, rest = r;
            std::vector<float> force(count);
            for (std::size_t n = 0; n < count; ++n) {
                const Real alpha = state[n / nodes * shared::kStateWords + std::size_t(shared::kStateAlpha)];
                newX[n] += alpha * p[n];
                rest[n] -= alpha * q[n];
                force[n] = float(rest[n]);
            }
            const auto         w     = swept(level, std::vector<float>(count, 0.0F), force, 0, kFinestSweeps);
            const auto         below = host::restricted(pair, host::residual(level.g, level.rigidity, force, w));
            std::vector<float> measuredW(count), measuredForce(count), measuredBelow(below.size());
            std::vector<Real>  measuredRest(count);
            dispatchOnce(down,
                         {in(level.rigidity), in(host::inverseDivisor(level.g, level.rigidity)), in(pair.tableX),
                          in(pair.tableZ), out(measuredW), out(measuredBelow), out(measuredForce), in(state), in(p),
                          in(q), in(r), out(measuredRest), inOut(x)},
                         shared::TransferPush{level.g, pair.coarse},
                         regionsOf(level.g, kFinestSweeps, shared::kGathered));
            EXPECT_TRUE(agree(x, newX, std::vector<double>(count, 1), kFusedRounding));
            EXPECT_TRUE(agree(measuredRest, rest, std::vector<double>(count, 1), kFusedRounding));
            EXPECT_TRUE(agree(measuredForce, force, std::vector<double>(count, 1), kFusedRounding));
            EXPECT_TRUE(agree(measuredW, w, sizesOf(w), kCycleRounding));
            EXPECT_TRUE(
                agree(measuredBelow, below, gatheredSizes(operatorSizes(level, w), below.size()), kCycleRounding));
        }
    });
}

TEST_F(FusedCycleTest, TheWayUpAims)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    if (isSlow()) GTEST_SKIP() << "time";
    inEachPrecision([](auto number) {
        using Real                  = decltype(number);
        const compute::Kernel up    = kernelOf(kernels::upAiming<Real>(), mostOfRegions(), kFinestSweeps);
        const int             width = int(mostOfRegions().x);
        for (const Plate& plate : regionPlates())
            for (const std::uint32_t begins : {0U, 2U}) {
                SCOPED_TRACE(describe(plate));
                const RoughLevel  level(plate);
                const LevelPair   pair  = pairsBelow(plate).front();
                const std::size_t nodes = nodesOf(level.g), count = kLoads * nodes;
                const auto        force = roughValues<float>(count, 32), f = roughValues<float>(count, 96);
                const auto        before = roughDeflection<float>(level.g, kLoads, 33);
                const auto        coarse = roughValues<float>(kLoads * nodesOf(pair.coarse), 34);
                const auto        r = roughValues<Real>(count, 97), x = roughValues<Real>(count, 98);
                const auto z = swept(level, sum(before, host::interpolated(pair, coarse)), force, 1, kFinestSweeps);
                std::vector<Real> state = roughValues<Real>(kLoads * std::size_t(shared::kStateWords), 99);
                for (Real& word : state) word = Real(0.5) + std::abs(word);
                const compute::Groups groups   = regionsOf(level.g, kFinestSweeps, 0);
                constexpr int         kOwned   = shared::kRegion - 2 * kFinestSweeps * shared::kRimPerSweep;
                std::vector<Real>     expected = state, sums; // as host::beta() takes them: of (r, z), then of (f, x)
                for (std::size_t load = 0; load < kLoads; ++load)
                    for (const bool ofLoad : {false, true})
                        for (std::uint32_t group = 0; group < groups.x * groups.y; ++group) {
                            std::vector<Real> lanes(static_cast<std::size_t>(width));
                            for (int n = 0; n < kOwned * kOwned; ++n) {
                                const int i = int(group / groups.x) * kOwned + n / kOwned;
                                const int j = int(group % groups.x) * kOwned + n % kOwned;
                                if (i > level.g.cellsX || j > level.g.cellsZ) continue;
                                const std::size_t at = load * nodes + std::size_t(i * (level.g.cellsZ + 1) + j);
                                lanes[std::size_t(n % width)] += ofLoad ? Real(f[at]) * x[at] : r[at] * Real(z[at]);
                            }
                            sums.push_back(host::total(lanes.data(), width, width));
                        }
                host::beta({kLoads, groups.x * groups.y, begins, 0, 0}, sums, width, expected);
                std::vector<Real>          partials(2 * std::size_t(kLoads) * groups.x * groups.y);
                std::vector<std::uint32_t> tickets(kLoads + 2, 0);
                std::vector<float>         measured(count);
                dispatchOnce(up,
                             {in(level.rigidity), in(host::inverseDivisor(level.g, level.rigidity)), in(pair.tableX),
                              in(pair.tableZ), in(force), in(coarse), in(before), out(measured), in(r), in(x), in(f),
                              out(partials), inOut(tickets), inOut(state)},
                             shared::UpPush{level.g, pair.coarse, begins}, groups);
                EXPECT_TRUE(agree(measured, z, sizesOf(z), kCycleRounding));
                // The deflection of which the products are is of floats, in either precision; beta is a product over
                // one of 0.5 or more.
                constexpr double kOfFloats =
                    std::numeric_limits<float>::epsilon() / std::numeric_limits<Real>::epsilon();
                std::vector<double> sizes(state.size(), 0.0);
                for (std::size_t at = 0; at < state.size(); at += std::size_t(shared::kStateWords)) {
                    sizes[at + std::size_t(shared::kStateRz)] = sizes[at + std::size_t(shared::kStateEnergy)] =
                        kOfFloats * double(nodes);
                    sizes[at + std::size_t(shared::kStateBeta)] = 2 * kOfFloats * double(nodes);
                }
                EXPECT_TRUE(agree(state, expected, sizes, kCycleRounding)) << "all other words stay";
                EXPECT_EQ(tickets, std::vector<std::uint32_t>(kLoads + 2, 0)) << "ready for the next dispatch";
            }
    });
}

TEST_F(FusedCycleTest, TheWayUpIsTheCorrectionAndSweeps)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    for (const compute::Workgroup shape : shapes())
        for (const int sweeps : sweepCounts()) {
            const compute::Kernel up = kernelOf(kernels::up(), shape, sweeps);
            for (const Plate& plate : regionPlates()) {
                SCOPED_TRACE(describe(plate) + " by " + describe(shape) + ", sweeps: " + std::to_string(sweeps));
                const RoughLevel   level(plate);
                const LevelPair    pair(plate, (level.g.cellsX + 1) / 2 + 1, (level.g.cellsZ + 1) / 2 + 1);
                const auto         force  = roughValues<float>(kLoads * nodesOf(level.g), 32);
                const auto         before = roughDeflection<float>(level.g, kLoads, 33);
                const auto         coarse = roughValues<float>(kLoads * nodesOf(pair.coarse), 34);
                const auto         w = swept(level, sum(before, host::interpolated(pair, coarse)), force, 1, sweeps);
                std::vector<float> measured(w.size());
                dispatchTwice(up,
                              {in(level.rigidity), in(host::inverseDivisor(level.g, level.rigidity)), in(pair.tableX),
                               in(pair.tableZ), in(force), in(coarse), in(before), out(measured)},
                              shared::TransferPush{level.g, pair.coarse}, regionsOf(level.g, sweeps, 0));
                EXPECT_TRUE(agree(measured, w, sizesOf(w), kCycleRounding));
            }
        }
}

TEST_F(FusedCycleTest, SweepsTogetherAreThoseOneByOneEverywhereOrInTiles)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    for (const int sweeps : sweepCounts()) {
        const compute::Kernel sweep = kernelOf(kernels::sweep(), mostOfRegions(), sweeps);
        for (const Plate& plate : regionPlates())
            for (const bool tilesOnly : {false, true}) {
                const unsigned first = tilesOnly ? 0 : 1;
                SCOPED_TRACE(describe(plate) + ", sweeps: " + std::to_string(sweeps));
                const RoughLevel  level(plate);
                const std::size_t nodes = nodesOf(level.g), stride = std::size_t(level.g.cellsZ) + 1;
                const auto        force   = roughValues<float>(kLoads * nodes, 41);
                const auto        before  = roughDeflection<float>(level.g, kLoads, 42);
                const auto        inverse = host::inverseDivisor(level.g, level.rigidity);
                const auto        chosen =
                    roughValues<float>(std::size_t(shared::tilesX(level.g) * shared::tilesZ(level.g)), 43);
                std::vector<std::uint32_t> marks(chosen.size());
                std::ranges::transform(chosen, marks.begin(), [](float value) { return value > 0 ? 1U : 0U; });
                std::vector<float> w = before;
                for (int n = 0; n < 2 * sweeps; ++n) {
                    const auto next = host::relaxed(level, {inverse, force, w, w, w}, (first + unsigned(n)) % 2);
                    for (std::size_t at = 0; at < w.size(); ++at) {
                        const int tileI = int(at % nodes / stride) / shared::kTile,
                                  tileJ = int(at % nodes % stride) / shared::kTile;
                        if (!tilesOnly || marks[std::size_t(tileI * shared::tilesZ(level.g) + tileJ)] == 1)
                            w[at] = next[at];
                    }
                }
                std::vector<float> measured(w.size());
                dispatchTwice(sweep, {in(level.rigidity), in(inverse), in(force), in(marks), in(before), out(measured)},
                              shared::SweepPush{level.g, first, tilesOnly ? 1U : 0U}, regionsOf(level.g, sweeps, 0));
                EXPECT_TRUE(agree(measured, w, sizesOf(w), kCycleRounding));
            }
    }
}

TEST_F(FusedCycleTest, TheTailIsAWholeCycle)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    if (isSlow()) GTEST_SKIP() << "with every access checked this kernel takes two minutes to compile";
    using enum Edge;
    const std::vector<Plate> all{onRoughBed(roughPlate(16, 11, {clamped, free, supported, clamped})), // two levels
                                 roughPlate(32, 32, {clamped, clamped, clamped, clamped}),            // three
                                 roughPlate(32, 17, {supported, supported, free, clamped}, 1, 1.9),
                                 roughPlate(7, 8, {free, clamped, free, free})}; // one
    if (compilesSlowly(context())) GTEST_SKIP() << kCompilesSlowly;
    inEachPrecision([&](auto number) {
        using Real = decltype(number);
        for (const compute::Workgroup shape : shapesOfTail())
            for (const int sweeps : sweepCounts()) {
                const compute::Kernel kernel = kernelOf(kernels::tail<Real>(), shape, sweeps);
                for (const Plate& plate : all) {
                    const Levels     levels(plate);
                    const TailLayout tail = tailLayout(levels.grids);
                    ASSERT_EQ(tail.first, 0u);
                    const auto [rigidity, divisor] = fieldsOf(levels, tail);
                    const std::size_t coarsest     = nodesOf(levels.levels.back().g);
                    const auto        inverse      = roughValues<Real>(coarsest * coarsest, 35);
                    for (std::size_t first = 0; first < levels.levels.size(); ++first) {
                        SCOPED_TRACE(describe(plate) + " by " + describe(shape) +
                                     ", sweeps: " + std::to_string(sweeps) + ", from level " + std::to_string(first));
                        const auto         force    = roughValues<float>(kLoads * nodesOf(levels.levels[first].g), 36);
                        const auto         expected = levels.cycle(first, force, inverse, sweeps, shape.x);
                        std::vector<float> measured(expected.size()), aside(kLoads * tail.nodes, 0.0F);
                        dispatchTwice(
                            kernel,
                            {in(tail.levels), in(rigidity), in(divisor), in(tail.tablesX), in(tail.tablesZ),
                             in(inverse), in(force), inOut(aside), out(measured)},
                            shared::TailPush{std::uint32_t(first), std::uint32_t(tail.levels.size()), tail.nodes},
                            {1, 1, kLoads});
                        EXPECT_TRUE(agree(measured, expected, sizesOf(expected), kCycleRounding));
                    }
                }
            }
    });
}

TEST_F(FusedCycleTest, NestedIterationIsItsPasses)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    if (isSlow()) GTEST_SKIP() << "with every access checked this kernel takes minutes to compile";
    if (compilesSlowly(context())) GTEST_SKIP() << kCompilesSlowly;
    using enum Edge;
    inEachPrecision([&](auto number) {
        using Real = decltype(number);
        for (const compute::Workgroup shape : shapesOfTail()) {
            const compute::Kernel kernel(context(), kernels::nested<Real>(), shape);
            for (const Plate& plate :
                 {onRoughBed(roughPlate(16, 11, {clamped, free, supported, clamped})), // two levels
                  roughPlate(32, 32, {clamped, clamped, clamped, clamped}),            // three
                  roughPlate(32, 17, {supported, supported, free, clamped}, 1, 1.9)}) {
                const Levels     levels(plate);
                const TailLayout tail = tailLayout(levels.grids);
                ASSERT_EQ(tail.first, 0u);
                const auto [rigidity, divisor] = fieldsOf(levels, tail);
                const std::size_t coarsest     = nodesOf(levels.levels.back().g);
                std::vector<Real> inverse      = roughValues<Real>(coarsest * coarsest, 35);
                for (std::size_t n = 0; n < inverse.size(); ++n)
                    inverse[n] = n % (coarsest + 1) == 0 ? 1 : inverse[n] / 64;
                for (std::size_t top = 0; top < levels.levels.size(); ++top)
                    for (const int steps : {1, 2}) {
                        SCOPED_TRACE(describe(plate) + " by " + describe(shape) + ", from level " +
                                     std::to_string(top) + ", steps: " + std::to_string(steps));
                        const std::size_t  nodes = nodesOf(levels.levels[top].g);
                        const auto         load  = roughValues<float>(kLoads * nodes, 37);
                        std::vector<float> expected;
                        for (auto from = load.begin(); from != load.end(); from += std::ptrdiff_t(nodes)) {
                            const auto one =
                                levels.nested(top, {from, from + std::ptrdiff_t(nodes)}, inverse, steps, shape.x);
                            expected.insert(expected.end(), one.begin(), one.end());
                        }
                        std::vector<float>              measured(expected.size());
                        std::vector<std::vector<float>> fields(5, std::vector<float>(kLoads * tail.nodes, 0.0F));
                        dispatchTwice(kernel,
                                      {in(tail.levels), in(rigidity), in(divisor), in(tail.tablesX), in(tail.tablesZ),
                                       in(inverse), in(load), inOut(fields[0]), out(measured), inOut(fields[1]),
                                       inOut(fields[2]), inOut(fields[3]), inOut(fields[4])},
                                      shared::NestedPush{std::uint32_t(top), std::uint32_t(tail.levels.size()),
                                                         tail.nodes, std::uint32_t(steps)},
                                      {1, 1, kLoads});
                        EXPECT_TRUE(agree(measured, expected, sizesOf(expected), kCycleRounding));
                    }
            }
        }
    });
}

TEST(TailLayout, TakesTheLevelsOfUpTo32CellsAndFitsTheKernel)
{
    const auto layoutOf = [](int cellsX, int cellsZ, double spacingX) {
        Plate plate;
        plate.grid = {cellsX, cellsZ, spacingX, 1};
        return tailLayout(gridHierarchy(plate, 1, shared::kTailCoarseCells));
    };
    EXPECT_EQ(layoutOf(1024, 1024, 1).first, 5u); // 1024, 512, 256, 128 and 64 cells have dispatches of their own
    EXPECT_EQ(layoutOf(1024, 1024, 1).levels.size(), 3u);
    EXPECT_EQ(layoutOf(32, 32, 1).first, 0u);
    EXPECT_EQ(layoutOf(33, 33, 1).first, 1u);
    for (const double spacingX : {0.1, 0.4, 0.7, 1.0, 1.6, 3.0})
        for (int cellsX = 4; cellsX <= 2048; cellsX += std::max(1, cellsX / 3))
            for (int cellsZ = 4; cellsZ <= 2048; cellsZ += std::max(1, cellsZ / 3)) {
                const TailLayout layout = layoutOf(cellsX, cellsZ, spacingX);
                ASSERT_LE(layout.levels.size(), std::size_t(shared::kTailLevels));
                for (const shared::TailLevel& level : layout.levels) {
                    const int nodes = int(nodesOf(level.plate));
                    ASSERT_LE(level.w + nodes, shared::kTailPool);
                    ASSERT_LE(level.force + nodes, shared::kTailPool);
                    if (layout.levels.size() == 1) break; // the coarsest alone is not relaxed
                    ASSERT_LE(nodes, shared::kTailNodes);
                    ASSERT_LE((level.plate.cellsX + 1) * (level.plate.cellsZ / 2 + 1), shared::kTailHalf);
                }
            }
}

} // namespace
} // namespace palp
