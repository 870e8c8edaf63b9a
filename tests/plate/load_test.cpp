#include "engine/plate/load.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

constexpr PlateGrid kGrid{12, 9, 0.25, 0.5}; ///< 3 m x 4.5 m

double total(const NodeField& forces)
{
    return std::accumulate(forces.values().begin(), forces.values().end(), 0.0);
}

/// Of forces, about the corner node.
struct Moments {
    double x = 0, z = 0; ///< [N m]
};

Moments momentsOf(const NodeField& forces)
{
    Moments sum;
    for (int i = 0; i < kGrid.nodesX(); ++i)
        for (int j = 0; j < kGrid.nodesZ(); ++j) {
            sum.x += forces(i, j) * i * kGrid.spacingX;
            sum.z += forces(i, j) * j * kGrid.spacingZ;
        }
    return sum;
}

TEST(Load, NodeAreasAddUpToThePlate)
{
    double sum = 0;
    for (int i = 0; i < kGrid.nodesX(); ++i)
        for (int j = 0; j < kGrid.nodesZ(); ++j) sum += nodeArea(kGrid, i, j);

    EXPECT_NEAR(sum, kGrid.sizeX() * kGrid.sizeZ(), 1e-13) << "rounding";
    EXPECT_EQ(nodeArea(kGrid, 3, 3), 0.125);
    EXPECT_EQ(nodeArea(kGrid, 0, 3), 0.0625);
    EXPECT_EQ(nodeArea(kGrid, 3, 9), 0.0625);
    EXPECT_EQ(nodeArea(kGrid, 12, 9), 0.03125);
}

TEST(Load, APressurePressesWithItsTimesTheArea)
{
    EXPECT_NEAR(total(uniformLoad(kGrid, 2)), 2 * 13.5, 1e-12) << "rounding";

    NodeField pressure(kGrid, 2);
    pressure(0, 0) = 10;
    EXPECT_DOUBLE_EQ(gridLoad(kGrid, pressure)(0, 0), 10 * 0.03125);
    EXPECT_EQ(gridLoad(kGrid, pressure)(5, 5), uniformLoad(kGrid, 2)(5, 5));
}

TEST(Load, APointForceOnANodeLoadsThatNodeOnly)
{
    const NodeField forces = pointLoad(kGrid, 3, 0.75, 1.5);

    EXPECT_EQ(forces(3, 3), 3);
    EXPECT_EQ(total(forces), 3);
    EXPECT_EQ(pointLoad(kGrid, 3, 3, 4.5)(12, 9), 3) << "the far corner";
}

TEST(Load, APointForceKeepsForceAndMoments)
{
    const NodeField forces = pointLoad(kGrid, 3, 0.8, 1.9);

    EXPECT_NEAR(total(forces), 3, 1e-15) << "rounding";
    EXPECT_NEAR(momentsOf(forces).x, 3 * 0.8, 1e-14) << "rounding";
    EXPECT_NEAR(momentsOf(forces).z, 3 * 1.9, 1e-14) << "rounding";
}

TEST(Load, AGaussianWithinThePlateKeepsForceAndMoments)
{
    const NodeField forces = gaussianLoad(kGrid, 3, 1.4, 2.3, 0.2); // 7 deviations from the nearest edge

    EXPECT_NEAR(total(forces), 3, 1e-10) << "beyond 7 deviations lies 3e-12";
    EXPECT_NEAR(momentsOf(forces).x, 3 * 1.4, 1e-10) << "the same";
    EXPECT_NEAR(momentsOf(forces).z, 3 * 2.3, 1e-10) << "the same";
}

TEST(Load, AGaussianThatLeavesThePlateLosesThatShare)
{
    EXPECT_NEAR(total(gaussianLoad(kGrid, 1, 0, 2.25, 0.2)), 0.5, 1e-12) << "half of it is beyond the edge";
}

TEST(Load, AGaussianOnAFineGridIsItsDensityTimesTheArea)
{
    const PlateGrid fine{400, 400, 0.0025, 0.0025};
    const NodeField forces  = gaussianLoad(fine, 1, 0.5, 0.5, 0.05);
    const double    r2      = 0.05 * 0.05 + 0.025 * 0.025;
    const double    density = std::exp(-r2 / (2 * 0.0025)) / (2 * 3.14159265358979324 * 0.0025);

    EXPECT_NEAR(forces(220, 210) / (density * nodeArea(fine, 220, 210)), 1, 1e-3)
        << "averaging over a cell: second derivative h^2/12, that is 2e-4";
}

TEST(Load, AVeryNarrowGaussianIsAPointForce)
{
    const NodeField narrow = gaussianLoad(kGrid, 2, 0.8, 1.9, 1e-9);
    const NodeField point  = pointLoad(kGrid, 2, 0.8, 1.9);

    for (std::size_t k = 0; k < point.values().size(); ++k)
        EXPECT_NEAR(narrow.values()[k], point.values()[k], 1e-12) << "rounding of x / spacing";
}

TEST(Load, AFootprintPressesWithExactlyItsForceAboutItsCentre)
{
    for (const double x : {1.0, 1.03, 1.125, 1.5})
        for (const double radius : {0.5, 0.73, 1.0}) {
            const NodeField forces = footprintLoad(kGrid, 3, x, 2.2, radius);
            EXPECT_NEAR(total(forces), 3, 1e-14) << "rounding";
            EXPECT_NEAR(momentsOf(forces).x, 3 * x, 1e-13) << "rounding";
            EXPECT_NEAR(momentsOf(forces).z, 3 * 2.2, 1e-13) << "rounding";
        }
}

TEST(Load, AFootprintOnANodeIsSymmetric)
{
    const PlateGrid square{16, 16, 0.1, 0.1};
    const NodeField forces = footprintLoad(square, 1, 0.8, 0.8, 0.25);

    for (int i = 0; i <= 16; ++i)
        for (int j = 0; j <= 16; ++j) {
            EXPECT_NEAR(forces(i, j), forces(16 - i, j), 1e-15) << "rounding";
            EXPECT_NEAR(forces(i, j), forces(j, i), 1e-15) << "rounding";
        }
}

TEST(Load, AFootprintFollowsItsProfile)
{
    const PlateGrid fine{100, 100, 0.01, 0.01};
    const double    radius = 0.25, r = 0.1;
    const NodeField forces  = footprintLoad(fine, 1, 0.5, 0.5, radius);
    const double    profile = std::pow(1 - r * r / (radius * radius), 2) * 3 / (3.14159265358979324 * radius * radius);

    EXPECT_NEAR(forces(60, 50) / (profile * nodeArea(fine, 60, 50)), 1, 5e-3)
        << "spread over cells: second derivative of the profile times h^2/6, 4e-3";
    EXPECT_EQ(forces(50 + 27, 50), 0) << "beyond the rim and one cell";
}

TEST(Load, AFootprintChangesSmoothlyWhileTheContactSlides)
{
    const auto at = [](double x) { return footprintLoad(kGrid, 1, x, 2.25, 0.6); };
    // Nothing changes faster than the bilinear shares themselves: by step/spacing of the whole force.
    const double step = 1e-4;
    for (double x = 1; x < 1.5; x += 0.05) {
        const NodeField here = at(x), there = at(x + step);
        for (std::size_t k = 0; k < here.values().size(); ++k)
            EXPECT_LT(std::abs(there.values()[k] - here.values()[k]), step / kGrid.spacingX);
    }
}

TEST(Load, AFootprintMustLieOnThePlateAndCoverASpacing)
{
    EXPECT_TRUE(
        holds(refusalOf([] { static_cast<void>(footprintLoad(kGrid, 1, 0.4, 2, 0.5)); }), {"wholly on the plate"}));
    EXPECT_TRUE(
        holds(refusalOf([] { static_cast<void>(footprintLoad(kGrid, 1, 1.5, 4.1, 0.5)); }), {"wholly on the plate"}));
    EXPECT_TRUE(
        holds(refusalOf([] { static_cast<void>(footprintLoad(kGrid, 1, 1.5, 2, 0.4)); }), {"one spacing", "0.5"}));
    EXPECT_TRUE(
        holds(refusalOf([] { static_cast<void>(footprintLoad(kGrid, 1, 1.5, 2, std::nan(""))); }), {"footprint"}));
    EXPECT_EQ(refusalOf([] { static_cast<void>(footprintLoad(kGrid, 1, 0.5, 0.5, 0.5)); }), "") << "touches two edges";
}

TEST(Load, InterpolationIsExactForBilinearFieldsUpToTheEdges)
{
    NodeField  field(kGrid);
    const auto bilinear = [](double x, double z) { return 1 + 2 * x - 3 * z + 0.5 * x * z; };
    for (int i = 0; i < kGrid.nodesX(); ++i)
        for (int j = 0; j < kGrid.nodesZ(); ++j) field(i, j) = bilinear(i * kGrid.spacingX, j * kGrid.spacingZ);

    for (const double x : {0.0, 0.1, 1.5, 2.9, 3.0})
        for (const double z : {0.0, 0.7, 4.4, 4.5})
            EXPECT_NEAR(interpolate(kGrid, field, x, z), bilinear(x, z), 1e-13) << "rounding";
}

TEST(Load, PlacesBeyondThePlateAreAMistakeOfTheCaller)
{
    const NodeField field(kGrid);

    EXPECT_THROW(static_cast<void>(interpolate(kGrid, field, 3.01, 1)), ContractViolation);
    EXPECT_THROW(static_cast<void>(interpolate(kGrid, field, std::nan(""), 1)), ContractViolation);
    EXPECT_THROW(static_cast<void>(interpolate(kGrid, NodeField(3, 3), 1, 1)), ContractViolation);
    EXPECT_THROW(static_cast<void>(pointLoad(kGrid, 1, -0.01, 1)), ContractViolation);
    EXPECT_THROW(static_cast<void>(gridLoad(kGrid, NodeField(3, 3))), ContractViolation);
}

} // namespace
} // namespace palp
