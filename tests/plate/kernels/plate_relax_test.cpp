#include <array>
#include <cstring>

#include "engine/compute/command_list.h"
#include "tests/plate/kernels/plate_relax_as_it_is.spv.h"
#include "tests/plate/kernels/plate_relax_both_colours.spv.h"
#include "tests/plate/kernels/plate_relax_new_same.spv.h"
#include "tests/plate/kernels/plate_relax_short.spv.h"
#include "tests/plate/kernels/plate_relax_stale_other.spv.h"
#include "tests/plate/kernels/plate_shader_test.h"

// Tests of relaxation: plate_relax.comp, plate_relax_first.comp and plate_divisor.comp.

namespace palp {
namespace {

constexpr UlpTolerance kDivisorTolerance{128,
                                         "an entry of the row is a sum of some ten products, of which a driver may "
                                         "fuse or reorder any, and up to nine entries are added; division is good "
                                         "to 2.5 ulp only"};

class PlateRelaxTest : public PlateShaderTest {
protected:
    /// Fields of a half sweep that are all different, so that each must be read where it should.
    static host::HalfSweep fieldsOf(const RoughLevel& level, int loads)
    {
        host::HalfSweep fields;
        fields.inverseDivisor = host::inverseDivisor(level.g, level.rigidity);
        fields.same           = roughDeflection<float>(level.g, loads, 11);
        fields.other          = roughDeflection<float>(level.g, loads, 12);
        fields.force          = roughValues<float>(fields.same.size(), 13);
        fields.after          = roughValues<float>(fields.same.size(), 14);
        return fields;
    }

    static compute::Groups everySecondNode(const compute::Kernel& kernel, const shared::PlateLevel& g, int loads)
    {
        return kernel.groupsOver(std::uint32_t(g.cellsZ / 2 + 1), std::uint32_t(g.cellsX + 1), std::uint32_t(loads));
    }

    /// One half sweep by a kernel; faults that the guard bands find are appended.
    static std::vector<float> relaxedBy(const compute::Kernel& relax, const RoughLevel& level,
                                        const host::HalfSweep& fields, unsigned colour,
                                        std::vector<std::string>& faults)
    {
        const int          loads = int(fields.same.size() / nodesOf(level.g));
        std::vector<float> after = fields.after;
        const auto         found = dispatchGuarded(context(), relax,
                                                   {in(level.rigidity), in(fields.inverseDivisor), in(fields.force),
                                                    in(fields.same), in(fields.other), inOut(after)},
                                                   shared::RelaxPush{level.g, colour}, everySecondNode(relax, level.g, loads));
        faults.insert(faults.end(), found.begin(), found.end());
        return after;
    }

    /// For each node what was added up there.
    static std::vector<double> sizesOf(const RoughLevel& level, const host::HalfSweep& fields)
    {
        std::vector<double> sizes = operatorSizes(level, fields.same);
        const auto          other = operatorSizes(level, fields.other); // not less than its share of the nodes
        const std::size_t   nodes = nodesOf(level.g);
        for (std::size_t n = 0; n < sizes.size(); ++n)
            sizes[n] =
                std::abs(double(fields.after[n])) + std::abs(double(fields.same[n])) +
                (std::abs(double(fields.force[n])) + sizes[n] + other[n]) * double(fields.inverseDivisor[n % nodes]);
        return sizes;
    }
};

TEST_F(PlateRelaxTest, AHalfSweepRelaxesItsColourAsCxxDoesAndLeavesTheOther)
{
    for (const compute::Workgroup shape : tiles()) {
        const compute::Kernel relax(context(), kernels::relax(), shape);
        for (const Plate& plate : plates())
            for (const unsigned colour : {0U, 1U}) {
                SCOPED_TRACE(describe(plate) + ", colour " + std::to_string(colour) + " by " + describe(shape));
                const RoughLevel         level(plate);
                const host::HalfSweep    fields = fieldsOf(level, kLoads);
                std::vector<std::string> faults;

                const std::vector<float> after = relaxedBy(relax, level, fields, colour, faults);

                EXPECT_EQ(faults, std::vector<std::string>{});
                EXPECT_TRUE(
                    agree(after, host::relaxed(level, fields, colour), sizesOf(level, fields), kOperatorRounding));
                host::forEachNode(level.g, kLoads, [&](int i, int j, std::size_t n, std::size_t) {
                    if ((unsigned(i + j) & 1U) != colour) {
                        EXPECT_EQ(after[n], fields.after[n]) << "untouched";
                    } else if (holds(level.g, i, j)) {
                        EXPECT_EQ(after[n], 0.0F) << "held";
                    }
                });
            }
    }
}

TEST_F(PlateRelaxTest, AHalfSweepFromZeroIsTheFirstOne)
{
    for (const compute::Workgroup shape : tiles()) {
        const compute::Kernel first(context(), kernels::relaxFirst(), shape);
        for (const Plate& plate : plates())
            for (const unsigned colour : {0U, 1U}) {
                SCOPED_TRACE(describe(plate) + ", colour " + std::to_string(colour) + " by " + describe(shape));
                const RoughLevel level(plate);
                host::HalfSweep  fields  = fieldsOf(level, kLoads);
                fields.same              = std::vector<float>(fields.same.size());
                fields.other             = fields.same;
                std::vector<float> after = fields.after;

                dispatchTwice(first, {in(fields.inverseDivisor), in(fields.force), inOut(after)},
                              shared::RelaxPush{level.g, colour}, everySecondNode(first, level.g, kLoads));

                // One product, then, in C++, a sum with 0: nothing to round differently. Zeroes may differ in sign.
                const std::vector<float> expected = host::relaxed(level, fields, colour);
                for (std::size_t n = 0; n < after.size(); ++n) EXPECT_EQ(after[n], expected[n]) << n;
            }
    }
}

// As the solver does it: the second half sweep reads the colour from before the sweep in one buffer, the other from the
// buffer that it writes.
TEST_F(PlateRelaxTest, ASweepInTwoBuffersIsTwoHalfSweeps)
{
    const compute::Kernel        relax(context(), kernels::relax(), {8, 8, 1});
    const RoughLevel             level(plates()[1]);
    host::HalfSweep              fields = fieldsOf(level, kLoads);
    const std::size_t            bytes  = 4 * fields.same.size();
    compute::CommandList         list(context());
    std::vector<compute::Buffer> staging;
    const auto                   onDevice = [&](const std::vector<float>& values) {
        staging.emplace_back(context(), "from the host", 4 * values.size(), compute::Intent::upload);
        std::memcpy(staging.back().mapped(), values.data(), 4 * values.size());
        compute::Buffer there(context(), "field", 4 * values.size(), compute::Intent::processor);
        list.copy(staging.back(), there);
        return there;
    };
    staging.reserve(8); // copies refer to its elements
    const compute::Buffer rigidity = onDevice(level.rigidity), divisor = onDevice(fields.inverseDivisor),
                          force = onDevice(fields.force), before = onDevice(fields.same),
                          after = onDevice(fields.after);
    const compute::Buffer down(context(), "to the host", bytes, compute::Intent::readback);

    const compute::Groups groups = everySecondNode(relax, level.g, kLoads);
    list.dispatch(relax, {rigidity, divisor, force, before, before, after}, shared::RelaxPush{level.g, 0}, groups);
    list.dispatch(relax, {rigidity, divisor, force, before, after, after}, shared::RelaxPush{level.g, 1}, groups);
    list.copy(after, down);
    list.end();
    context().run(list);

    fields.other                      = fields.same;
    fields.after                      = host::relaxed(level, fields, 0);
    fields.other                      = fields.after;
    const std::vector<float> expected = host::relaxed(level, fields, 1);
    down.makeVisibleToHost();
    const auto values = down.as<const float>();
    EXPECT_TRUE(agree(std::vector<float>(values.begin(), values.end()), expected, sizesOf(level, fields),
                      {2 * kOperatorRounding.units, "two half sweeps, the second of which reads the first"}));
}

TEST_F(PlateRelaxTest, RepeatsAreEqualToTheBit)
{
    const compute::Kernel    relax(context(), kernels::relax(), {16, 4, 1});
    const RoughLevel         level(plates()[1]);
    const host::HalfSweep    fields = fieldsOf(level, kLoads);
    std::vector<std::string> faults;

    const std::vector<float> first = relaxedBy(relax, level, fields, 1, faults);
    for (int n = 0; n < 5; ++n) EXPECT_EQ(first, relaxedBy(relax, level, fields, 1, faults));
    EXPECT_EQ(faults, std::vector<std::string>{});
}

TEST_F(PlateRelaxTest, DivisorsAreThoseOfCxxAndHeldNodesHaveNone)
{
    for (const compute::Workgroup shape : {compute::Workgroup{8, 1, 9}, {16, 1, 9}, {28, 1, 9}}) {
        if (isSlow() && shape.x != 8) continue;
        const compute::Kernel divisor(context(), kernels::divisor(), shape);
        for (const Plate& plate : plates()) {
            SCOPED_TRACE(describe(plate) + " by " + describe(shape));
            const RoughLevel   level(plate);
            std::vector<float> inverse(nodesOf(level.g));

            dispatchTwice(divisor, {in(level.rigidity), out(inverse)}, shared::LevelPush{level.g},
                          groupsOver(divisor, level.g, shared::kEntries));

            EXPECT_TRUE(agree(inverse, host::inverseDivisor(level.g, level.rigidity), kDivisorTolerance));
            host::forEachNode(level.g, 1, [&](int i, int j, std::size_t n, std::size_t) {
                EXPECT_EQ(inverse[n] == 0, holds(level.g, i, j));
            });
        }
    }
}

// The tests above can fail: kernels with one mistake each do not agree with C++, by more than any rounding.
TEST_F(PlateRelaxTest, MistakesAreFound)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernel";
    struct Mistake {
        const char*                    what;
        std::span<const std::uint32_t> spirv;
        bool                           isOne;
    };
    const std::array<Mistake, 5> mistakes{{{"none", plate_relax_as_it_is_spv, false},
                                           {"stale values of the other colour", plate_relax_stale_other_spv, true},
                                           {"new values of the same colour", plate_relax_new_same_spv, true},
                                           {"the last column left out", plate_relax_short_spv, true},
                                           {"the other colour written", plate_relax_both_colours_spv, true}}};
    const RoughLevel             level(plates()[1]); // free on the last column, where mistakes show
    const host::HalfSweep        fields = fieldsOf(level, kLoads);
    for (const Mistake& mistake : mistakes) {
        const compute::Kernel relax(context(), {mistake.what, mistake.spirv, 6, int(sizeof(shared::RelaxPush))},
                                    {8, 8, 1});
        for (const unsigned colour : {0U, 1U}) {
            std::vector<std::string> faults;
            const std::vector<float> after    = relaxedBy(relax, level, fields, colour, faults);
            const std::vector<float> expected = host::relaxed(level, fields, colour);

            EXPECT_EQ(!agree(after, expected, sizesOf(level, fields), kOperatorRounding), mistake.isOne)
                << mistake.what;
            EXPECT_EQ(!isWithin(after, expected, sizesOf(level, fields), kOperatorRounding), mistake.isOne)
                << mistake.what << ", on a processor that is not bit-exact";
        }
    }
}

} // namespace
} // namespace palp
