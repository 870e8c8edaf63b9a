#include "engine/session/scene_held.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/core/contract.h"
#include "engine/session/deformation.h"
#include "engine/session/scene.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

const std::string kRows = [] {
    std::string rows = "x,y,z,stiffness,held\n";
    for (int i = -30; i < 30; ++i)
        for (int j = -15; j < 15; ++j)
            rows +=
                std::to_string(i * 1e-3) + "," + std::to_string(j * 1e-3) + ",0,3e5," + (i < -20 ? "1" : "0") + "\n";
    return rows;
}();

Scene sceneWith(const std::filesystem::path& file, const std::string& held, const std::string& keys = "")
{
    return parseScene(
        R"({"window": "object", "thickness": "2 mm", "foundation": 0, "place": [0.02, 0, 0], "from": [0, 0, 1])" +
            (held.empty() ? held : R"(, "held": )" + held) + keys + "}",
        "a test", ".", {.flags = {{"cloud", file.string()}}});
}

double heldOf(const Scene& scene)
{
    const LoadedObject loaded = loadObject(scene);
    double             sum    = 0;
    for (const double share : loaded.object.held()) sum += share;
    return sum;
}

TEST(Held, RegionsHoldThePointsInThem)
{
    const TemporaryFolder folder;
    const auto            file = folder.write("strip.csv", kRows);
    EXPECT_EQ(heldOf(sceneWith(file, R"({"box": [[-0.0205, 1, -1], [-1, -1, 1]]})")), 10 * 30)
        << "corners in any order";
    EXPECT_EQ(heldOf(sceneWith(file, R"({"ball": [0, 0, 0], "radius": "1.1 mm"})")), 5);
    EXPECT_EQ(heldOf(sceneWith(file, R"({"points": [[0, 0, 0], [0.01, 0, 0]], "radius": 1.1e-3})")), 10);
    EXPECT_EQ(
        heldOf(sceneWith(file, R"([{"ball": [0, 0, 0], "radius": 1.1e-3}, {"ball": [0, 0, 0], "radius": 5e-4}])")), 5);
    EXPECT_EQ(heldOf(sceneWith(file, R"("own")")), 10 * 30) << "the file's property";
}

TEST(Held, IsWrittenAsItIsRead)
{
    const TemporaryFolder folder;
    const auto            file = folder.write("strip.csv", kRows);
    for (const char* held : {R"({"box": [[-0.03, -1, -1], [-0.02, 1, 1]]})", R"({"ball": [0, 0, 0], "radius": 0.005})",
                             R"({"points": [[0, 0, 0], [0.01, 0, 0]], "radius": 0.001})", R"("own")",
                             R"([{"ball": [0, 0, 0], "radius": 0.005}, {"box": [[-1, -1, -1], [-0.02, 1, 1]]}])"}) {
        const Scene scene = sceneWith(file, held), again = parseScene(sceneJson(scene), "again", ".");
        EXPECT_EQ(sceneJson(again), sceneJson(scene)) << held;
        EXPECT_EQ(again.patch.windowOf, WindowOf::object);
        EXPECT_EQ(heldOf(again), heldOf(scene)) << held;
        EXPECT_TRUE(haveSameCloud(again, scene));
    }
    EXPECT_FALSE(haveSameCloud(sceneWith(file, R"("own")"), sceneWith(file, R"({"ball": [0, 0, 0], "radius": 1})")));
}

TEST(Held, OfManyPlacesEachHoldsWhatIsNear)
{
    const TemporaryFolder folder;
    const auto            file = folder.write("strip.csv", kRows);
    std::string           few, many; // the same places, some of them often
    for (int n = 0; n < 40; ++n) {
        const std::string place = "[" + std::to_string(0.001 * (n % 8)) + ", 0.002, 0]";
        if (n < 8) few += (few.empty() ? "" : ", ") + place;
        many += (many.empty() ? "" : ", ") + place;
    }
    const auto held = [&](const std::string& places) {
        return heldOf(sceneWith(file, R"({"radius": 0.0031, "points": [)" + places + "]}"));
    };
    EXPECT_EQ(held(many), held(few));
    EXPECT_GT(held(few), 50);
    EXPECT_EQ(held(many + ", [1e300, 0, 0], [-1e9, 1e9, 3]"), held(few)) << "places far off hold nothing";
}

TEST(Held, OfManyPlacesThoseBesideThePointsHoldTheOutermostOnes)
{
    std::vector<glm::dvec3> positions, places{{-31.2e-3, -15.5e-3, 0.5e-3}, {30.2e-3, 14.8e-3, -0.4e-3}};
    for (int i = -30; i < 30; ++i)
        for (int j = -15; j < 15; ++j) positions.emplace_back(1e-3 * i, 1e-3 * j, 0);
    for (int n = 0; n < 38; ++n) places.emplace_back(-20e-3 + 1.3e-3 * n, 0.4e-3 * (n - 19), 1e-3 * (n % 3 - 1));
    std::string list;
    for (const glm::dvec3& p : places)
        list += (list.empty() ? "[" : ", [") + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " +
                std::to_string(p.z) + "]";

    const SceneHeld held   = parseHeld(R"({"radius": "2.05 mm", "points": [)" + list + "]}", "a test");
    const auto      shares = heldShares(positions, held, {}, "a test");

    ASSERT_EQ(shares.size(), positions.size());
    for (std::size_t n = 0; n < positions.size(); ++n) {
        const auto holds = [&](const glm::dvec3& place) { return glm::distance(place, positions[n]) < 2.05e-3; };
        EXPECT_EQ(shares[n], std::ranges::any_of(places, holds) ? 1 : 0) << "point " << n;
    }
    EXPECT_EQ(shares.front(), 1) << "its place is beyond it";
    EXPECT_EQ(shares.back(), 1);
}

TEST(Held, MistakesAreNamed)
{
    const TemporaryFolder folder;
    const auto            file    = folder.write("strip.csv", kRows);
    const auto            refused = [&](const std::string& held, std::initializer_list<std::string_view> words) {
        EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(loadObject(sceneWith(file, held))); }), words)) << held;
    };
    refused("", {"window", "held", "foundation", "neither"});
    refused(R"({"box": [[0, 0, 0]]})", {"held", "box", "two opposite corners"});
    refused(R"({"box": [[0, 0, 0], [1, 1, 1]], "radius": 1})", {"held", "unknown key \"radius\"", "known keys: box"});
    refused(R"({"ball": [0, 0, 0]})", {"held", "radius", "missing"});
    refused(R"({"ball": [0, 0, 0], "radius": -1})", {"held", "radius", "1e-6 to 100 m"});
    refused(R"({"points": [], "radius": 1})", {"held", "points", "1 to 10000 places"});
    refused(R"({"cone": 1})", {"held", "unknown key \"cone\"", "box"});
    refused(R"([])", {"key \"held\": expected a list of 1 to 64 regions"});
    refused(R"([{"ball": [0, 0, 0], "radius": 1}, {"ball": 1, "radius": 1}])", {"held region 2: key \"ball\""});
    std::string places = "[0, 0, 0]";
    for (int n = 1; n < 5001; ++n) places += ", [0, 0, 0]";
    const std::string half = R"({"radius": 1, "points": [)" + places + "]}";
    const std::string most = half.substr(0, half.size() - std::string(", [0, 0, 0]]}").size()) + "]}";
    EXPECT_EQ(parseHeld("[" + most + ", " + most + R"(, {"box": [[0, 0, 0], [1, 1, 1]]}])", "a test").regions.size(),
              3U)
        << "a box is not among the 10000 places";
    refused("[" + half + ", " + half + "]", {"held", "at most 10000 places in all regions", "found 10002"});
    refused(R"("firmly")", {"held"});
    refused(R"({"ball": [9, 9, 9], "radius": 0.1})", {"held", "at least one point", "1800", "metres"});
    refused(R"(7)", {"held", "box"});
    const auto free = folder.write("free.csv", "x,y,z\n0,0,0\n1,0,0\n0,1,0\n");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(loadObject(sceneWith(free, R"("own")"))); }),
                      {"held", "property held", "found none"}));
    const auto bad = folder.write("bad.csv", "x,y,z,held\n0,0,0,1\n1,0,0,2\n");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readCloud(bad)); }), {"line 3", "0, free, to 1, held"}));
}

TEST(Held, ASessionFeelsTheWholeObject)
{
    const TemporaryFolder folder;
    const Scene           scene  = sceneWith(folder.write("strip.csv", kRows), R"("own")");
    const SoftObject      object = loadObject(scene).object;
    Deformation           deformation(object, scene);
    Touch                 touch;
    touch.touching    = true;
    touch.point       = {0.02, 0, 0};
    touch.outward     = {0, 0, 1};
    const auto answer = deformation.solve(touch, 0);
    ASSERT_TRUE(answer.update) << answer.why;
    PlateSolver host("host");
    const Patch alone = deform(object, {{0.02, 0, 0}, {0, 0, 1}}, scene.patch, host);
    EXPECT_NEAR(std::exp(answer.update->table.middle().lnCompliance) / alone.compliance, 1, 1e-3) << "the tolerance";
}

} // namespace
} // namespace palp
