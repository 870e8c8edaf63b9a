#include "tests/plate/kernels/plate_shader_test.h"

// Tests of the transfers between two levels: plate_restrict.comp, the variants of plate_prolong.comp, and
// rigidity_coarsen.comp.

namespace palp {
namespace {

constexpr UlpTolerance kCoarsenTolerance{24,
                                         "up to four nested square roots, each good to some 5 ulp, of which the outer "
                                         "ones halve"};

class PlateTransferTest : public PlateShaderTest {
protected:
    static shared::TransferPush pushOf(const LevelPair& pair) { return {pair.fine, pair.coarse}; }

    /// Weights are at most 2 in sum: no more than 4 times the largest value, along both axes, and what is added to.
    template <class Real>
    static std::vector<double> sizesOf(std::size_t count, const std::vector<Real>& values, double added = 0)
    {
        const std::vector<double> all = magnitudes(values);
        return std::vector<double>(count, 4 * *std::max_element(all.begin(), all.end()) + added);
    }
};

TEST_F(PlateTransferTest, RestrictionGathersForcesAsCxxDoes)
{
    for (const compute::Workgroup shape : tiles()) {
        const compute::Kernel restriction(context(), kernels::restrict(), shape);
        for (const LevelPair& pair : pairs()) {
            SCOPED_TRACE(describe(pair) + " by " + describe(shape));
            const std::vector<float> fine = roughValues<float>(kLoads * nodesOf(pair.fine), 21);
            std::vector<float>       coarse(kLoads * nodesOf(pair.coarse));

            dispatchTwice(restriction, {in(pair.tableX), in(pair.tableZ), in(fine), out(coarse)}, pushOf(pair),
                          groupsOver(restriction, pair.coarse, kLoads));

            EXPECT_TRUE(agree(coarse, host::restricted(pair, fine), sizesOf(coarse.size(), fine), kTransferRounding));
            host::forEachNode(pair.coarse, kLoads, [&](int i, int j, std::size_t n, std::size_t) {
                EXPECT_TRUE(coarse[n] == 0 || !holds(pair.coarse, i, j)) << "held";
            });
        }
    }
}

TEST_F(PlateTransferTest, ACorrectionIsAddedAsInCxx)
{
    for (const compute::Workgroup shape : tiles()) {
        const compute::Kernel correct(context(), kernels::correct(), shape);
        for (const LevelPair& pair : pairs()) {
            SCOPED_TRACE(describe(pair) + " by " + describe(shape));
            const std::vector<float> coarse = roughDeflection<float>(pair.coarse, kLoads, 22);
            const std::vector<float> before = roughDeflection<float>(pair.fine, kLoads, 23);
            std::vector<float>       after(before.size());

            dispatchTwice(correct, {in(pair.tableX), in(pair.tableZ), in(coarse), out(after), in(before)}, pushOf(pair),
                          groupsOver(correct, pair.fine, kLoads));

            std::vector<float> expected = host::interpolated(pair, coarse);
            for (std::size_t n = 0; n < expected.size(); ++n) expected[n] = before[n] + expected[n];
            EXPECT_TRUE(agree(after, expected, sizesOf(after.size(), coarse, 1), kTransferRounding));
        }
    }
}

TEST_F(PlateTransferTest, AnAnswerIsInterpolatedAsInCxx)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        for (const compute::Workgroup shape : tiles()) {
            const compute::Kernel interpolate(context(), kernels::interpolate<Real>(), shape);
            for (const LevelPair& pair : pairs()) {
                SCOPED_TRACE(describe(pair) + " by " + describe(shape));
                const std::vector<Real> coarse = roughDeflection<Real>(pair.coarse, kLoads, 24);
                std::vector<Real>       fine(kLoads * nodesOf(pair.fine));

                dispatchTwice(interpolate, {in(pair.tableX), in(pair.tableZ), in(coarse), out(fine)}, pushOf(pair),
                              groupsOver(interpolate, pair.fine, kLoads));

                EXPECT_TRUE(
                    agree(fine, host::interpolated(pair, coarse), sizesOf(fine.size(), coarse), kTransferRounding));
                host::forEachNode(pair.fine, kLoads, [&](int i, int j, std::size_t n, std::size_t) {
                    EXPECT_TRUE(fine[n] == 0 || !holds(pair.fine, i, j)) << "held";
                });
            }
        }
    });
}

TEST_F(PlateTransferTest, TheCoarsestAnswerIsInterpolatedFromFloats)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        for (const compute::Workgroup shape : tiles()) {
            const compute::Kernel interpolate(context(), kernels::interpolateFirst<Real>(), shape);
            for (const LevelPair& pair : pairs()) {
                SCOPED_TRACE(describe(pair) + " by " + describe(shape));
                const std::vector<float> coarse = roughDeflection<float>(pair.coarse, kLoads, 25);
                const std::vector<Real>  widened(coarse.begin(), coarse.end());
                std::vector<Real>        fine(kLoads * nodesOf(pair.fine));

                dispatchTwice(interpolate, {in(pair.tableX), in(pair.tableZ), in(coarse), out(fine)}, pushOf(pair),
                              groupsOver(interpolate, pair.fine, kLoads));

                EXPECT_TRUE(
                    agree(fine, host::interpolated(pair, widened), sizesOf(fine.size(), coarse), kTransferRounding));
            }
        }
    });
}

TEST_F(PlateTransferTest, RigidityIsCoarsenedAsInCxx)
{
    const std::vector<Plate>     all     = plates();
    const std::vector<LevelPair> coarser = pairs();
    for (const compute::Workgroup shape : tiles()) {
        const compute::Kernel coarsen(context(), kernels::coarsen(), shape);
        for (const LevelPair& pair : coarser)
            for (const Plate& plate : all) {
                if (plate.grid.cellsX != pair.fine.cellsX || plate.grid.cellsZ != pair.fine.cellsZ) continue;
                SCOPED_TRACE(describe(pair) + " by " + describe(shape));
                const RoughLevel   level(plate);
                std::vector<float> coarse((pair.coarse.shapeAt == 0 ? 1 : 2) * nodesOf(pair.coarse));

                dispatchTwice(coarsen, {in(level.rigidity), out(coarse)}, pushOf(pair),
                              groupsOver(coarsen, pair.coarse, 1));

                EXPECT_TRUE(agree(coarse, host::coarsened(pair, level.rigidity), kCoarsenTolerance));
            }
    }
}

TEST_F(PlateTransferTest, RepeatsAreEqualToTheBit)
{
    const LevelPair          pair = pairs()[1];
    const compute::Kernel    restriction(context(), kernels::restrict(), {64, 1, 1});
    const std::vector<float> fine = roughValues<float>(kLoads * nodesOf(pair.fine), 26);
    std::vector<float>       first(kLoads * nodesOf(pair.coarse)), again(first.size());
    const auto               run = [&](std::vector<float>& coarse) {
        dispatchOnce(restriction, {in(pair.tableX), in(pair.tableZ), in(fine), out(coarse)}, pushOf(pair),
                                   groupsOver(restriction, pair.coarse, kLoads));
    };

    run(first);
    for (int n = 0; n < 5; ++n) {
        run(again);
        EXPECT_EQ(first, again);
    }
}

} // namespace
} // namespace palp
