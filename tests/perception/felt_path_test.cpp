#include "engine/perception/felt_path.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/perception/scene_perception.h"
#include "tests/session/sheet_session.h"
#include "tests/support/errors.h"

namespace palp {
namespace {

struct Felt {
    explicit Felt(const Scene& of) : scene(of), object(loadObject(of).object) {}

    [[nodiscard]] FeltLine line(double reach, const std::optional<glm::dvec3>& direction = {}) const
    {
        return feltLine(scene, object, direction, reach);
    }

    Scene       scene;
    SoftObject  object;
    PlateSolver solver{"host"};
};

TEST(FeltPath, AWartIsNoticedAtRestAndSlidingAndTheFloorIsNot)
{
    Felt                  felt(sheetScene(kWart));
    const ScenePerception p = perceive(felt.scene, felt.object, felt.line(15e-3), 21, felt.solver);

    EXPECT_GT(p.sliding[0].whole, 5) << "ten times as stiff, 3 mm wide: about 9 steps on a fine grid";
    for (std::size_t n = 0; n < 3; ++n) {
        EXPECT_NEAR(p.sliding[n].whole / p.atRest[n].whole, 1, 0.1) << "tables and windows agree to some per cent";
        EXPECT_LE(p.sliding[n].passing, p.sliding[n].whole);
        EXPECT_GT(p.sliding[n].passing, 0.3 * p.sliding[n].whole) << "its flank is 5 mm wide";
        EXPECT_EQ(p.sliding[n].right, rightAnswers(p.sliding[n].whole));
    }
    EXPECT_TRUE(p.floorIsLow());
    EXPECT_LT(p.sliding[0].floor, 0.02) << "measured 0.003, the governor's damping; 0.5 is asked";
    EXPECT_LT(p.atRest[0].floor, 1e-6) << "exact by construction but for rounding";
    for (std::size_t n = 1; n < 3; ++n) EXPECT_LT(p.sliding[n].whole, p.sliding[n - 1].whole) << "coarser fingers";
}

TEST(FeltPath, TheFloorOfCurvedObjectsIsBelowHalfAStep)
{
    for (const char* const object : {R"("sample:ellipsoid", "place": [0.03, 0, 0.0303])",
                                     R"("sample:palm", "place": [0, 0, 0], "from": [0, 0, 1])"}) {
        Felt felt(parseScene(R"({"thickness": "4 mm", "poisson": 0.45, "foundation": "1.74 MPa/m", "points": 8000,
            "window": "70 mm", "cells": 32, "footprint_radius": "4.4 mm", "solver": "host", "cloud": )" +
                                 std::string(object) + "}",
                             "a test", "."));
        const auto stroke = strokeAlong(homogeneous(felt.object), felt.scene, felt.line(12e-3)).ticks;
        EXPECT_GT(stroke.size(), 1000U) << "of 1.5 s that it goes to and fro, or little is shown";
        EXPECT_LT(heldShare(stroke), 0.1) << "what is held is not compared";
        const auto floor = rangeOf(stroke);
        EXPECT_LT(noticeableSteps(floor.whole, kWeberFractions[0]), kMostFloor) << object;
    }
}

/// Where the stroke turns friction holds the proxy, and then lets it go: that must not be felt as another stiffness.
TEST(FeltPath, AStrokeHasNoSpikesWhereItTurns)
{
    for (const char* const object : {R"("sample:ellipsoid", "place": [0, 0, 0.035], "from": [0, 0, 1], "stiffness":
            {"law": "linear", "from": 0.15e6, "to": 1.5e6, "axis": "x"})",
                                     R"("sample:palm", "place": [0, 0, 0], "from": [0, 0, 1])"}) {
        Felt felt(parseScene(R"({"thickness": "4 mm", "poisson": 0.45, "foundation": "1.74 MPa/m", "points": 8000,
            "window": "70 mm", "cells": 32, "footprint_radius": "4.4 mm", "solver": "host", "cloud": )" +
                                 std::string(object) + "}",
                             "a test", "."));
        const auto stroke = strokeAlong(felt.object, felt.scene, felt.line(20e-3)).ticks;
        EXPECT_GT(stroke.size(), 2000U) << "of 2.5 s that it goes to and fro, or little is shown";
        double most = 0; // [1] change of the felt stiffness in a millisecond
        for (std::size_t n = 1; n < stroke.size(); ++n)
            most = worse(most, std::log(stroke[n].stiffness / stroke[n - 1].stiffness));
        std::printf("  %s: %.2f %% in a millisecond\n", object, most * 100);
        EXPECT_LT(most, 0.01) << object << ": 50 mm/s over a slope of 10 % per mm are 0.5 %; the spikes had 10 %";
    }
}

TEST(FeltPath, FollowsItsDirectionAndTheSurface)
{
    Felt             felt(parseScene(R"({"cloud": "sample:ellipsoid", "points": 8000, "cells": 16})", "a test", "."));
    const FeltLine   line   = felt.line(12e-3, glm::dvec3(0, 3, 0));
    const auto       places = windowsAlong(felt.object, felt.scene.patch, line, 5, felt.solver);
    const glm::dvec3 first = places.front().place, last = places.back().place;

    EXPECT_NEAR(last.y - first.y, 24e-3, 1e-3) << "the place is the nearest point, a spacing of 1.3 mm off";
    EXPECT_NEAR(last.x, first.x, 1e-5) << "heights are along the normal of a point 0.2 mm beside the top";
    for (const FeltPlace& p : places) {
        const glm::dvec3 unit = p.place / glm::dvec3(60e-3, 45e-3, 35e-3);
        EXPECT_NEAR(glm::length(unit), 1, 0.01) << "heights are means over three spacings";
    }
    EXPECT_THROW((void)felt.line(12e-3, glm::dvec3(0, 0, 1)), Error) << "away from the surface";
    EXPECT_THROW((void)felt.line(12e-3, glm::dvec3(0)), Error);
    EXPECT_THROW((void)felt.line(12e-3, glm::dvec3(0, std::nan(""), 0)), Error);
}

/// A sheet that bends up by 60 degrees: seen from a direction in between, its steep half lies 82 degrees off.
Felt bentSheet(const glm::dvec3& from)
{
    constexpr double kAngle = 60 * std::numbers::pi / 180, kApart = 0.7e-3;
    Felt             felt(parseScene(R"({"cloud": "sample:ellipsoid", "points": 2000, "cells": 16, "window": "18 mm",
        "place": [0, 0, 0], "foundation": "1 MPa/m"})",
                                     "a test", "."));
    std::vector<glm::dvec3> points;
    for (double x = -20e-3; x < 20e-3; x += kApart)
        for (double y = -20e-3; y < 20e-3; y += kApart)
            points.emplace_back(x > 0 ? x * std::cos(kAngle) : x, y, x > 0 ? x * std::sin(kAngle) : 0);
    const std::vector<double> stiffness(points.size(), 3e5);
    felt.object     = SoftObject(PointCloud(std::move(points), stiffness, StiffnessKind::modulus), felt.scene.material);
    felt.scene.from = from;
    return felt;
}

/// The side of a place is told by the surface there, not by the direction of the path's middle.
TEST(FeltPath, TheFingerTurnsWithTheSurface)
{
    Felt       felt = bentSheet({0.37, 0, 0.93}); // 22 degrees off the flat half and 82 off the other
    const auto places =
        windowsAlong(felt.object, felt.scene.patch, felt.line(9e-3, glm::dvec3(1, 0, 0)), 21, felt.solver);
    EXPECT_EQ(places.size(), 21U);
    for (const FeltPlace& p : places) EXPECT_TRUE(p.compliance > 0) << p.along;
}

TEST(FeltPath, AHandThatAWallHoldsIsSaidToBeHeld)
{
    Felt       felt   = bentSheet({0, 0, 1});
    const auto stroke = strokeAlong(felt.object, felt.scene, felt.line(6e-3, glm::dvec3(1, 0, 0))).ticks;
    EXPECT_EQ(heldShare(stroke), 0) << "the stroke follows the bend";
    std::vector<FeltTick> ticks{{0, 100, false}, {1e-3, 200, false}, {2e-3, 1e4, true}, {2e-3, 1, true}};
    EXPECT_EQ(heldShare(ticks), 0.5);
    EXPECT_NEAR(rangeOf(ticks).whole, std::log(2.0), 1e-12) << "held ticks do not count";
    EXPECT_NEAR(rangeOf(ticks).passing, std::log(2.0), 1e-12);
    ticks[1].along = 1.1 * kPassing;
    EXPECT_TRUE(std::isnan(rangeOf(ticks).passing)) << "no two places are so near that they could be compared";
}

TEST(FeltPath, TheHomogeneousTwinHasTheGeometricMeanEverywhere)
{
    const SoftObject object(PointCloud({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {1, 10, 100}, StiffnessKind::rigidity));
    const SoftObject twin = homogeneous(object);
    for (const double stiffness : twin.cloud().stiffness()) EXPECT_NEAR(stiffness, 10, 1e-13) << "rounding";
    EXPECT_EQ(twin.cloud().kind(), StiffnessKind::rigidity);
    EXPECT_EQ(twin.positions()[1], object.positions()[1]);
}

TEST(FeltPath, TheHomogeneousTwinStiffensAlikeEverywhere)
{
    const SoftObject object =
        SoftObject(PointCloud({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {1, 1, 1}, StiffnessKind::rigidity))
            .withStiffening({0, 300, 900});
    const SoftObject twin = homogeneous(object);
    ASSERT_EQ(twin.stiffening().size(), 3u);
    for (const double b : twin.stiffening()) EXPECT_NEAR(b, 400, 1e-10);
    EXPECT_TRUE(homogeneous(object.withStiffening({})).stiffening().empty()) << "the material says it";
}

} // namespace
} // namespace palp
