#include "engine/session/deformation.h"

#include <atomic>
#include <memory>
#include <utility>

#include <gtest/gtest.h>

#include "engine/session/detail/deformation_loop.h"
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

/// Runs one solve of the touch at 1 s, while which the finger goes on to a place, at 2 s.
/// \return the time that its table then has [s]
double timeOfTable(bool lasts, double x)
{
    std::atomic<bool> over = false;
    DeformationLoop*  loop = nullptr;
    const auto        slow = [&](const Touch&, double) {
        loop->touch.draft() = {2, 2, true, {x, 0, 0}, {0, 0, 1}, {}};
        loop->touch.publish();
        over                   = true;
        auto update            = std::make_shared<PatchUpdate>();
        update->table.sequence = 1;
        update->table.time     = 1;
        update->table.side     = 3;
        update->table.spacing  = 5e-3;
        update->table.chart    = Chart::around({}, {0, 0, 0}, {0, 0, 1}, Map::lambertAzimuthal);
        return DeformationAnswer{std::move(update), {}, {}, {}, lasts};
    };
    DeformationLoop here(slow, 1000);
    loop               = &here;
    here.touch.draft() = {1, 1, true, {}, {0, 0, 1}, {}};
    here.touch.publish();
    here.run(over);
    const PatchUpdate* const newest = here.newest(nullptr);
    return newest ? newest->table.time : -1;
}

/// A solve that takes longer than a force lives would end it, though the table is as good as before.
TEST(DeformationLoop, AnAnswerThatLastsIsAsNewAsTheLastTouchThatItReaches)
{
    EXPECT_EQ(timeOfTable(true, 4e-3), 2);
    EXPECT_EQ(timeOfTable(true, 6e-3), 1) << "beyond the reach of 5 mm";
    EXPECT_EQ(timeOfTable(false, 4e-3), 1);
}

} // namespace
} // namespace palp
