#include <algorithm>
#include <cmath>
#include <utility>

#include "compute_shaders/shared/tail_level.h"
#include "engine/compute/command_list.h"
#include "engine/plate/multigrid/detail/plate_kernels.h"
#include "engine/plate/multigrid/detail/plate_passes.h"
#include "tests/plate/kernels/plate_fields.h"
#include "tests/support/errors.h"
#include "tests/support/shader_fixture.h"

// Tests of what is prepared for a rigidity in four dispatches, rigidity_levels.comp, divisor_levels.comp and
// prepare_end.comp, against the passes that each prepare one thing on one level.

namespace palp {
namespace {

using compute::Binding;
using compute::Buffer;
using compute::CommandList;
using compute::Intent;

class PrepareFused : public ShaderTest {
protected:
    /// All that is prepared but the inverse, as words.
    struct Prepared {
        std::vector<std::vector<std::uint32_t>> rigidity, divisor, tiles;
        bool                                    jumps = false, tooSoft = false;
    };

    static Prepared prepareBy(const PlateKernels& kernels, const Plate& plate, int coarsest)
    {
        PlatePasses    passes(context(), kernels.all(), gridHierarchy(plate, 1, coarsest), 1);
        const Binding& finest = passes.levels[0].rigidity;
        Buffer         given(context(), "given", finest.bytes, Intent::upload);
        const auto&    D = plate.rigidity.values();
        const auto&    s = plate.foundationShape.values();
        std::transform(D.begin(), D.end(), given.as<float>().begin(), [](double value) { return float(value); });
        std::transform(s.begin(), s.end(), given.as<float>().begin() + std::ptrdiff_t(D.size()),
                       [](double value) { return float(value); });
        CommandList list(context());
        list.copy(given, 0, *finest.buffer, finest.offset, finest.bytes);
        PlatePasses::Recorder pass{passes, list};
        passes.prepareRigidity(pass);
        list.end();
        Prepared prepared;
        for (int run = 0; run < 2; ++run) { // a second run must find everything ready for it
            context().run(list);
            prepared         = {};
            prepared.jumps   = passes.foundJumps();
            prepared.tooSoft = passes.isTooSoft();
            for (std::size_t l = 0; l < passes.levels.size(); ++l) {
                prepared.rigidity.push_back(words(passes.levels[l].rigidity));
                if (l + 1 == passes.levels.size()) break; // the coarsest has neither
                prepared.divisor.push_back(words(passes.levels[l].divisor));
                auto tiles = words(passes.levels[l].tiles);
                tiles.resize(1 + tiles[0]); // nothing is written behind the last
                prepared.tiles.push_back(std::move(tiles));
            }
        }
        return prepared;
    }

    static std::vector<std::uint32_t> words(const Binding& part)
    {
        Buffer      read(context(), "read", part.bytes, Intent::readback);
        CommandList list(context());
        list.copy(*part.buffer, part.offset, read, 0, part.bytes);
        list.end();
        context().run(list);
        read.makeVisibleToHost();
        const auto all = read.as<std::uint32_t>();
        return {all.begin(), all.end()};
    }

    static std::vector<Plate> plates()
    {
        using enum Edge;
        return {roughPlate(9, 12, {clamped, clamped, clamped, clamped}),                       // one level or two
                onRoughBed(roughPlate(17, 13, {supported, free, clamped, supported}, 1, 1.3)), // odd cells
                roughPlate(64, 64, {clamped, clamped, clamped, clamped}),                      // three
                onRoughBed(roughPlate(131, 75, {free, clamped, free, free})),                  // more, odd ones
                roughPlate(200, 33, {free, free, supported, clamped}, 1, 7),                   // x alone first
                roughPlate(258, 259, {clamped, clamped, clamped, clamped}),                    // the last group goes on
                onRoughBed(roughPlate(40, 300, {supported, supported, free, clamped}, 1.0, 0.7))};
    }
};

TEST_F(PrepareFused, FourDispatchesPrepareTheSameBits)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernels";
    if (validation() != compute::Validation::off) GTEST_SKIP() << "time";
    if (!context().bitExact()) GTEST_SKIP() << "a driver may fuse the sums of each kernel as it likes";
    const PlateKernels fused(context(), Schedule::fused), onePassEach(context(), Schedule::passByPass);
    for (const Plate& plate : plates())
        for (const int coarsest : {shared::kTailCoarseCells, shared::kMostCoarseCells}) {
            SCOPED_TRACE(describe(plate) + ", at most " + std::to_string(coarsest) + " on the coarsest level");
            const Prepared one = prepareBy(fused, plate, coarsest), each = prepareBy(onePassEach, plate, coarsest);
            EXPECT_TRUE(one.rigidity == each.rigidity);
            EXPECT_TRUE(one.divisor == each.divisor);
            EXPECT_TRUE(one.tiles == each.tiles);
            EXPECT_EQ(one.jumps, each.jumps);
            EXPECT_EQ(one.tooSoft, each.tooSoft);
        }
}

/// Where the rigidity jumps the cycle has the same sweeps in both schedules, but ends on another coarsest level: the
/// answers agree as far as the steps go. Each is off by at most the tolerance in the energy norm; a deflection at one
/// end of a beam by some 1.1 times as much, relative to the largest one: 2.3 tolerances between the two, here 3.
TEST_F(PrepareFused, PlatesThatJumpGetTheSameAnswerByEither)
{
    if (onHost()) GTEST_SKIP() << "the host has no such kernels";
    if (validation() != compute::Validation::off) GTEST_SKIP() << "time";
    if (compilesSlowly(context())) GTEST_SKIP() << kCompilesSlowly;
    using enum Edge;
    const PlateKernels fused(context(), Schedule::fused), each(context(), Schedule::passByPass);
    for (const Plate& plate : {onRoughBed(roughPlate(37, 22, {free, clamped, free, free})),
                               roughPlate(64, 64, {clamped, clamped, clamped, clamped})}) {
        SCOPED_TRACE(describe(plate));
        NodeField load(plate.grid);
        load(plate.grid.cellsX / 2, plate.grid.cellsZ / 3) = 1;
        const MultigridPlateSolver::Settings settings{.tolerance = context().processor().float64 ? 1e-5 : 1e-4};
        const PlateSolution                  a = MultigridPlateSolver(context(), fused, plate, settings).solve(load),
                            b                  = MultigridPlateSolver(context(), each, plate, settings).solve(load);
        EXPECT_LT(errorOf(a.deflection, b.deflection), 3 * settings.tolerance);
        EXPECT_TRUE(a.report.converged && b.report.converged);
        EXPECT_LE(std::abs(*a.report.iterations - *b.report.iterations), 1);
    }
}

} // namespace
} // namespace palp
