#include <bit>

#include "compute_shaders/shared/footprint_layout.h"
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

/// Loads on few nodes, among them none, one and more than a workgroup, with the words that describe them.
struct Footprints {
    static constexpr std::uint32_t kNodes = 997;

    std::vector<std::uint32_t>                     words;
    std::vector<std::vector<std::array<float, 3>>> numbers; ///< force and changes of each part, by load
    std::vector<std::vector<std::uint32_t>>        nodes;

    Footprints()
    {
        const std::vector<std::size_t> counts{0, 1, 300};
        const auto                     all = roughValues<float>(3 * 301, 70);
        words.resize(shared::kFootprintHead * counts.size());
        std::size_t from = 0;
        for (std::size_t load = 0; load < counts.size(); ++load) {
            words[shared::kFootprintHead * load]     = std::uint32_t(words.size());
            words[shared::kFootprintHead * load + 1] = std::uint32_t(counts[load]);
            numbers.emplace_back();
            nodes.emplace_back();
            for (std::size_t part = 0; part < counts[load]; ++part, from += 3) {
                nodes.back().push_back(std::uint32_t((37 * part + 5) % kNodes));
                numbers.back().push_back({all[from], all[from + 1], all[from + 2]});
                words.push_back(nodes.back().back());
                for (const float number : numbers.back().back()) words.push_back(std::bit_cast<std::uint32_t>(number));
            }
        }
    }
};

constexpr Rounding kResponseRounding{1100, "up to 997 products of the residual and 300 of a load, each of which a "
                                           "driver may fuse with its sum"};

TEST_F(PlateResultTest, AFootprintFeelsItsOwnDeflectionAndWhatTheResidualSaysOfIt)
{
    inEachPrecision([](auto number) {
        using Real = decltype(number);
        const Footprints        given;
        const std::vector<Real> r = roughValues<Real>(kLoads * Footprints::kNodes, 71),
                                x = roughValues<Real>(kLoads * Footprints::kNodes, 72);
        for (const compute::Workgroup shape : {compute::Workgroup{64, 1, 1}, {256, 1, 1}, {8, 1, 1}}) {
            if (isSlow() && shape.x != 64) continue;
            const compute::Kernel kernel(context(), kernels::footprints<Real>(), shape);
            std::vector<Real>     responses(kLoads * shared::kResponseWords);

            dispatchTwice(kernel, {in(r), in(x), in(given.words), out(responses)},
                          shared::VectorPush{Footprints::kNodes, 0, 0}, {1, 1, kLoads});

            std::vector<Real>   expected;
            std::vector<double> sizes;
            for (std::size_t load = 0; load < kLoads; ++load)
                for (std::size_t word = 0; word < shared::kResponseWords; ++word) {
                    std::vector<Real> sums(shape.x);
                    double            size = 0;
                    const auto        add  = [&](std::size_t n, Real term) {
                        sums[n % shape.x] += term;
                        size += std::abs(double(term));
                    };
                    const std::size_t base = load * Footprints::kNodes;
                    for (std::size_t n = 0; word == shared::kResponseWork && n < Footprints::kNodes; ++n)
                        add(n, r[base + n] * x[base + n]);
                    for (std::size_t k = 0; k < given.nodes[load].size(); ++k)
                        add(k, Real(given.numbers[load][k][word]) * x[base + given.nodes[load][k]]);
                    expected.push_back(host::total(sums.data(), sums.size(), shape.x));
                    sizes.push_back(size);
                }
            EXPECT_TRUE(agree(responses, expected, sizes, kResponseRounding)) << describe(shape);
        }
    });
}

} // namespace
} // namespace palp
