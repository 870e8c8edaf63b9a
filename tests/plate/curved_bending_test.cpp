#include "engine/plate/curved_bending.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kRigidity = 2e-4, kWaves = 300; // [N m], [1/m]

/// A sheet of even curvatures along a direction and across it, held in a corner.
Shell curvedBy(double along, double angle, double across = 0)
{
    constexpr double kSize = 60e-3; // [m]
    const PlateGrid  grid{120, 120, kSize / 120, kSize / 120};
    const double     c = std::cos(angle), s = std::sin(angle);
    Shell            shell;
    shell.bending     = {grid, {Edge::free, Edge::free, Edge::free, Edge::free}, 0.45, 0, NodeField(grid, kRigidity)};
    shell.curvatureX  = NodeField(grid, along * c * c + across * s * s);
    shell.curvatureZ  = NodeField(grid, along * s * s + across * c * c);
    shell.curvatureXZ = NodeField(grid, (along - across) * c * s);
    shell.stretched   = NodeField(grid, 1);
    shell.bending.foundation            = 100 * kRigidity / std::pow(grid.spacingX, 4);
    shell.bending.foundationShape       = NodeField(grid);
    shell.bending.foundationShape(1, 1) = 1;
    return shell;
}

/// Waves along a direction, w = sin(kWaves times the place along it).
NodeField waves(const PlateGrid& grid, double angle)
{
    NodeField w(grid);
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j)
            w(i, j) = std::sin(kWaves * (i * grid.spacingX * std::cos(angle) + j * grid.spacingZ * std::sin(angle)));
    return w;
}

/// Returns q of waves whose work is D times their second derivative squared, over the sheet within its outermost nodes.
double ofWaves(const Shell& shell, double angle)
{
    const PlateGrid& grid = shell.bending.grid;
    const NodeField  w    = waves(grid, angle);
    double           sum  = 0;
    for (int i = 1; i < grid.cellsX; ++i)
        for (int j = 1; j < grid.cellsZ; ++j) sum += w(i, j) * w(i, j);
    return 2 * CurvedBending(shell).workOf(w) / (kRigidity * std::pow(kWaves, 4) * sum * grid.spacingX * grid.spacingZ);
}

/// A ring with waves of p, of a curvature k, bends by p^2 - k^2 in place of p^2: to the first order its energy is
/// 1 - 2 k^2/p^2 of that (the inextensional rings of Rayleigh and Lamb have its square). What the points move by has a
/// tenth of a wave from node to node, of which 3 % are lost, and a sheet that ends in the middle of a wave as much.
TEST(CurvedBending, IsThatOfAWavyRingWhateverTheAxes)
{
    const double q = -2 * std::pow(60 / kWaves, 2);
    for (const double angle : {0.0, 0.4, -1.1}) EXPECT_NEAR(ofWaves(curvedBy(60, angle), angle) / q, 1, 0.06) << angle;
}

TEST(CurvedBending, CountsLessTheMoreASheetIsCurvedBothWays)
{
    // Waves of one direction leave no length along the other to what is curved across.
    const double alone = ofWaves(curvedBy(60, 0), 0);
    for (const double across : {20.0, -8.0}) {
        const double share = 1 - std::pow(60 * across / std::pow((60 + across) / 2, 2), 2);
        EXPECT_NEAR(ofWaves(curvedBy(60, 0, across), 0) / alone, share, 0.15 * share) << across;
    }
    for (const double across : {60.0, -20.0, -60.0}) EXPECT_EQ(ofWaves(curvedBy(60, 0.4, across), 0.4), 0) << across;
}

/// A bar of a length 1 that is clamped where it begins and bends by a load across its end.
struct Bar {
    const char*                   name;
    std::function<double(double)> curvature; ///< along it
    double                        within;    ///< that is allowed [1]
};

/// Returns how far the end of a bent bar gives way beside a straight one, by Castigliano's theorem: the moment at a
/// place is the load's lever there, that of the straight bar makes 1/3.
double byLevers(const Bar& bar)
{
    constexpr int                      kSteps = 20000;
    double                             angle = 0, x = 0, y = 0;
    std::vector<std::array<double, 2>> places;
    for (int n = 0; n < kSteps; ++n) { // of the middle of each step
        angle += bar.curvature((n + 0.25) / kSteps) / kSteps / 2;
        places.push_back({x + std::cos(angle) / kSteps / 2, y + std::sin(angle) / kSteps / 2});
        x += std::cos(angle) / kSteps;
        y += std::sin(angle) / kSteps;
        angle += bar.curvature((n + 0.75) / kSteps) / kSteps / 2;
    }
    double sum = 0;
    for (const auto& [ofX, ofY] : places) // the load acts across the bar's end
        sum += std::pow((x - ofX) * std::cos(angle) + (y - ofY) * std::sin(angle), 2) / kSteps;
    return 3 * sum;
}

/// Returns the same by the deflection of a straight bar and CurvedBending.
double byBending(const Bar& bar)
{
    const PlateGrid grid{128, 16, 1.0 / 128, 1.0 / 128};
    Shell           shell;
    shell.bending     = {grid, {Edge::clamped, Edge::free, Edge::free, Edge::free}, 0, 0, NodeField(grid, kRigidity)};
    shell.curvatureX  = NodeField(grid);
    shell.curvatureZ  = NodeField(grid);
    shell.curvatureXZ = NodeField(grid);
    shell.stretched   = NodeField(grid, 1);
    NodeField w(grid);
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j) {
            const double s         = i * grid.spacingX;
            shell.curvatureX(i, j) = bar.curvature(s);
            w(i, j)                = s * s * (3 - s) / 6 / kRigidity;
        }
    FootprintResponse of;
    of.work   = (grid.cellsZ - 1) * grid.spacingZ / kRigidity / 3; // of the rows within the sides
    of.curved = CurvedBending(shell).workOf(w);
    return givesWay(of);
}

/// Returns q of a strip of a length 1 that is curved along itself, clamped at an end and twisted at the other.
double ofTwist(int cellsAcross)
{
    const PlateGrid grid{240, cellsAcross, 1.0 / 240, 1.0 / 240};
    Shell           shell;
    shell.bending     = {grid, {Edge::clamped, Edge::free, Edge::free, Edge::free}, 0, 0, NodeField(grid, kRigidity)};
    shell.curvatureX  = NodeField(grid, 1);
    shell.curvatureZ  = NodeField(grid);
    shell.curvatureXZ = NodeField(grid);
    shell.stretched   = NodeField(grid, 1);
    NodeField w(grid);
    double    bent = 0;
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j) {
            const double s = i * grid.spacingX, z = (j - grid.cellsZ / 2.0) * grid.spacingZ;
            w(i, j) = z * s * s * (3 - s);
            if (i == 0 || j == 0 || i == grid.cellsX || j == grid.cellsZ) continue;
            bent += (std::pow(z * 6 * (1 - s), 2) + 2 * std::pow(6 * s - 3 * s * s, 2)) * grid.spacingX * grid.spacingZ;
        }
    return 2 * CurvedBending(shell).workOf(w) / (kRigidity * bent);
}

/// Cells that do not bend in their plane held strips of few of them: with one across nothing was left of q.
TEST(CurvedBending, OfATwistedStripDoesNotHangOnItsWidth)
{
    const double wide = ofTwist(24);
    EXPECT_GT(wide, 0.1);
    for (const int across : {6, 10, 16}) EXPECT_NEAR(ofTwist(across) / wide, 1, 0.1) << across;
}

/// Tolerances: 43 cells along a bar, of which waves have fourteen each; where q is beyond 0.6 exp(-q) is no longer
/// right to a percent.
TEST(CurvedBending, GivesWayAsBentBarsDo)
{
    const double pi    = std::acos(-1);
    const auto   waves = [=](double height) {
        return [=](double s) { return height * std::pow(6 * pi, 2) * std::sin(6 * pi * s); };
    };
    for (const Bar& bar : {Bar{"straight", [](double) { return 0.0; }, 1e-3},
                           Bar{"a quarter of a circle", [=](double) { return pi / 2; }, 0.01},
                           Bar{"a third, bent the other way", [=](double) { return -pi * 2 / 3; }, 0.03},
                           Bar{"J: half straight, half 57 degrees", [=](double s) { return s < 0.5 ? 0 : 2; }, 0.03},
                           Bar{"from the other end, 90 degrees", [=](double s) { return s < 0.5 ? pi : 0; }, 0.02},
                           Bar{"S", [=](double s) { return s < 0.5 ? 2 : -2; }, 0.02},
                           Bar{"waves a thirtieth high", waves(0.01), 0.02}, Bar{"higher ones", waves(0.02), 0.06}}) {
        const double levers = byLevers(bar);
        EXPECT_NEAR(byBending(bar) / levers, 1, bar.within) << bar.name << ", levers " << levers;
    }
}

/// Returns how far an S of a length 1 gives way that goes on behind its clamp by half as much.
/// \param held  share of what lies behind the clamp that the ground holds [1]
double onGround(double held, bool ends = true)
{
    const PlateGrid grid{96, 16, 1.0 / 64, 1.0 / 64};
    Shell           shell;
    shell.bending = {grid, {Edge::free, Edge::free, Edge::free, Edge::free}, 0, 0, NodeField(grid, kRigidity)};
    shell.bending.foundation      = 100 * kRigidity * std::pow(64, 4);
    shell.bending.foundationShape = shell.curvatureX = shell.curvatureZ = shell.curvatureXZ = NodeField(grid);
    if (ends) shell.stretched = NodeField(grid, 1);
    NodeField w(grid);
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j) {
            const double s = std::max(0.0, (i - 32) * grid.spacingX);

            shell.bending.foundationShape(i, j) = i <= 32 * held;
            shell.curvatureX(i, j)              = s < 0.5 ? 2 : -2;
            w(i, j)                             = s * s * (3 - s) / 6 / kRigidity;
        }
    FootprintResponse of;
    of.work   = (grid.cellsZ - 1) * grid.spacingZ / kRigidity / 3;
    of.curved = CurvedBending(shell).workOf(w);
    return givesWay(of);
}

TEST(CurvedBending, StaysWhereTheGroundHoldsIt)
{
    const double levers = byLevers({"S", [](double s) { return s < 0.5 ? 2 : -2; }, 0});
    EXPECT_NEAR(onGround(1) / levers, 1, 0.03);
    EXPECT_EQ(onGround(-1), 1) << "what nothing holds may move anywhere";
    EXPECT_EQ(onGround(1, false), 1) << "a window that is cut from a body";
}

/// A lump on a vault takes away what counts around the lump alone: by one share for all the sheet nothing was left,
/// because the lump is more curved than the vault.
TEST(CurvedBending, OfAVaultIsNotGoneByALumpOnIt)
{
    const auto q = [](double height) {
        constexpr double kWide = 5e-3, kSpan = 60e-3; // [m]
        Shell            shell = curvedBy(10, 0);
        const PlateGrid& grid  = shell.bending.grid;
        NodeField        w(grid);
        for (int i = 0; i <= grid.cellsX; ++i)
            for (int j = 0; j <= grid.cellsZ; ++j) {
                const double x = (i * grid.spacingX - 45e-3) / kWide, z = (j * grid.spacingZ - 45e-3) / kWide;
                const double of = height / (kWide * kWide) * std::exp(-(x * x + z * z) / 2);
                shell.curvatureX(i, j) += of * (1 - x * x);
                shell.curvatureZ(i, j) += of * (1 - z * z);
                shell.curvatureXZ(i, j) -= of * x * z;
                shell.bending.foundationShape(i, j) = i <= 2;
                const double s                      = i * grid.spacingX;
                w(i, j)                             = s * s * (3 * kSpan - s);
            }
        return CurvedBending(shell).workOf(w);
    };
    EXPECT_GT(q(2e-3) / q(0), 0.5);
}

TEST(CurvedBending, IsKeptWhereItsOrderSaysNothing)
{
    const auto of = [](double work, double curved) {
        FootprintResponse response;
        response.work   = work;
        response.curved = curved;
        return givesWay(response);
    };
    EXPECT_DOUBLE_EQ(of(1, 0.1), std::exp(-0.2));
    EXPECT_DOUBLE_EQ(of(1, -0.1), std::exp(0.2));
    EXPECT_DOUBLE_EQ(of(1, -3), std::exp(0.5));
    EXPECT_DOUBLE_EQ(of(1, 3), std::exp(-1.5));
    EXPECT_DOUBLE_EQ(of(0, 3), 1);
}

} // namespace
} // namespace palp
