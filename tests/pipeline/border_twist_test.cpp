#include "engine/pipeline/detail/border_twist.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kWidth = 12e-3, kThickness = 1.5e-3, kRigidity = 2e-4, kTwist = 3; // [m], [m], [N m], [1/m]

/// A strip through the middle of a grid that is twisted evenly, w = kTwist times the place along and across it.
Patch twistedStrip(int cells, double angle)
{
    Patch           patch;
    const PlateGrid grid{cells, cells, 60e-3 / cells, 60e-3 / cells};
    patch.plate     = {grid, {}, 0.45, 0, NodeField(grid, kRigidity)};
    patch.thickness = kThickness;
    patch.inside = patch.response = NodeField(grid);
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j) {
            const double x = (i - cells / 2) * grid.spacingX, z = (j - cells / 2) * grid.spacingZ;
            const double along   = x * std::cos(angle) + z * std::sin(angle);
            const double across  = z * std::cos(angle) - x * std::sin(angle);
            patch.inside(i, j)   = kWidth / 2 - std::abs(across);
            patch.response(i, j) = kTwist * along * across;
        }
    return patch;
}

/// Timoshenko's strip gives way to twist by 0.63 h/b more than Kirchhoff's, whose work is 2 (1 - nu) D w_nt^2 on its
/// area.
TEST(BorderTwist, IsTimoshenkosOfAStrip)
{
    for (const int cells : {60, 120})
        for (const double angle : {0.0, 0.2, -0.4}) {
            const Patch  patch  = twistedStrip(cells, angle);
            const double length = 60e-3 / std::cos(angle) * (1 - 2.0 / cells); // without the nodes at the grid's sides
            const double work   = 2 * (1 - 0.45) * kRigidity * kTwist * kTwist * kWidth * length;
            EXPECT_NEAR(borderTwist(patch) / work, 0.63 * kThickness / kWidth, 0.03 * 0.63 * kThickness / kWidth)
                << cells << " cells, " << angle << ": ends that are cut aslant, to a cell";
        }
}

TEST(BorderTwist, IsNoneOfWhatIsHeldOrHasNoBorder)
{
    Patch patch = twistedStrip(60, 0);
    patch.held  = NodeField(patch.plate.grid);
    for (int i = 0; i <= 30; ++i)
        for (int j = 0; j <= 60; ++j) patch.held(i, j) = 1;
    EXPECT_NEAR(borderTwist(patch) / borderTwist(twistedStrip(60, 0)), 0.5, 0.02) << "half of it is held";
    patch.inside = NodeField(patch.plate.grid, 1.0);
    EXPECT_EQ(borderTwist(patch), 0) << "far from any border";
    patch.inside = NodeField();
    EXPECT_EQ(borderTwist(patch), 0);
}

TEST(BorderTwist, IsNoneOfASheetThatBendsOneWay)
{
    Patch patch = twistedStrip(60, 0);
    for (int i = 0; i <= 60; ++i)
        for (int j = 0; j <= 60; ++j) patch.response(i, j) = std::pow(1e-3 * i, 2) + std::pow(2e-3 * j, 2);
    EXPECT_NEAR(borderTwist(patch), 0, 1e-15);
}

} // namespace
} // namespace palp
