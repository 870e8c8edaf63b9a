#include "tests/plate/kernels/plate_shader_test.h"

// Tests of the kernels that apply the operator: plate_apply.comp and the variants of plate_residual.comp.

namespace palp {
namespace {

class PlateApplyTest : public PlateShaderTest {};
class PlateResidualTest : public PlateShaderTest {
protected:
    template <class Real>
    static std::vector<double> sizesOf(const RoughLevel& level, const std::vector<float>& force,
                                       const std::vector<Real>& w)
    {
        std::vector<double> sizes = operatorSizes(level, w);
        for (std::size_t n = 0; n < sizes.size(); ++n) sizes[n] += std::abs(double(force[n]));
        return sizes;
    }
};

TEST_F(PlateApplyTest, EveryShapeOfWorkgroupComputesWhatCxxDoes)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        for (const compute::Workgroup shape : tiles()) {
            const compute::Kernel apply(context(), kernels::apply<Real>(), shape);
            for (const Plate& plate : plates()) {
                SCOPED_TRACE(describe(plate) + " by " + describe(shape));
                const RoughLevel        level(plate);
                const std::vector<Real> w = roughDeflection<Real>(level.g, kLoads, 1);
                std::vector<Real>       forces(w.size());

                dispatchTwice(apply, {in(level.rigidity), in(w), out(forces)}, shared::LevelPush{level.g},
                              groupsOver(apply, level.g, kLoads));

                EXPECT_TRUE(agree(forces, host::applied(level.g, level.rigidity, w), operatorSizes(level, w),
                                  kOperatorRounding));
            }
        }
    });
}

TEST_F(PlateApplyTest, RepeatsAreEqualToTheBit)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        const compute::Kernel   apply(context(), kernels::apply<Real>(), {64, 1, 1});
        const RoughLevel        level(plates()[1]);
        const std::vector<Real> w = roughDeflection<Real>(level.g, kLoads, 2);
        std::vector<Real>       first(w.size()), again(w.size());
        const auto              run = [&](std::vector<Real>& forces) {
            dispatchOnce(apply, {in(level.rigidity), in(w), out(forces)}, shared::LevelPush{level.g},
                                      groupsOver(apply, level.g, kLoads));
        };

        run(first);
        for (int n = 0; n < 5; ++n) {
            run(again);
            EXPECT_EQ(first, again);
        }
    });
}

// The tolerance of processors that are not bit-exact, tried where there is none: floats against doubles round in every
// operation, which is more than fusing some of them changes.
TEST_F(PlateApplyTest, FloatsAreWithinTheRoundingOfDoubles)
{
    for (const Plate& plate : plates()) {
        const RoughLevel          level(plate);
        const std::vector<float>  w = roughDeflection<float>(level.g, kLoads, 3);
        const std::vector<double> exact =
            host::applied(level.g, level.rigidity, std::vector<double>(w.begin(), w.end()));

        const std::vector<float> forces = host::applied(level.g, level.rigidity, w);

        EXPECT_TRUE(isWithin(forces, std::vector<float>(exact.begin(), exact.end()), operatorSizes(level, w),
                             kOperatorRounding))
            << describe(plate);
    }
}

TEST_F(PlateResidualTest, EveryShapeOfWorkgroupComputesWhatCxxDoes)
{
    for (const compute::Workgroup shape : tiles()) {
        const compute::Kernel residual(context(), kernels::residual(), shape);
        for (const Plate& plate : plates()) {
            SCOPED_TRACE(describe(plate) + " by " + describe(shape));
            const RoughLevel         level(plate);
            const std::vector<float> w     = roughDeflection<float>(level.g, kLoads, 4);
            const std::vector<float> force = roughValues<float>(w.size(), 5); // on held nodes too
            std::vector<float>       left(w.size());

            dispatchTwice(residual, {in(level.rigidity), in(force), in(w), out(left)}, shared::LevelPush{level.g},
                          groupsOver(residual, level.g, kLoads));

            EXPECT_TRUE(agree(left, host::residual(level.g, level.rigidity, force, w), sizesOf(level, force, w),
                              kOperatorRounding));
        }
    }
}

TEST_F(PlateResidualTest, TheStartOfConjugateGradientsKeepsItInFullAndRounded)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        for (const compute::Workgroup shape : tiles()) {
            const compute::Kernel start(context(), kernels::start<Real>(), shape);
            for (const Plate& plate : plates()) {
                SCOPED_TRACE(describe(plate) + " by " + describe(shape));
                const RoughLevel         level(plate);
                const std::vector<Real>  w     = roughDeflection<Real>(level.g, kLoads, 6);
                const std::vector<float> force = roughValues<float>(w.size(), 7);
                std::vector<Real>        left(w.size());
                std::vector<float>       rounded(w.size());

                dispatchTwice(start, {in(level.rigidity), in(force), in(w), out(left), out(rounded)},
                              shared::LevelPush{level.g}, groupsOver(start, level.g, kLoads));

                EXPECT_TRUE(agree(left, host::residual(level.g, level.rigidity, force, w), sizesOf(level, force, w),
                                  kOperatorRounding));
                EXPECT_EQ(rounded, std::vector<float>(left.begin(), left.end())) << "rounded to nearest";
            }
        }
    });
}

TEST_F(PlateResidualTest, RepeatsAreEqualToTheBit)
{
    const compute::Kernel    residual(context(), kernels::residual(), {8, 8, 1});
    const RoughLevel         level(plates()[1]);
    const std::vector<float> w     = roughDeflection<float>(level.g, kLoads, 8);
    const std::vector<float> force = roughValues<float>(w.size(), 9);
    std::vector<float>       first(w.size()), again(w.size());
    const auto               run = [&](std::vector<float>& left) {
        dispatchOnce(residual, {in(level.rigidity), in(force), in(w), out(left)}, shared::LevelPush{level.g},
                                   groupsOver(residual, level.g, kLoads));
    };

    run(first);
    for (int n = 0; n < 5; ++n) {
        run(again);
        EXPECT_EQ(first, again);
    }
}

} // namespace
} // namespace palp
