#include "engine/plate/multigrid/direct_shell.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "engine/plate/host/host_kernels.h"
#include "engine/plate/load.h"
#include "engine/plate/multigrid/detail/sheet_nodes.h"
#include "engine/plate/reference/reference_shell_solver.h"
#include "tests/plate/shells.h"
#include "tests/plate/strips.h"
#include "tests/support/errors.h"

namespace palp {
namespace {

/// Footprints on nodes along a line through the middle, which move along it.
std::vector<Footprint> lineOn(const PlateGrid& grid, int count)
{
    constexpr double       kStep = 1e-5; // [m]
    std::vector<Footprint> loads;
    for (int n = 0; n < count; ++n) {
        const double    x    = kSize * 0.1 * (double(n) / count - 0.5);
        const NodeField load = fingertip(grid, x);
        NodeField       move = fingertip(grid, x + kStep);
        for (std::size_t k = 0; k < move.values().size(); ++k)
            move.values()[k] = (move.values()[k] - load.values()[k]) / kStep;
        loads.emplace_back(load, move, NodeField(grid));
    }
    return loads;
}

FootprintResponse felt(const Shell& shell, const Footprint& load, const NodeField& w)
{
    FootprintResponse of = responseOf(load, w);
    of.work += shearWork(shell, w) - squeezeWork(shell, w, load);
    return of;
}

/// A bed so soft that none of Airy's function is left out, and so much rigidity beyond the border that it counts as a
/// sheet: then the matrix is that of the reference, and only rounding differs. The condition of a fourth-order operator
/// of 49 nodes a side and a contrast of 1e4, 1e10, times 1e-16 is 1e-6.
TEST(DirectShell, HasTheMatrixOfTheReference)
{
    for (const Bend& bend : {constant(1, 1, 0), constant(0, 1, 0.4), constant(1, -1, 0.3), ridges()}) {
        Shell shell = cutAslant(shellOf(square(48), disc(30), bend, 8));
        for (double& bed : shell.stressBed.values()) bed /= 20;
        const auto loads = lineOn(shell.bending.grid, 11);
        const auto found = DirectShell(shell, loads).solve(loads, 9, 1e-4);
        ASSERT_TRUE(found);
        const ReferenceShellSolver reference(shell);
        for (std::size_t n = 0; n < loads.size(); ++n) {
            const NodeField         w     = reference.solve(loads[n].load(shell.bending.grid)).deflection;
            const FootprintResponse truth = felt(shell, loads[n], w);
            EXPECT_NEAR(found->responses[n].work / truth.work, 1, 1e-6) << n;
            EXPECT_NEAR(found->responses[n].changeX, truth.changeX, 1e-6 * std::abs(truth.work / 1e-3)) << n;
            if (n == 9) {
                EXPECT_LT(errorOf(found->whole.deflection, w), 1e-6);
            }
        }
    }
}

/// What is held all around carries all forces, and nothing holds Airy's function: the matrix was singular by a linear
/// one, which carries none, and domes were left to multigrid.
TEST(DirectShell, NeedsNoBorderForItsStresses)
{
    for (const int cells : {32, 48, 80}) // a pivot of nothing but rounding may have its sign by chance
        for (const Bend& bend : {constant(1, 1, 0), constant(0, 1, 0.4), constant(1, -1, 0.3), ridges()}) {
            Shell shell       = shellOf(square(cells), disc(30), bend, 8);
            shell.stressBed   = NodeField(shell.bending.grid);
            shell.stressEdges = {Edge::free, Edge::free, Edge::free, Edge::free};
            const auto loads  = lineOn(shell.bending.grid, 3);
            const auto found  = DirectShell(shell, loads).solve(loads, 1, 1e-4);
            ASSERT_TRUE(found) << cells;
            const NodeField w = ReferenceShellSolver(shell).solve(loads[1].load(shell.bending.grid)).deflection;
            EXPECT_NEAR(found->responses[1].work / felt(shell, loads[1], w).work, 1, 1e-6) << cells << ": rounding";
        }
}

/// Its rounding is known after the first loads: those after it are not refined, and are as exact.
TEST(DirectShell, LaterLoadsAreAsExact)
{
    const Shell shell = stripOf(shellOf(square(48), disc(30), constant(1, 0, 0), 8), 1e-6);
    const auto  loads = lineOn(shell.bending.grid, 11);
    DirectShell direct(shell, loads);
    const auto  first = direct.solve(loads, 9, 1e-4), again = direct.solve(loads, 2, 1e-4);
    ASSERT_TRUE(first && again);
    for (std::size_t n = 0; n < loads.size(); ++n)
        EXPECT_NEAR(again->responses[n].work / first->responses[n].work, 1, 1e-8) << n;
    EXPECT_GT(*again->whole.report.errorEstimate, 0);
}

/// What is left out beyond a border, and what a millionth of the rigidity adds there, is felt by less than 1e-3:
/// an arch that thrusts, whose works are the hundredth part of what is left without.
TEST(DirectShell, LeavesNothingOutThatIsFelt)
{
    for (const double rest : {1e-6, 1e-7}) {
        const Shell     shell = stripOf(shellOf(square(64), disc(30), constant(1, 0, 0), 8), rest);
        const auto      loads = lineOn(shell.bending.grid, 3);
        const auto      found = DirectShell(shell, loads).solve(loads, 1, 1e-4);
        const NodeField w     = ReferenceShellSolver(shell).solve(loads[1].load(shell.bending.grid)).deflection;
        const auto      truth = felt(shell, loads[1], w);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->responses[1].work / truth.work, 1, 1e-3) << rest;
        double most = 0, size = 0; // on the sheet
        for (int i = 0; i <= 64; ++i)
            for (int j = 16; j <= 48; ++j) {
                most = worse(most, found->whole.deflection(i, j) - w(i, j));
                size = std::max(size, std::abs(w(i, j)));
            }
        EXPECT_LT(most, 2e-3 * size) << rest;
    }
}

/// A gutter that is held at one end and touched near the other: its tip moves far beside its second differences, so that
/// a stress beyond it must not be loaded by the deflection itself. It was felt four times too stiff so.
TEST(DirectShell, AGutterBendsAboutItsRoot)
{
    Shell            shell = shellOf({96, 48, kSize / 48, kSize / 48}, disc(1), constant(0, 1, 0), 12);
    const PlateGrid& grid  = shell.bending.grid;
    const double     area = grid.spacingX * grid.spacingZ, cell = grid.spacingX;
    shell.bending.edges = allSides(Edge::free);
    shell.stressEdges   = allSides(Edge::clamped);
    shell.stressBed = shell.bending.foundationShape = NodeField(grid);
    shell.bending.foundation                        = 1000 * kRigidity / std::pow(cell, 4);
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j) {
            const double depth    = std::min({i - 9.5, 86.5 - i, j - 13.5, 34.5 - j}); // [cells]
            shell.stressBed(i, j) = std::min(30.0, 30 * std::pow(std::max((2.7 - depth) / 3, 0.0), 6)) *
                                    shell.membraneCompliance(i, j) / (area * area);
            if (depth < 0) {
                shell.bending.rigidity(i, j) *= 1e-6;
            } else if (i < 20) {
                shell.bending.foundationShape(i, j) = 1;
                shell.membraneCompliance(i, j) /= 1000;
            }
        }
    const Footprint load(footprintLoad(grid, 1, 80 * cell, kSize / 2, 4 * cell));
    const auto      found = DirectShell(shell, {&load, 1}).solve({&load, 1}, 0, 1e-4);
    const NodeField w     = ReferenceShellSolver(shell).solve(load.load(grid)).deflection;
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->responses[0].work / felt(shell, load, w).work, 1, 2e-3);
}

/// Returns a sheet that ends where nodes are beyond its border.
Shell endingWhere(const std::function<bool(int, int)>& isBeyond)
{
    Shell            shell = shellOf(square(64), disc(1), constant(1, 0, 0), 4);
    const PlateGrid& grid  = shell.bending.grid;
    const double     area  = grid.spacingX * grid.spacingZ;
    shell.stressBed        = NodeField(grid);
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j) {
            if (!isBeyond(i, j)) continue;
            shell.bending.rigidity(i, j) *= 1e-6;
            shell.stressBed(i, j) = 270 * shell.membraneCompliance(i, j) / (area * area);
        }
    return shell;
}

/// A slit of five nodes between two halves of a sheet: what is touched beside it must not feel the other half.
TEST(DirectShell, NothingBridgesASlit)
{
    const auto slit = [](bool withOther) {
        const Shell shell = endingWhere([=](int, int j) { return (j >= 36 && j <= 40) || (j > 40 && !withOther); });
        const auto  loads = lineOn(shell.bending.grid, 1);
        const auto  found = DirectShell(shell, loads).solve(loads, 0, 1e-4);
        return found ? found->responses.front().work : NAN;
    };
    EXPECT_NEAR(slit(true) / slit(false), 1, 1e-6); // rounding of a matrix whose condition is some 1e9
}

/// A piece of the sheet beside the touched one, of a few nodes that nothing holds: its matrix is singular.
TEST(DirectShell, APieceThatNothingHoldsDoesNoHarm)
{
    const auto with = [](bool piece) {
        const Shell shell = endingWhere(
            [=](int i, int j) { return j > 40 && !(piece && std::abs(i - 20) <= 2 && std::abs(j - 52) <= 2); });
        const auto  loads = lineOn(shell.bending.grid, 1);
        DirectShell direct(shell, loads);
        Footprint   other;
        other.parts.push_back({.node = 20 * 65 + 52, .force = 1});
        EXPECT_TRUE(direct.has(loads));
        EXPECT_FALSE(direct.has({&other, 1}));
        const auto found = direct.solve(loads, 0, 1e-4);
        return found ? found->responses.front().work : NAN;
    };
    EXPECT_EQ(with(true), with(false));
}

TEST(DirectShell, HasTheSameBitsOnEveryInstructionSet)
{
    const Shell shell = stripOf(shellOf(square(48), disc(30), constant(1, 0, 0), 8), 1e-6);
    const auto  loads = lineOn(shell.bending.grid, 2);
    const auto  best  = DirectShell(shell, loads).solve(loads, 0, 1e-4);
    ASSERT_TRUE(best);
    for (const HostVariant& variant : hostVariants()) {
        const auto found = DirectShell(shell, loads, {}, variant.kernels).solve(loads, 0, 1e-4);
        ASSERT_TRUE(found) << variant.isa;
        EXPECT_EQ(found->whole.deflection.values(), best->whole.deflection.values()) << variant.isa;
        EXPECT_EQ(found->responses[1].work, best->responses[1].work) << variant.isa;
    }
}

/// A load beside the sheet presses on nothing that is solved for: no answer is one, not none.
TEST(DirectShell, HasNoAnswerForALoadBesideTheSheet)
{
    const Shell shell = stripOf(shellOf(square(48), disc(1), constant(1, 0, 0), 8), 1e-6);
    Footprint   beside;
    beside.parts.push_back({.node = 24 * 49 + 3, .force = 1});
    DirectShell direct(shell, {&beside, 1});
    EXPECT_FALSE(direct.has({&beside, 1}));
    EXPECT_FALSE(direct.solve({&beside, 1}, 0, 1e-4));
}

TEST(DirectShell, RefusesWhatItCannotTake)
{
    Shell shell = cutAslant(shellOf(square(16), disc(30), constant(1, 1, 0), 8));
    EXPECT_TRUE(DirectShell::pays(shell));
    EXPECT_FALSE(DirectShell::pays(shellOf(square(16), disc(30), constant(1, 1, 0), 8)));
    Footprint beyond;
    beyond.parts.push_back({.node = 17 * 17, .force = 1});
    EXPECT_THROW((void)DirectShell(shell, {&beyond, 1}).solve({&beyond, 1}, 0, 1e-4), std::logic_error);
    shell.curvatureX(3, 3) = NAN;
    EXPECT_THROW(DirectShell(shell, {&beyond, 1}), Error);
}

/// Beyond a border a deflection goes on smoothly: where it had steps, the law of large deflections took them for slopes,
/// and arches were felt a tenth stiffer than they were 1 mm beside.
TEST(DirectShell, GoesOnWithoutSteps)
{
    const PlateGrid grid{64, 64, 1e-3, 1e-3};
    NodeField       w(grid);
    Which           known(grid.nodes());
    for (int i = 0; i <= 64; ++i)
        for (int j = 0; j <= 64; ++j) {
            known[std::size_t(i * 65 + j)] = std::hypot(i - 32, j - 32) < 10;
            w(i, j)                        = std::sin(3 * std::atan2(j - 32, i - 32));
        }
    goOn(w, grid, known);
    double most = 0;
    for (int i = 1; i < 64; ++i)
        for (int j = 1; j < 64; ++j)
            if (std::hypot(i - 32, j - 32) > 18) most = worse(most, w(i + 1, j) - 2 * w(i, j) + w(i - 1, j));
    EXPECT_LT(most, 0.06) << "sin 3 a has (3 / 18)^2 itself, 0.03; means alone 0.13";
}

} // namespace
} // namespace palp
