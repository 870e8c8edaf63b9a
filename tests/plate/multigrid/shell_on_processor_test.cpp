#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/compute/context.h"
#include "engine/plate/footprint.h"
#include "engine/plate/multigrid/detail/shell_processor.h"
#include "engine/plate/multigrid/multigrid_shell_solver.h"
#include "engine/plate/plate_solver.h"
#include "engine/plate/reference/reference_shell_solver.h"
#include "tests/plate/shells.h"
#include "tests/plate/strips.h"
#include "tests/support/errors.h"
#include "tests/support/shader_fixture.h"

// The shaders of shells against the host's kernels, to the bit where the processor rounds as C++ does, and against the
// reference.

namespace palp {
namespace {

/// A processor of Vulkan with doubles, and the kernels on it.
class ShellOnProcessor : public ::testing::Test {
protected:
    void SetUp() override
    {
        context_.emplace(compute::ContextSettings{.processor = processorOfTests()});
        if (context_->processor().kind == compute::ProcessorKind::host)
            GTEST_SKIP() << "the host has kernels of its own";
        if (!ShellKernels::suit(*context_)) GTEST_SKIP() << context_->processor().name << " has no doubles";
        kernels_.emplace(*context_);
    }

    [[nodiscard]] std::vector<ShellAnswer> solved(const Shell& shell, std::span<const NodeField> loads,
                                                  double tolerance = 1e-6)
    {
        return MultigridShellSolver(shell, *context_, *kernels_).solve(loads, tolerance);
    }

    /// Expects each load's answer to be that of the host for it alone.
    void expectTheHosts(const std::vector<ShellAnswer>& found, const Shell& shell, std::span<const NodeField> loads,
                        const std::string& where, double tolerance = 1e-6)
    {
        MultigridShellSolver host(shell);
        for (std::size_t n = 0; n < loads.size(); ++n) {
            const ShellAnswer alone = host.solve(loads.subspan(n, 1), tolerance).front();
            EXPECT_EQ(found[n].report.iterations, alone.report.iterations) << where;
            EXPECT_TRUE(found[n].report.converged) << where;
            if (context_->bitExact()) {
                EXPECT_EQ(found[n].work, alone.work) << where << ", load " << n;
                EXPECT_EQ(found[n].deflection.values(), alone.deflection.values()) << where << ", load " << n;
                EXPECT_EQ(found[n].stressFunction.values(), alone.stressFunction.values()) << where << ", load " << n;
            } else { // fused products change roundings, and with them what is left of the error that was allowed
                EXPECT_LT(errorOf(found[n].deflection, alone.deflection), 10 * tolerance) << where;
            }
        }
    }

    std::optional<compute::Context> context_;
    std::optional<ShellKernels>     kernels_;
};

TEST_F(ShellOnProcessor, HasTheBitsOfTheHostWhateverGridMapCurvatureAndEdges)
{
    using enum Edge;
    const PlateGrid oblong{37, 22, kSize / 37, kSize / 22};
    for (const auto& [bending, stress] : {std::pair{supported, supported}, std::pair{clamped, free},
                                          std::pair{guided, supported}, std::pair{free, clamped}})
        for (const auto& [grid, map, bend, lengths] : {std::tuple{square(32), even(), constant(1, 1, 0), 12.0},
                                                       std::tuple{square(12), even(), constant(1, 0.2, 0), 4.0},
                                                       std::tuple{square(64), wart(10), constant(0.7, 0.5, 0.35), 8.0},
                                                       std::tuple{square(40), disc(100), ridges(), 16.0},
                                                       std::tuple{oblong, linear(10), constant(1, -1, 0.2), 8.0}}) {
            Shell shell              = shellOf(grid, map, bend, lengths, bending, stress);
            shell.bending.foundation = 1e7; // holds what no side does
            const NodeField load     = fingertip(grid, 3e-3, -2e-3);
            const auto      where    = edgesText(allSides(bending)) + ", " + std::to_string(grid.cellsX) + " cells";
            expectTheHosts(solved(shell, {&load, 1}), shell, {&load, 1}, where);
        }
}

TEST_F(ShellOnProcessor, HasTheBitsOfTheHostWhereTheShellEndsWithinTheWindow)
{
    const PlateGrid grid  = square(40);
    const Shell     shell = cutAslant(shellOf(grid, wart(10), constant(1, 0.5, 0.3), 8));
    const NodeField load  = fingertip(grid, 3e-3, -2e-3);
    expectTheHosts(solved(shell, {&load, 1}), shell, {&load, 1}, "cut aslant");
}

TEST_F(ShellOnProcessor, HasTheBitsOfTheHostUnderLoadsOnBothFields)
{
    const Shell          shell = stripOf(shellOf(square(32), wart(10), constant(1, 0.2, 0.3), 8, Edge::clamped));
    const Thrusts        thrusts(shell);
    MultigridShellSolver host(shell), own(shell, *context_, *kernels_);
    for (const ShellLoad& load : thrusts.loads()) {
        const ShellAnswer here = host.solve({&load, 1}, 1e-6).front(), there = own.solve({&load, 1}, 1e-6).front();
        EXPECT_TRUE(there.report.converged);
        if (context_->bitExact()) {
            EXPECT_EQ(there.work, here.work);
            EXPECT_EQ(there.stressFunction.values(), here.stressFunction.values());
        } else {
            EXPECT_LT(errorOf(there.deflection, here.deflection), 1e-5);
        }
    }
}

TEST_F(ShellOnProcessor, SolvesForSeveralLoadsTogether)
{
    const PlateGrid        grid  = square(32);
    const Shell            shell = shellOf(grid, wart(10), constant(1, 0.5, 0.2), 8);
    std::vector<NodeField> loads;
    for (int n = 0; n < 5; ++n) loads.push_back(fingertip(grid, 2e-3 * (n - 2), 1e-3 * n));
    loads.push_back(NodeField(grid)); // of nothing
    const auto found = solved(shell, loads);
    ASSERT_EQ(found.size(), loads.size());
    EXPECT_EQ(found.back().work, 0);
    expectTheHosts(found, shell, loads, "six loads");
}

/// As on the host: what several loads gain together tells that no more steps are needed.
TEST_F(ShellOnProcessor, StopsAfterOneStepWhereAllLoadsHaveGainedEnough)
{
    const PlateGrid        grid  = square(64);
    const Shell            shell = shellOf(grid, linear(3), constant(1, 1, 0), 8);
    std::vector<NodeField> loads;
    for (int n = 0; n < 4; ++n) loads.push_back(fingertip(grid, 2e-3 * n, 1e-3 * n));
    const ReferenceShellSolver reference(shell);
    const auto                 found = solved(shell, loads, 1e-2);
    for (std::size_t n = 0; n < loads.size(); ++n) {
        EXPECT_EQ(found[n].report.iterations, 1);
        EXPECT_TRUE(found[n].report.converged);
        const NodeField exact = reference.solve(loads[n]).deflection;
        EXPECT_NEAR(found[n].work / responseOf(Footprint(loads[n]), exact).work, 1, 1e-4) << "the tolerance's square";
        EXPECT_LT(errorOf(found[n].deflection, exact), 1e-3) << "3e-4; without the step it is 6e-3";
    }
    EXPECT_GT(solved(shell, {loads.data(), 1}, 1e-2).front().report.iterations, 1) << "one load alone tells less";
}

/// As on hardware, where it is the rule; there too after another shell has come.
TEST_F(ShellOnProcessor, SolvesTheCoarsestLevelByItsInverseAsByItsFactors)
{
    using enum Edge;
    const ShellKernels byInverse(*context_, CoarsestShell::byInverse), byFactors(*context_, CoarsestShell::byFactors);
    ASSERT_TRUE(byInverse.all().invertsCoarsest);
    ASSERT_FALSE(byFactors.all().invertsCoarsest);
    const PlateGrid        grid = square(32);
    std::vector<NodeField> loads;
    for (int n = 0; n < 3; ++n) loads.push_back(fingertip(grid, 2e-3 * n, 1e-3 * n));
    const Shell          first = shellOf(grid, wart(10), constant(1, 0.5, 0.2), 8);
    MultigridShellSolver found(first, *context_, byInverse), expected(first, *context_, byFactors);
    for (const Shell& shell : {first, shellOf(grid, disc(10), ridges(), 8),
                               shellOf(grid, linear(10), constant(1, -1, 0.2), 12, clamped, free)}) {
        found.setShell(shell);
        expected.setShell(shell);
        const auto a = found.solve(loads, 1e-6), b = expected.solve(loads, 1e-6);
        for (std::size_t n = 0; n < loads.size(); ++n) {
            EXPECT_TRUE(a[n].report.converged);
            EXPECT_EQ(a[n].report.iterations, b[n].report.iterations);
            EXPECT_LT(errorOf(a[n].deflection, b[n].deflection), 1e-6) << "both are so near to the exact one";
            EXPECT_NEAR(a[n].work / b[n].work, 1, 1e-9)
                << "the tolerance's square, and its estimate's factor of a thousand";
        }
    }
}

TEST_F(ShellOnProcessor, GoesOnWithAnotherShellAndOtherEdges)
{
    using enum Edge;
    const PlateGrid      grid = square(32);
    const NodeField      load = fingertip(grid);
    MultigridShellSolver solver(shellOf(grid, even(), constant(1, 1, 0), 8), *context_, *kernels_);
    (void)solver.solve({&load, 1}, 1e-6);
    for (const Shell& next :
         {shellOf(grid, disc(10), ridges(), 8), shellOf(grid, linear(10), ridges(), 8, clamped, free),
          shellOf(square(24), even(), constant(1, 1, 0), 8)}) {
        const NodeField own = fingertip(next.bending.grid);
        solver.setShell(next);
        expectTheHosts(solver.solve({&own, 1}, 1e-6), next, {&own, 1}, edgesText(next.bending.edges));
    }
}

/// As many unknowns elsewhere: on so small a grid the finest level is the coarsest one.
TEST_F(ShellOnProcessor, GoesOnWithAsManyUnknownsElsewhere)
{
    using enum Edge;
    Shell first = shellOf(square(12), wart(10), constant(1, 0.3, 0), 4), next = first;
    first.bending.edges.z0    = free;
    first.stressEdges.z0      = clamped;
    next.bending.edges.z1     = free;
    next.stressEdges.z1       = clamped;
    const NodeField      load = fingertip(first.bending.grid, 0, -12e-3);
    MultigridShellSolver solver(first, *context_, *kernels_);
    (void)solver.solve({&load, 1}, 1e-6);
    solver.setShell(next);
    expectTheHosts(solver.solve({&load, 1}, 1e-6), next, {&load, 1}, "the free side is the other one");
}

TEST_F(ShellOnProcessor, IsTheReference)
{
    const PlateGrid grid  = square(40);
    const Shell     shell = shellOf(grid, wart(100), ridges(), 12);
    const NodeField load  = fingertip(grid, 2e-3, 0);
    const auto      found = solved(shell, {&load, 1}, 1e-7).front();
    const auto      exact = ReferenceShellSolver(shell).solve(load);
    // As on the host: coefficients of the levels are floats, and the plate's condition makes some tens of 6e-8.
    EXPECT_LT(errorOf(found.deflection, exact.deflection), 5e-6);
    EXPECT_LT(errorOf(found.stressFunction, exact.stressFunction), 5e-6);
}

TEST_F(ShellOnProcessor, IsWhatAPlateSolverTakes)
{
    const Shell            shell = shellOf(square(32), wart(10), constant(1, 1, 0), 8);
    std::vector<Footprint> loads;
    for (int n = 0; n < 3; ++n) loads.emplace_back(fingertip(shell.bending.grid, 1e-3 * n));
    PlateSolver             solver(processorOfTests()), host("host");
    const FootprintSolution found = solver.solveFootprints(shell, loads, 1, 1e-4, 1e-4),
                            by    = host.solveFootprints(shell, loads, 1, 1e-4, 1e-4);
    EXPECT_EQ(found.whole.report.solver, context_->processor().name);
    EXPECT_EQ(solver.note(), "");
    for (std::size_t n = 0; n < loads.size(); ++n)
        EXPECT_NEAR(found.responses[n].work / by.responses[n].work, 1, 1e-4) << "the tolerance of works";
}

TEST(ShellsOfSmallProcessors, AreSolvedByTheHost)
{
    compute::ContextSettings settings{.processor = processorOfTests()};
    settings.float64 = false;
    PlateSolver     solver(settings);
    const Shell     shell = shellOf(square(16), even(), constant(1, 1, 0), 8);
    const Footprint load(fingertip(shell.bending.grid));
    const auto      found = solver.solveFootprints(shell, {&load, 1}, 0, 1e-4, 1e-4);
    EXPECT_EQ(found.whole.report.solver, "host");
    EXPECT_TRUE(found.whole.report.converged);
    if (compute::Context(settings).processor().kind != compute::ProcessorKind::host) {
        EXPECT_NE(solver.note().find("has no doubles, which shells need"), std::string::npos) << solver.note();
    }
}

} // namespace
} // namespace palp
