#include "tests/plate/kernels/plate_shader_test.h"

namespace palp {
namespace {

class PlateResultTest : public PlateShaderTest {};

TEST_F(PlateResultTest, IsInMetresPerLoad) // shown in tests/README.md
{
    const compute::Kernel    result(context(), kernels::result<float>(), {64, 1, 1});
    const std::vector<float> answer = roughValues<float>(2 * 997, 60), metres{1e-3F, 2.5F};
    std::vector<float>       w(answer.size()), expected;
    for (std::size_t n = 0; n < w.size(); ++n) expected.push_back(answer[n] * metres[n / 997]);

    dispatchOnce(result, {in(answer), in(metres), out(w)}, shared::VectorPush{997, 0, 0}, result.groupsOver(997, 1, 2));

    EXPECT_TRUE(agree(w, expected, {0, "one product: there is nothing to fuse"}));
}

TEST_F(PlateResultTest, IsRoundedBeforeItIsScaledWhateverTheShapeOfTheWorkgroup)
{
    inEachPrecision([](auto number) {
        using Real                      = decltype(number);
        const std::vector<Real>  answer = roughValues<Real>(kLoads * 997, 61);
        const std::vector<float> metres{1e-3F, 2.5F, 7e5F};
        std::vector<float>       expected;
        for (std::size_t n = 0; n < answer.size(); ++n) expected.push_back(float(answer[n]) * metres[n / 997]);
        for (const compute::Workgroup shape : lines()) {
            const compute::Kernel result(context(), kernels::result<Real>(), shape);
            std::vector<float>    w(answer.size());

            dispatchTwice(result, {in(answer), in(metres), out(w)}, shared::VectorPush{997, 0, 0},
                          result.groupsOver(997, 1, kLoads));

            EXPECT_TRUE(agree(w, expected, {0, "one product: there is nothing to fuse"})) << describe(shape);
        }
    });
}

} // namespace
} // namespace palp
