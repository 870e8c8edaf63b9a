#include "engine/pipeline/detail/curved_bending.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kRigidity = 2e-4, kSize = 60e-3, kWaves = 300; // [N m], [m], [1/m]

/// A sheet that is curved by k and bent in waves along one direction, w = sin(kWaves times the place along it).
Patch wavy(double k, double angle, double across = 0)
{
    Patch           patch;
    const PlateGrid grid{120, 120, kSize / 120, kSize / 120};
    patch.plate    = {grid, {}, 0.45, 0, NodeField(grid, kRigidity)};
    patch.covered  = NodeField(grid, 1);
    const double c = std::cos(angle), s = std::sin(angle);
    patch.curvature.emplace(CurvatureField{NodeField(grid, k * c * c + across * s * s),
                                           NodeField(grid, k * s * s + across * c * c),
                                           NodeField(grid, (k - across) * c * s)});
    patch.response = NodeField(grid);
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j)
            patch.response(i, j) = std::sin(kWaves * (i * grid.spacingX * c + j * grid.spacingZ * s));
    return patch;
}

/// Returns the work of such waves: D times their second derivative squared, over the sheet within its outermost nodes.
double workOf(const Patch& patch)
{
    const PlateGrid& grid = patch.plate.grid;
    double           sum  = 0;
    for (int i = 1; i < grid.cellsX; ++i)
        for (int j = 1; j < grid.cellsZ; ++j) sum += std::pow(patch.response(i, j), 2);
    return kRigidity * std::pow(kWaves, 4) * sum * grid.spacingX * grid.spacingZ;
}

/// A ring whose waves are as short as k is large bends by p^2 - k^2 in place of p^2, p the waves': to the first order
/// its energy is 1 - 2 k^2/p^2 of that (Lamb's and Rayleigh's inextensional rings have its square).
TEST(CurvedBending, IsThatOfAWavyRingWhateverTheAxes)
{
    for (const double angle : {0.0, 0.4, -1.1}) {
        const Patch patch = wavy(60, angle);
        // Second differences of waves of 42 nodes are 0.2 % off the derivatives.
        EXPECT_NEAR(curvedBending(patch, workOf(patch)), 1 / (1 - 2 * std::pow(60 / kWaves, 2)), 3e-4) << angle;
    }
}

TEST(CurvedBending, OfWavesAlongWhatIsStraightIsByPoissonsRatio)
{
    const Patch patch = wavy(0, 0.4, 60);
    EXPECT_NEAR(curvedBending(patch, workOf(patch)), 1 / (1 - 2 * 0.45 * std::pow(60 / kWaves, 2)), 3e-4);
}

TEST(CurvedBending, IsNoneOfWhatIsCurvedBothWays)
{
    for (const double across : {60.0, -20.0, 600.0}) {
        const Patch  patch  = wavy(60, 0.4, across);
        const double ratio  = curvedBending(patch, workOf(patch));
        const double oneWay = 1 - 60 * std::abs(across) / std::pow((60 + across) / 2, 2);
        const double full   = 2 * (60 * 60 + 0.45 * across * across) / (kWaves * kWaves);
        EXPECT_NEAR(ratio, 1 / (1 - std::clamp(oneWay * full, 0.0, 0.25)), 3e-4) << across;
    }
}

TEST(CurvedBending, IsNoneOfALumpAndOfWhatLiesBeyondTheSheet)
{
    Patch patch = wavy(60, 0);
    for (int i = 0; i <= 120; ++i)
        for (int j = 0; j <= 120; ++j) patch.curvature->x(i, j) *= i < 60 ? 1 : i == 60 ? 0 : -1;
    EXPECT_NEAR(curvedBending(patch, workOf(patch)), 1, 1e-12) << "its normals turn to and fro";
    Patch half = wavy(60, 0);
    for (int i = 0; i <= 120; ++i)
        for (int j = 0; j <= 60; ++j) half.covered(i, j) = 0;
    half.beyond = 1e-6;
    for (int i = 0; i <= 120; ++i)
        for (int j = 0; j <= 60; ++j) half.plate.rigidity(i, j) *= 1e-6;
    const double all = 1 / curvedBending(wavy(60, 0), workOf(half)) - 1;
    EXPECT_NEAR((1 / curvedBending(half, workOf(half)) - 1) / all, 59.0 / 119, 1e-9);
    patch.covered = NodeField();
    EXPECT_EQ(curvedBending(patch, workOf(patch)), 1) << "the window is cut from a body";
    patch.curvature.reset();
    EXPECT_EQ(curvedBending(patch, workOf(patch)), 1);
}

TEST(CurvedBending, IsHeldWhereAFirstOrderSaysNothing)
{
    const Patch patch = wavy(60, 0);
    EXPECT_DOUBLE_EQ(curvedBending(patch, workOf(patch) / 100), 1 / 0.75);
    Patch outward = wavy(60, 0);
    for (double& w : outward.response.values()) w = 1; // a deflection that does not bend
    EXPECT_EQ(curvedBending(outward, workOf(patch)), 1);
}

} // namespace
} // namespace palp
