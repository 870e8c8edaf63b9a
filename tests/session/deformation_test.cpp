#include "engine/session/deformation.h"

#include <utility>

#include <gtest/gtest.h>

#include "engine/session/scene.h"

namespace palp {
namespace {

/// Answers of a sheet that is held along two sides and bends as a whole.
class ObjectDeformation : public ::testing::Test {
protected:
    Scene scene = parseScene(
        R"({"cloud": "sample:sheet", "points": 4000, "thickness": "2 mm", "footprint_radius": "5 mm", "window": "object",
            "solver": "host", "held": [{"box": [[-1, -1, -1], [-0.06, 1, 1]]}, {"box": [[0.06, -1, -1], [1, 1, 1]]}]})",
        "a test", ".");
    SoftObject  object = loadObject(scene).object;
    Deformation deformation{object, scene};

    DeformationAnswer touch(double x, double z, double up = 1)
    {
        return deformation.solve({++sequence_, double(sequence_), true, {x, z, 0}, {0, 0, up}, {}}, 0);
    }
    int attempts() const { return deformation.plateSolver().counts().attempts; }

private:
    std::uint64_t sequence_ = 0;
};

TEST_F(ObjectDeformation, HoldsForWhatIsTouchedWithinHalfTheReachOfItsTable)
{
    const DeformationAnswer first = touch(0.01, 0);
    ASSERT_TRUE(first.update) << first.why;
    const double reach  = first.update->table.reach();
    const int    solved = attempts();
    EXPECT_EQ(first.update->table.side, ComplianceTable::kMostSide);

    const DeformationAnswer beside = touch(0.01 + 0.45 * reach, -0.45 * reach);
    ASSERT_TRUE(beside.update);
    EXPECT_EQ(attempts(), solved);
    EXPECT_EQ(beside.update->table.sequence, 2u);
    EXPECT_EQ(beside.update->table.time, 2);
    EXPECT_EQ(beside.update->table.chart.origin, first.update->table.chart.origin);
    ASSERT_TRUE(beside.patch);
    EXPECT_EQ(beside.patch->response.values(), first.patch->response.values());
    EXPECT_NE(beside.update, first.update); // which a servo may be reading

    // What the table says there is what an answer of its own says, to what a table interpolates (0.4 %, see there).
    const auto              place = first.update->table.chart.project(beside.patch->contact.point);
    Deformation             fresh(object, scene);
    const DeformationAnswer direct = fresh.solve({1, 1, true, beside.patch->contact.point, {0, 0, 1}, {}}, 0);
    EXPECT_NEAR(first.update->table.at(*place).lnCompliance, direct.update->table.middle().lnCompliance, 4e-3);

    EXPECT_TRUE(touch(0.01 + 0.55 * reach, 0).update);
    EXPECT_GT(attempts(), solved);
}

TEST_F(ObjectDeformation, IsSolvedAnewOnTheOtherSideAndWhenItIsPainted)
{
    ASSERT_TRUE(touch(0, 0).update);
    int        solved = attempts();
    const auto anew   = [&] { return attempts() > std::exchange(solved, attempts()); };
    EXPECT_TRUE(touch(0, 0, -1).update);
    EXPECT_TRUE(anew());
    EXPECT_TRUE(touch(0, 0, -1).update);
    EXPECT_FALSE(anew());
    const SoftObject painted = object;
    deformation.repaint(painted);
    EXPECT_TRUE(touch(0, 0, -1).update);
    EXPECT_TRUE(anew());
}

} // namespace
} // namespace palp
