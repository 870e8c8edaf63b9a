#include <limits>

#include "tests/plate/kernels/plate_shader_test.h"

// Tests of Chebyshev's iteration: plate_smooth.comp and plate_smooth_first.comp.

namespace palp {
namespace {

class PlateSmoothTest : public PlateShaderTest {
protected:
    /// Fields that are all different, so that each must be read where it should.
    static host::SmoothStep fieldsOf(const RoughLevel& level, float ahead)
    {
        host::SmoothStep fields;
        fields.inverseDivisor = host::inverseDivisor(level.g, level.rigidity);
        fields.before         = roughDeflection<float>(level.g, kLoads, 21);
        fields.force          = roughValues<float>(fields.before.size(), 22);
        fields.after          = roughDeflection<float>(level.g, kLoads, 23);
        fields.ahead          = ahead;
        fields.step           = 0.7F;
        return fields;
    }

    /// One step by a kernel; faults that the guard bands find are appended.
    static std::vector<float> smoothedBy(const compute::Kernel& smooth, const RoughLevel& level,
                                         const host::SmoothStep& fields, std::vector<std::string>& faults)
    {
        std::vector<float> after = fields.after;
        const auto         found = dispatchGuarded(
                    context(), smooth,
                    {in(level.rigidity), in(fields.inverseDivisor), in(fields.force), in(fields.before), inOut(after)},
                    shared::SmoothPush{level.g, fields.ahead, fields.step}, groupsOver(smooth, level.g, kLoads));
        faults.insert(faults.end(), found.begin(), found.end());
        return after;
    }

    /// For each node what was added up there.
    static std::vector<double> sizesOf(const RoughLevel& level, const host::SmoothStep& fields)
    {
        std::vector<double> sizes = operatorSizes(level, fields.before);
        const std::size_t   nodes = nodesOf(level.g);
        for (std::size_t n = 0; n < sizes.size(); ++n)
            sizes[n] = 2 * std::abs(double(fields.before[n])) + std::abs(double(fields.after[n])) +
                       (std::abs(double(fields.force[n])) + sizes[n]) * double(fields.inverseDivisor[n % nodes]);
        return sizes;
    }
};

TEST_F(PlateSmoothTest, AStepIsThatOfCxx)
{
    for (const compute::Workgroup shape : tiles()) {
        const compute::Kernel smooth(context(), kernels::smooth(), shape);
        for (const Plate& plate : plates())
            for (const float ahead : {0.0F, 0.3F}) {
                SCOPED_TRACE(describe(plate) + " by " + describe(shape));
                const RoughLevel         level(plate);
                const host::SmoothStep   fields = fieldsOf(level, ahead);
                std::vector<std::string> faults;

                const std::vector<float> after = smoothedBy(smooth, level, fields, faults);

                EXPECT_EQ(faults, std::vector<std::string>{});
                EXPECT_TRUE(agree(after, host::smoothed(level, fields), sizesOf(level, fields), kOperatorRounding));
                host::forEachNode(level.g, kLoads, [&](int i, int j, std::size_t n, std::size_t) {
                    if (holds(level.g, i, j)) {
                        EXPECT_EQ(after[n], 0.0F) << "held";
                    }
                });
            }
    }
}

// Memory that a failed solve has left must not spoil the next one.
TEST_F(PlateSmoothTest, TheFirstStepDoesNotLookAtWhatWasThereBefore)
{
    const compute::Kernel    smooth(context(), kernels::smooth(), {8, 8, 1});
    const RoughLevel         level(plates()[1]);
    host::SmoothStep         fields = fieldsOf(level, 0);
    std::vector<std::string> faults;
    const std::vector<float> clean = smoothedBy(smooth, level, fields, faults);

    fields.after.assign(fields.after.size(), std::numeric_limits<float>::quiet_NaN());
    EXPECT_EQ(smoothedBy(smooth, level, fields, faults), clean);

    fields.ahead = 0.3F; // a later one does
    EXPECT_NE(smoothedBy(smooth, level, fields, faults), clean);
    EXPECT_EQ(faults, std::vector<std::string>{});
}

TEST_F(PlateSmoothTest, AStepFromZeroIsTheFirstOne)
{
    for (const compute::Workgroup shape : tiles()) {
        const compute::Kernel first(context(), kernels::smoothFirst(), shape);
        for (const Plate& plate : plates()) {
            SCOPED_TRACE(describe(plate) + " by " + describe(shape));
            const RoughLevel   level(plate);
            host::SmoothStep   fields = fieldsOf(level, 0);
            std::vector<float> before = fields.before, after = fields.after;

            dispatchTwice(first, {in(fields.inverseDivisor), in(fields.force), out(before), out(after)},
                          shared::SmoothPush{level.g, 0, fields.step}, groupsOver(first, level.g, kLoads));

            fields.before.assign(fields.before.size(), 0);
            EXPECT_EQ(before, fields.before);
            // Two products, then, in C++, a sum with 0: nothing to round differently. Zeroes may differ in sign.
            const std::vector<float> expected = host::smoothed(level, fields);
            for (std::size_t n = 0; n < after.size(); ++n) EXPECT_EQ(after[n], expected[n]) << n;
        }
    }
}

} // namespace
} // namespace palp
