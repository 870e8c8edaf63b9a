#include "engine/pipeline/detail/shell_windows.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "engine/pipeline/compliance_table_solve.h"
#include "tests/support/errors.h"

// What a patch window does to a homogeneous shell, kept by its shape.

namespace palp {
namespace {

constexpr double kThickness = 1e-3, kWindow = 40e-3; ///< [m]
constexpr int    kCells = 64;

/// A homogeneous shell, for curvatures [1/m], a modulus [Pa] and a foundation [Pa/m].
Shell shellOf(double x, double z, double xz, double modulus = 1e6, double foundation = 0)
{
    constexpr double kNu = 0.45;
    const PlateGrid  grid{kCells, kCells, kWindow / kCells, kWindow / kCells};
    const PlateEdges supported{Edge::supported, Edge::supported, Edge::supported, Edge::supported};
    const double     D = modulus * std::pow(kThickness, 3) / (12 * (1 - kNu * kNu));
    Shell            shell{{grid, supported, kNu, foundation, NodeField(grid, D)},
                NodeField(grid, 1 / (modulus * kThickness)),
                supported,
                NodeField(grid, x),
                NodeField(grid, z),
                NodeField(grid, xz)};
    return shell;
}

FootprintLattice latticeOf(PlateSolver& solver)
{
    return solveLattice(shellOf(0, 0, 0).bending, {4e-3, 5, 1e9}, solver, 1e-4);
}

ShellShape shapeOf(const Shell& shell)
{
    return meanShape(shell, shell.bending.foundation);
}

ComplianceTable tableOf(const Shell& shell, const FootprintLattice& lattice, PlateSolver& solver)
{
    ComplianceTable table;
    (void)solveTable(shell, shell.bending.foundation, lattice, solver, 1e-4, table);
    return table;
}

TEST(ShellWindows, AShapeHasNoModulusAndIsThatOfTheShellMadeOfIt)
{
    for (const Shell& shell : {shellOf(20, 13, 4), shellOf(-8, 9, 0, 1e6, 2e5), shellOf(0, 12, 0), shellOf(0, 0, 0)}) {
        const ShellShape shape = shapeOf(shell);
        EXPECT_EQ(shapeOf(shellOfShape(shape, shell)), shape);
        Shell firmer = shell; // and so is what lies below
        for (double& each : firmer.bending.rigidity.values()) each *= 7;
        for (double& each : firmer.membraneCompliance.values()) each /= 7;
        firmer.bending.foundation *= 7;
        EXPECT_EQ(shapeOf(firmer), shape);
    }
    EXPECT_NE(shapeOf(shellOf(20, 13, 4)), shapeOf(shellOf(20.6, 13.4, 4.1)));
    EXPECT_NE(shapeOf(shellOf(20, 13, 4)), shapeOf(shellOf(20, 13, -4)));
    EXPECT_NE(shapeOf(shellOf(20, 13, 4)), shapeOf(shellOf(20, 13, 4, 1e6, 1e5)));
}

/// Half a step of curvature and of each share is lost. At the corner of a table, 8 mm off its middle, in a window of
/// some four lengths whose edges are felt, that is a twentieth of the least that fingers tell.
TEST(ShellWindows, TablesOfAnyHomogeneousShellAreFlat)
{
    PlateSolver            host("host");
    const FootprintLattice lattice = latticeOf(host);
    double                 most    = 0;
    for (const Shell& shell :
         {shellOf(20, 20, 0), shellOf(20.2, 20.2, 0), shellOf(19.8, 13.1, 2.77), shellOf(9, 4.1, -1),
          shellOf(14, -9.3, 0), shellOf(-7, -6.1, 3), shellOf(17, 11, 1, 1e6, 3e5)}) {
        const ComplianceTable table = tableOf(shell, lattice, host);
        for (std::size_t n = 0; n < lattice.loads.size(); ++n)
            most = worse(most, table.compliance[n].value - table.middle().lnCompliance);
    }
    RecordProperty("most", std::to_string(most));
    EXPECT_LT(most, 0.07 / 20);
    EXPECT_GT(most, 1e-6) << "then it was not kept by steps";
}

TEST(ShellWindows, WhatIsKeptDoesNotDependOnWhatCameBefore)
{
    PlateSolver            host("host");
    const FootprintLattice fresh = latticeOf(host), used = latticeOf(host);
    const Shell            near = shellOf(20, 13.2, 4), sameStep = shellOf(20.02, 13.2, 4.01, 3e6);
    ASSERT_EQ(shapeOf(near), shapeOf(sameStep));
    (void)tableOf(near, used, host);
    const ComplianceTable after = tableOf(sameStep, used, host), alone = tableOf(sameStep, fresh, host);
    EXPECT_EQ(used.shells->known.size(), 1u);
    for (std::size_t n = 0; n < used.loads.size(); ++n) {
        EXPECT_EQ(after.compliance[n].value, alone.compliance[n].value) << n;
        EXPECT_EQ(after.compliance[n].slopeX, alone.compliance[n].slopeX) << n;
    }
}

} // namespace
} // namespace palp
