#include "engine/session/deformation.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/pipeline/deform.h"
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
    EXPECT_EQ(first.update->table.side, 5);

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

/// Points of a surface over a square lattice.
SoftObject surface(const Scene& scene, const std::function<double(double, double)>& height,
                   const std::function<bool(double, double)>& inside, const std::function<bool(double, double)>& held)
{
    std::vector<glm::dvec3> points;
    std::vector<double>     shares;
    for (int i = -40; i <= 40; ++i)
        for (int j = -40; j <= 40; ++j) {
            const double x = 1e-3 * i, y = 1e-3 * j;
            if (!inside(x, y)) continue;
            points.emplace_back(x, y, height(x, y));
            shares.push_back(held(x, y));
        }
    std::vector<double> moduli(points.size(), 1e6);
    return SoftObject(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus), scene.material)
        .withHeld(std::move(shares));
}

Scene sceneOfShells()
{
    return parseScene(R"({"cloud": "sample:sheet", "thickness": "1 mm", "window": "object", "theory": "shell",
                          "solver": "host", "held": {"ball": [0, 0, 0], "radius": 0.001}})",
                      "a test", ".");
}

Touch touchOn(double x, double y, double z, std::uint64_t sequence)
{
    return {sequence, double(sequence), true, {x, y, z}, {0, 0, 1}, {}};
}

TEST(CurvedObjectDeformation, PressesOneWindowWhereverTheContactGoes)
{
    const Scene scene  = sceneOfShells();
    const auto  sphere = [](double x, double y) { return std::sqrt(0.08 * 0.08 - x * x - y * y) - 0.08; };
    const auto  object = surface(
         scene, sphere, [](double x, double y) { return std::hypot(x, y) < 36e-3; },
         [](double x, double y) { return std::hypot(x, y) > 32e-3; });
    Deformation   deformation(object, scene);
    glm::dvec3    origin{};
    std::uint64_t sequence = 0;
    for (const auto& [x, y] :
         {std::pair(0.02, 0.0), std::pair(-0.02, 0.0), std::pair(0.0, 0.025), std::pair(0.0, 0.0)}) {
        const auto answer = deformation.solve(touchOn(x, y, sphere(x, y), ++sequence), 0);
        ASSERT_TRUE(answer.update && answer.patch) << answer.why;
        if (sequence == 1) origin = answer.patch->chart.origin;
        EXPECT_EQ(answer.patch->chart.origin, origin);
        EXPECT_LT(glm::length(answer.update->table.chart.origin - answer.patch->contact.point), 1e-5);
        EXPECT_TRUE(answer.update->table.lasts);
        EXPECT_EQ(answer.update->table.sequence, sequence);
        if (sequence > 1) {
            EXPECT_EQ(answer.patch->report.setUpMilliseconds, 0) << "the factor is that of the first touch";
        }
        const auto own = deform(object, answer.patch->contact, settledFor(object, scene.patch));
        EXPECT_NEAR(answer.patch->compliance / own.compliance, 1, 0.025)
            << x << " " << y << ": lengths are off by 1.3 % there, and the rim is 8 mm away";
    }
    EXPECT_LT(glm::length(origin), 2e-3) << "the middle of the object";
}

/// A cap that is held at one side wants a window of its own at its tip; what is felt back in the middle is not felt
/// through that.
TEST(CurvedObjectDeformation, APlaceFeelsAlikeWhicheverWayTheHandHasCome)
{
    const Scene scene  = sceneOfShells();
    const auto  sphere = [](double x, double y) { return std::sqrt(0.06 * 0.06 - x * x - y * y) - 0.06; };
    const auto  object = surface(
         scene, sphere, [](double x, double y) { return std::hypot(x, y) < 36e-3; },
         [](double x, double) { return x < -24e-3; });
    Deformation deformation(object, scene);
    const auto  felt = [&](double x, std::uint64_t sequence) {
        return deformation.solve(touchOn(x, 0, sphere(x, 0), sequence), 0);
    };
    const auto first = felt(0.002, 1), tip = felt(0.02, 2), again = felt(0.002, 3);
    ASSERT_TRUE(first.patch && tip.patch && again.patch);
    EXPECT_NE(tip.patch->chart.origin, first.patch->chart.origin);
    EXPECT_EQ(again.patch->chart.origin, first.patch->chart.origin);
    EXPECT_NEAR(again.patch->compliance / first.patch->compliance, 1, 1e-8) << "another factor of the same window";
}

/// The middle of the object is a loose piece, of which there is no window.
TEST(CurvedObjectDeformation, HasAWindowOfItsOwnWhereTheMiddleHasNone)
{
    const Scene scene  = sceneOfShells();
    const auto  ring   = [](double x, double y) { return std::max(std::abs(x), std::abs(y)); };
    const auto  object = surface(
         scene, [](double x, double) { return 2 * x * x; },
         [&](double x, double y) { return ring(x, y) < 10.5e-3 || ring(x, y) > 19.5e-3; },
         [&](double x, double y) { return ring(x, y) > 35e-3; });
    Deformation deformation(object, scene);
    const auto  answer = deformation.solve(touchOn(0.027, 0, 2 * 0.027 * 0.027, 1), 0);
    ASSERT_TRUE(answer.update) << answer.why;
    EXPECT_TRUE(answer.isSolved);
    EXPECT_LT(glm::length(answer.patch->chart.origin - answer.patch->contact.point), 1e-5);
    const auto rests = deformation.solve(touchOn(0.027, 0, 2 * 0.027 * 0.027, 2), 0);
    ASSERT_TRUE(rests.update);
    EXPECT_FALSE(rests.isSolved) << "the last answer holds";
    const auto loose = deformation.solve(touchOn(0, 0, 0, 3), 0);
    EXPECT_FALSE(loose.update);
    ASSERT_TRUE(loose.ends) << "what was felt before may not last";
    EXPECT_FALSE(loose.ends->table.lasts);
    EXPECT_TRUE(loose.ends->table.ended);
    EXPECT_EQ(loose.ends->table.time, 2) << "it was as good as new until then, and is felt for a quarter of a second";
    EXPECT_EQ(loose.ends->table.sequence, 3U);
    EXPECT_FALSE(deformation.solve(touchOn(0, 0, 0, 4), 0).ends) << "it is told once";
    EXPECT_NE(loose.why.find("hold more of it"), std::string::npos) << loose.why;

    const auto again = deformation.solve(touchOn(0.027, 0, 2 * 0.027 * 0.027, 5), 0);
    ASSERT_TRUE(again.update);
    EXPECT_FALSE(again.update->table.ended) << "its memory may have been that of one that did";
    deformation.repaint(object);
    EXPECT_TRUE(deformation.solve(touchOn(0, 0, 0, 6), 0).ends) << "paint does not make it last";
}

/// The loop hands on what ends a table that lasts, though it is no answer.
TEST(DeformationLoop, HandsOnThatATableLastsNoLonger)
{
    std::atomic<bool> over = false;
    const auto        slow = [&](const Touch&, double) {
        over                        = true;
        DeformationAnswer answer    = {{}, {}, "no answer"};
        answer.ends                 = std::make_shared<PatchUpdate>();
        answer.ends->table.sequence = 1;
        return answer;
    };
    DeformationLoop loop(slow, 1000);
    loop.touch.draft() = {1, 1, true, {}, {0, 0, 1}, {}};
    loop.touch.publish();
    loop.run(over);
    const PatchUpdate* const newest = loop.newest(nullptr);
    ASSERT_TRUE(newest);
    EXPECT_FALSE(newest->table.lasts);
    EXPECT_EQ(loop.slow.failedPatches, 1U);
    EXPECT_FALSE(loop.patch.take()) << "nothing is drawn";
}

/// How long an answer took that is no new one says nothing of the next solve.
TEST(DeformationLoop, IsNoFartherBehindAfterARest)
{
    constexpr int     kSolves = 3, kRests = 12;
    std::atomic<bool> over  = false;
    int               calls = 0;
    double            lead  = 0; // [s]
    DeformationLoop*  of    = nullptr;
    const auto        slow  = [&](const Touch& touch, double given) {
        lead = given;
        if (++calls <= kSolves) std::this_thread::sleep_for(std::chrono::milliseconds(30));
        DeformationAnswer answer;
        answer.update              = std::make_shared<PatchUpdate>();
        answer.patch               = Patch{};
        answer.isSolved            = calls <= kSolves;
        over                       = calls > kSolves + kRests;
        of->touch.draft()          = touch;
        of->touch.draft().sequence = touch.sequence + 1;
        of->touch.publish();
        return answer;
    };
    DeformationLoop loop(slow, 500);
    of                 = &loop;
    loop.touch.draft() = {1, 1, true, {}, {0, 0, 1}, {}};
    loop.touch.publish();
    loop.run(over);
    EXPECT_GT(lead, 30e-3) << "as long as a solve takes, and half a period";
}

} // namespace
} // namespace palp
