#include <algorithm>

#include "compute_shaders/shared/float_pair.h"
#include "compute_shaders/shared/region_layout.h"
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

    explicit Levels(const Plate& plate) : grids(gridHierarchy(plate, 1)), levels(grids.levels.size(), RoughLevel(plate))
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

    /// The cycle from level l down, pass by pass; `inverse` of the coarsest level column after column.
    [[nodiscard]] std::vector<float> cycle(std::size_t l, const std::vector<float>& force,
                                           const std::vector<shared::FloatPair>& inverse, int sweeps) const
    {
        const RoughLevel&  level = levels[l];
        const std::size_t  nodes = nodesOf(level.g);
        std::vector<float> w(force.size(), 0.0F);
        if (l + 1 == levels.size()) {
            for (std::size_t n = 0; n < w.size(); ++n) {
                shared::FloatPair total{0, 0};
                for (std::size_t m = 0; m < nodes; ++m)
                    total = shared::plusProduct(total, inverse[m * nodes + n % nodes], force[n - n % nodes + m]);
                w[n] = total.high;
            }
            return w;
        }
        w                     = swept(level, w, force, 0, sweeps);
        const LevelPair both  = pair(l);
        const auto      left  = host::residual(level.g, level.rigidity, force, w);
        const auto      below = cycle(l + 1, host::restricted(both, left), inverse, sweeps);
        return swept(level, sum(w, host::interpolated(both, below)), force, 1, sweeps);
    }
};

/// Numbers with 48 digits.
std::vector<shared::FloatPair> roughPairs(std::size_t count, unsigned seed)
{
    const auto                     high = roughValues<float>(count, seed), low = roughValues<float>(count, seed + 1);
    std::vector<shared::FloatPair> pairs;
    for (std::size_t n = 0; n < count; ++n) pairs.push_back({high[n], high[n] * low[n] * 1e-8F});
    return pairs;
}

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
        return {{128, 1, 1}, {256, 1, 1}}; // fewer take long to compile
    }

    /// As many as hardware has, and as few as Vulkan's devices have at the least where they are chosen.
    static std::vector<compute::Workgroup> shapesOfTail()
    {
        std::vector<compute::Workgroup> shapes;
        for (const std::uint32_t lanes : {1024U, 256U})
            if (lanes <= context().limits().invocations) shapes.push_back({lanes, 1, 1});
        return shapes;
    }

    /// Sweeps before and after a correction.
    static std::vector<int> sweepCounts()
    {
        if (compilesSlowly(context())) return {2};
        return {1, 2};
    }

    static compute::Groups regionsOf(const shared::PlateLevel& g, int sweeps)
    {
        const int owned = shared::kRegion - 2 * sweeps * shared::kRimPerSweep;
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

TEST_F(FusedCycleTest, TheWayDownIsSweepsFromZeroAndTheResidual)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    for (const compute::Workgroup shape : shapes())
        for (const int sweeps : sweepCounts()) {
            const compute::Kernel down = kernelOf(kernels::down(), shape, sweeps);
            for (const Plate& plate : regionPlates()) {
                SCOPED_TRACE(describe(plate) + " by " + describe(shape) + ", sweeps: " + std::to_string(sweeps));
                const RoughLevel   level(plate);
                const auto         force = roughValues<float>(kLoads * nodesOf(level.g), 31);
                const auto         w     = swept(level, std::vector<float>(force.size(), 0.0F), force, 0, sweeps);
                const auto         left  = host::residual(level.g, level.rigidity, force, w);
                std::vector<float> measuredW(w.size()), measuredLeft(w.size());
                dispatchTwice(down,
                              {in(level.rigidity), in(host::inverseDivisor(level.g, level.rigidity)), in(force),
                               out(measuredW), out(measuredLeft)},
                              shared::LevelPush{level.g}, regionsOf(level.g, sweeps));
                EXPECT_TRUE(agree(measuredW, w, sizesOf(w), kCycleRounding));
                EXPECT_TRUE(agree(measuredLeft, left, operatorSizes(level, w), kCycleRounding));
            }
        }
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
                              {in(level.rigidity), in(host::inverseDivisor(level.g, level.rigidity)), in(force),
                               in(pair.tableX), in(pair.tableZ), in(coarse), in(before), out(measured)},
                              shared::TransferPush{level.g, pair.coarse}, regionsOf(level.g, sweeps));
                EXPECT_TRUE(agree(measured, w, sizesOf(w), kCycleRounding));
            }
        }
}

TEST_F(FusedCycleTest, TheTailIsAWholeCycle)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    if (isSlow()) GTEST_SKIP() << "with every access checked this kernel takes two minutes to compile";
    using enum Edge;
    const std::vector<Plate> all{onRoughBed(roughPlate(40, 26, {clamped, free, supported, clamped})), // two levels
                                 roughPlate(64, 64, {clamped, clamped, clamped, clamped}),            // three
                                 roughPlate(64, 33, {supported, supported, free, clamped}, 1, 1.9),
                                 roughPlate(9, 12, {free, clamped, free, free})}; // one
    if (compilesSlowly(context())) GTEST_SKIP() << kCompilesSlowly;
    for (const compute::Workgroup shape : shapesOfTail())
        for (const int sweeps : sweepCounts()) {
            const compute::Kernel kernel = kernelOf(kernels::tail(), shape, sweeps);
            for (const Plate& plate : all) {
                const Levels     levels(plate);
                const TailLayout tail = tailLayout(levels.grids);
                ASSERT_EQ(tail.first, 0u);
                std::vector<float> rigidity(tail.nodes, -1.0F), divisor(tail.nodes, -1.0F); // -1 between the levels
                for (std::size_t l = 0; l < levels.levels.size(); ++l) {
                    const RoughLevel& level = levels.levels[l];
                    std::ranges::copy(level.rigidity, rigidity.begin() + tail.levels[l].field);
                    std::ranges::copy(host::inverseDivisor(level.g, level.rigidity),
                                      divisor.begin() + tail.levels[l].field);
                }
                const std::size_t coarsest = nodesOf(levels.levels.back().g);
                const auto        inverse  = roughPairs(coarsest * coarsest, 35);
                for (std::size_t first = 0; first < levels.levels.size(); ++first) {
                    SCOPED_TRACE(describe(plate) + " by " + describe(shape) + ", sweeps: " + std::to_string(sweeps) +
                                 ", from level " + std::to_string(first));
                    const auto         force    = roughValues<float>(kLoads * nodesOf(levels.levels[first].g), 36);
                    const auto         expected = levels.cycle(first, force, inverse, sweeps);
                    std::vector<float> measured(expected.size()), aside(kLoads * tail.nodes, 0.0F);
                    dispatchTwice(kernel,
                                  {in(tail.levels), in(rigidity), in(divisor), in(tail.tablesX), in(tail.tablesZ),
                                   in(inverse), in(force), inOut(aside), out(measured)},
                                  shared::TailPush{std::uint32_t(first), std::uint32_t(tail.levels.size()), tail.nodes},
                                  {1, 1, kLoads});
                    EXPECT_TRUE(agree(measured, expected, sizesOf(expected), kCycleRounding));
                }
            }
        }
}

TEST(TailLayout, TakesTheLevelsOfUpTo64CellsAndFitsTheKernel)
{
    const auto layoutOf = [](int cellsX, int cellsZ, double spacingX) {
        Plate plate;
        plate.grid = {cellsX, cellsZ, spacingX, 1};
        return tailLayout(gridHierarchy(plate, 1));
    };
    EXPECT_EQ(layoutOf(1024, 1024, 1).first, 4u); // 1024, 512, 256 and 128 cells have dispatches of their own
    EXPECT_EQ(layoutOf(1024, 1024, 1).levels.size(), 3u);
    EXPECT_EQ(layoutOf(64, 64, 1).first, 0u);
    EXPECT_EQ(layoutOf(65, 65, 1).first, 1u);
    for (const double spacingX : {0.1, 0.4, 0.7, 1.0, 1.6, 3.0})
        for (int cellsX = 8; cellsX <= 2048; cellsX += cellsX / 3)
            for (int cellsZ = 8; cellsZ <= 2048; cellsZ += cellsZ / 3) {
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
