#include "engine/plate/multigrid/direct_plate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "engine/plate/load.h"
#include "engine/plate/reference/reference_plate_solver.h"
#include "tests/support/errors.h"

namespace palp {
namespace {

/// A disc in a plate, beside its middle.
Plate discIn(int cellsX, int cellsZ, double contrast, const PlateEdges& edges, double foundation = 0)
{
    Plate plate;
    plate.grid         = {.cellsX = cellsX, .cellsZ = cellsZ, .spacingX = 1.0 / cellsX, .spacingZ = 0.9 / cellsZ};
    plate.edges        = edges;
    plate.poissonRatio = 0.45;
    plate.foundation   = foundation;
    plate.rigidity     = NodeField(plate.grid, 2.0);
    if (foundation > 0) plate.foundationShape = NodeField(plate.grid, 1.0);
    for (int i = 0; i <= cellsX; ++i)
        for (int j = 0; j <= cellsZ; ++j) {
            const double x = i * plate.grid.spacingX - 0.42, z = j * plate.grid.spacingZ - 0.4;
            if (std::hypot(x, z) < 0.15) plate.rigidity(i, j) *= contrast;
            if (foundation > 0) plate.foundationShape(i, j) += x;
        }
    return plate;
}

/// Footprints of a table, which move along x.
std::vector<Footprint> tableOn(const PlateGrid& grid, int side)
{
    constexpr double       kRadius = 0.1, kStep = 1e-3;
    std::vector<Footprint> loads;
    for (int m = 0; m < side; ++m)
        for (int n = 0; n < side; ++n) {
            const double    x = 0.3 + 0.3 * m / (side - 1), z = 0.25 + 0.3 * n / (side - 1);
            const NodeField load = footprintLoad(grid, 1, x, z, kRadius);
            NodeField       move = footprintLoad(grid, 1, x + kStep, z, kRadius);
            for (std::size_t k = 0; k < move.values().size(); ++k)
                move.values()[k] = (move.values()[k] - load.values()[k]) / kStep;
            loads.emplace_back(load, move, NodeField(grid));
        }
    return loads;
}

const PlateEdges kClamped{}, kCantilever{Edge::clamped, Edge::free, Edge::free, Edge::free},
    kMixed{Edge::supported, Edge::guided, Edge::free, Edge::clamped},
    kFree{Edge::free, Edge::free, Edge::free, Edge::free};

/// What a plate's answer is does not depend on the plates that were solved before, to the bit.
TEST(DirectPlate, AnswersAlikeInTheUnitOfAnotherPlate)
{
    const Plate plate = discIn(40, 33, 100, kClamped);
    const auto  loads = tableOn(plate.grid, 3);
    DirectPlate own(plate);
    const auto  answer = own.solve(plate, loads, 4, 1);
    ASSERT_TRUE(answer);
    for (const double scale : {0.5, 2.0, 7.0, 64.0}) {
        Plate other = plate;
        for (double& rigidity : other.rigidity.values()) rigidity *= scale;
        DirectPlate earlier(other);
        ASSERT_TRUE(earlier.suits(plate)) << scale;
        const auto again = earlier.solve(plate, loads, 4, 1);
        ASSERT_TRUE(again) << scale;
        for (std::size_t n = 0; n < loads.size(); ++n)
            EXPECT_EQ(again->responses[n].work, answer->responses[n].work) << scale << ", load " << n;
    }
}

/// The reference has the same matrix in doubles; here rigidities are floats, rounded by 6e-8 at most. A cantilever's
/// parts all bend it, and the matrix's condition of up to 1e11 times what doubles round, 1e-16, is 1e-5 at worst.
TEST(DirectPlate, WhatFootprintsFeelIsThatOfTheReference)
{
    struct Case {
        PlateEdges edges;
        double     contrast, foundation;
    };
    for (const auto& [edges, contrast, foundation] :
         {Case{kClamped, 100, 0}, Case{kClamped, 1e6, 0}, Case{kClamped, 1e-4, 0}, Case{kMixed, 1e3, 0},
          Case{kCantilever, 1e4, 0}, Case{kFree, 100, 3e3}}) {
        const Plate                plate = discIn(44, 37, contrast, edges, foundation);
        const auto                 loads = tableOn(plate.grid, 5);
        const ReferencePlateSolver reference(plate);
        const auto                 found = DirectPlate(plate).solve(plate, loads, 7, 1e-4);
        ASSERT_TRUE(found) << contrast;
        for (std::size_t n = 0; n < loads.size(); ++n) {
            const NodeField         w     = reference.solve(loads[n].load(plate.grid)).deflection;
            const FootprintResponse truth = responseOf(loads[n], w);
            EXPECT_NEAR(found->responses[n].work / truth.work, 1, 1e-6) << contrast << ", load " << n;
            EXPECT_NEAR(found->responses[n].changeX, truth.changeX, 1e-5 * std::abs(truth.work / 0.1)) << n;
            if (n == 7) {
                EXPECT_LT(errorOf(found->whole.deflection, w), 1e-6) << contrast;
            }
        }
    }
}

TEST(DirectPlate, TheAnswerDoesNotHangOnWhatElseIsSolvedNorOnThePlateBefore)
{
    const Plate            plate = discIn(44, 37, 300, kClamped), other = discIn(44, 37, 1e5, kClamped);
    const auto             loads = tableOn(plate.grid, 4);
    DirectPlate            direct(other);
    const auto             all = direct.solve(plate, loads, 3, 1e-2);
    std::vector<Footprint> some(loads.begin() + 3, loads.begin() + 6);
    (void)direct.solve(other, loads, 0, 1e-2);
    ASSERT_TRUE(direct.suits(plate));
    const auto few = direct.solve(plate, some, 0, 1e-2), anew = DirectPlate(plate).solve(plate, some, 0, 1e-2);
    for (std::size_t n = 0; n < some.size(); ++n) {
        EXPECT_EQ(few->responses[n].work, all->responses[3 + n].work);
        EXPECT_EQ(anew->responses[n].work, all->responses[3 + n].work);
        EXPECT_EQ(anew->responses[n].changeX, all->responses[3 + n].changeX);
    }
    EXPECT_EQ(few->whole.deflection.values(), all->whole.deflection.values());
}

TEST(DirectPlate, RefusesWhatDoublesDoNotTell)
{
    // A foundation of nothing beside the plate: what holds it is lost to rounding.
    const Plate loose = discIn(24, 24, 100, kFree, 1e-15);
    const auto  loads = tableOn(loose.grid, 3);
    EXPECT_FALSE(DirectPlate(loose).solve(loose, loads, 0, 1e-2));
    const Plate plate             = discIn(24, 24, 100, kClamped);
    auto        broken            = loads;
    broken[4].parts.front().force = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(DirectPlate(plate).solve(plate, broken, 0, 1e-2));
    EXPECT_FALSE(DirectPlate(plate).solve(plate, broken, 4, 1e-2));
    EXPECT_FALSE(DirectPlate(plate).solve(plate, loads, 0, 1e-9)) << "less than floats round a rigidity";
    EXPECT_FALSE(DirectPlate(plate).suits(discIn(25, 24, 100, kClamped)));
    EXPECT_FALSE(DirectPlate(plate).suits(discIn(24, 24, 100, kClamped, 3)));
    Plate other      = plate;
    other.foundation = 1;
    EXPECT_FALSE(DirectPlate(plate).suits(other));
    Plate torn    = plate;
    torn.rigidity = discIn(12, 12, 100, kClamped).rigidity;
    EXPECT_FALSE(DirectPlate::pays(torn, 1000)) << "a rigidity on another grid";
    EXPECT_THROW((void)DirectPlate(plate).solve(plate, tableOn(discIn(40, 40, 1, kClamped).grid, 3), 0, 1e-2),
                 ContractViolation);
    EXPECT_FALSE(DirectPlate(plate).suits(discIn(24, 24, 100, kCantilever)));
}

TEST(DirectPlate, PaysForManyFootprintsOnSmallPlatesThatJump)
{
    const Plate disc = discIn(64, 64, 100, kClamped), strong = discIn(64, 64, 1e5, kClamped);
    EXPECT_TRUE(DirectPlate::pays(disc, 49));
    EXPECT_FALSE(DirectPlate::pays(disc, 9));
    EXPECT_TRUE(DirectPlate::pays(strong, 9));
    EXPECT_FALSE(DirectPlate::pays(strong, 1));
    EXPECT_FALSE(DirectPlate::pays(discIn(128, 128, 100, kClamped), 49));
    EXPECT_TRUE(DirectPlate::pays(discIn(128, 128, 1e5, kClamped), 49));
    Plate smooth = disc;
    for (int i = 0; i <= 64; ++i)
        for (int j = 0; j <= 64; ++j) smooth.rigidity(i, j) = std::exp(6.0 * i / 64);
    EXPECT_FALSE(DirectPlate::pays(smooth, 49)) << "a contrast of 400 without a jump";
}

} // namespace
} // namespace palp
