#include "engine/session/scene_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/contact/proxy.h"
#include "engine/pipeline/deform.h"
#include "engine/session/deformation.h"
#include "engine/session/scene_keys.h"
#include "engine/session/scripted_hand.h"
#include "engine/session/virtual_session.h"
#include "tests/support/temporary_folder.h"

namespace palp {
namespace {

/// A cube of 8 corners and 6 quadrangles, 80 mm wide; the stiffness grows tenfold from its low to its high x.
const char* const kCube = R"(ply
format ascii 1.0
comment length_unit mm
element vertex 8
property float x
property float y
property float z
property float stiffness
element face 6
property list uchar int vertex_indices
end_header
-40 -40 -40 1e5
40 -40 -40 1e6
40 40 -40 1e6
-40 40 -40 1e5
-40 -40 40 1e5
40 -40 40 1e6
40 40 40 1e6
-40 40 40 1e5
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
)";

/// A grid of cells in a plane; one more vertex far out makes an edge that is much longer.
std::string gridPly(int cells, double spacing, bool withLongEdge)
{
    const int   n    = cells + 1;
    std::string text = "ply\nformat ascii 1.0\ncomment length_unit m\nelement vertex " +
                       std::to_string(n * n + (withLongEdge ? 1 : 0)) +
                       "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                       std::to_string(cells * cells + (withLongEdge ? 1 : 0)) +
                       "\nproperty list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < n * n; ++i)
        text += std::to_string(i % n * spacing) + " " + std::to_string(i / n * spacing) + " 0\n";
    if (withLongEdge) text += std::to_string(-20 * spacing) + " 0 0\n";
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            const int c = y * n + x;
            text += "4 " + std::to_string(c) + " " + std::to_string(c + 1) + " " + std::to_string(c + n + 1) + " " +
                    std::to_string(c + n) + "\n";
        }
    if (withLongEdge) text += "3 0 " + std::to_string(n) + " " + std::to_string(n * n) + "\n";
    return text;
}

class SceneMesh : public testing::Test {
protected:
    Scene sceneOf(const std::string& text, std::map<std::string, std::string, std::less<>> flags = {}) const
    {
        flags.try_emplace("cloud", folder_.write("mesh.ply", text).string());
        flags.try_emplace("footprint_radius", "4mm");
        flags.try_emplace("solver", "host");
        flags.try_emplace("cells", "32");
        return parseScene("{}", "a test", ".", {.flags = std::move(flags)});
    }

    /// The largest force on a hand that presses 2 mm into the upper side of a body of OBJ text in mm [N].
    double forceOn(const std::string& text) const
    {
        const Scene      scene  = sceneOf("", {{"cloud", folder_.write("bad.obj", text).string()},
                                               {"length_unit", "mm"},
                                               {"place", "-12mm,-9mm,40mm"},
                                               {"from", "0,0,1"}});
        const SoftObject object = loadObject(scene).object;
        const HandPath   hand = makeHand({.motion = HandMotion::press, .depth = 2e-3, .height = 1e-3, .duration = 0.3},
                                         {{-12e-3, -9e-3, 40e-3}, {0, 0, 1}});
        ScriptedHand     device(hand);
        Deformation      deformation(object, scene);
        double           most = 0;
        runVirtual({scene, object, deformation.solver(), device, {}}, 0.3,
                   [&](const TickRecord& tick) { most = std::max(most, double(tick.force.z)); });
        return most;
    }

    TemporaryFolder folder_;
};

TEST_F(SceneMesh, AHandThatPressesTheMiddleOfACubesSideMeetsAForceAndDoesNotPassThrough)
{
    const Scene      scene  = sceneOf(kCube, {{"place", "0,0,40mm"}, {"from", "0,0,1"}});
    const SoftObject object = loadObject(scene).object;
    const HandPath   hand   = makeHand({.motion = HandMotion::press, .depth = 4e-3, .height = 2e-3, .duration = 0.5},
                                       {{0, 0, 40e-3}, {0, 0, 1}});
    Deformation      deformation(object, scene);
    ScriptedHand     device(hand);
    double           most = 0, deepest = 1, lowest = 1;
    runVirtual({scene, object, deformation.solver(), device, {}}, 0.5, [&](const TickRecord& tick) {
        most    = std::max(most, double(tick.force.z));
        deepest = std::min(deepest, double(tick.hip.z));
        lowest  = std::min(lowest, double(tick.proxy.z));
    });

    EXPECT_LT(deepest, 37e-3); // the hand has pressed
    EXPECT_GT(most, 0.1);      // [N]
    EXPECT_GT(lowest, 39.9e-3) << "the proxy stays on the side";
}

TEST_F(SceneMesh, PointsAreAFifthOfAFingertipApartWithTheStiffnessBetweenTheCorners)
{
    const LoadedCloud loaded = loadCloud(sceneOf(kCube));

    EXPECT_EQ(loaded.report.points, 8u);
    EXPECT_EQ(loaded.report.scatteredPoints, loaded.cloud.size());
    EXPECT_NEAR(loaded.report.scatterDistance, 0.8e-3, 1e-15);
    EXPECT_TRUE(loaded.faces.empty());
    ASSERT_EQ(loaded.normals.size(), loaded.cloud.size());
    const SoftObject object(loaded.cloud);
    EXPECT_LE(object.spacing(), 1e-3); // a quarter of the fingertip
    for (std::size_t n = 0; n < loaded.cloud.size(); ++n) {
        const glm::dvec3 p = loaded.cloud.positions()[n];
        ASSERT_NEAR(loaded.cloud.stiffness()[n], 1e5 * std::pow(10, (p.x + 40e-3) / 80e-3), 1); // 1e-6 relative: floats
        ASSERT_GT(glm::dot(glm::dvec3(loaded.normals[n]), p), 39e-3);                           // outwards
    }
}

TEST_F(SceneMesh, TheFacesOfTheFileAreKeptForPictures)
{
    const Scene       scene  = sceneOf(kCube);
    const SoftObject  object = loadObject(scene).object.withMaterial({}); // copies share it
    const LoadedCloud file   = loadCloud(sceneOf(kCube, {{"scatter", "off"}}));

    EXPECT_EQ(object.mesh().faces, file.faces);
    EXPECT_EQ(file.faces.size(), 12u);
    EXPECT_TRUE(std::ranges::equal(object.mesh().vertices, file.cloud.positions()));
    EXPECT_TRUE(object.faces().empty());
    EXPECT_TRUE(file.mesh.faces.empty()) << "its points are those of its faces";
}

TEST_F(SceneMesh, AMeshThatNoNumberOfPointsCanStandForIsRefusedAtOnce)
{
    const std::map<std::string, std::string, std::less<>> km{{"length_unit", "km"}};

    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(loadCloud(sceneOf(kCube, km))); }),
                      {"mesh.ply: expected faces that 4000000 points can stand for", "length_unit"}));
    auto off = km;
    off.emplace("scatter", "off");
    EXPECT_EQ(loadCloud(sceneOf(kCube, off)).cloud.size(), 8u);
}

/// Meshes that programs write although they should not.
TEST_F(SceneMesh, BadMeshesAreTouchedWithTheForceOfGoodOnes)
{
    const std::string header  = "v -40 -40 -40\nv 40 -40 -40\nv 40 40 -40\nv -40 40 -40\nv -40 -40 40\nv 40 -40 40\n"
                                "v 40 40 40\nv -40 40 40\n";
    const std::string cube    = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    const std::string flipped = "f 1 4 3 2\nf 5 6 7\nf 8 7 5\nf 1 5 6 2\nf 2 3 7 6\nf 3 7 8 4\nf 4 1 5 8\n";
    const std::map<std::string, std::string> meshes{
        {"good", header + cube},
        {"half of a side turned round", header + flipped},
        {"every face twice, once turned round",
         header + cube + "f 2 3 4 1\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n"},
        {"without area", header + "v 0 0 40\nv 40 0 40\nv -40 0 40\n" + cube + "f 9 10 11\nf 9 9 10\nf 5 6 5\n"},
        {"three faces at an edge", header + cube + "v 0 -40 90\nf 5 6 9\n"},
        {"another body through it", header + cube + "v 10 10 20\nv 60 10 20\nv 60 60 20\nv 10 60 20\nf 9 10 11 12\n"},
        {"a corner beside the middle of an edge",
         header + "v 0 40 40\n" + cube.substr(0, 10) +
             "f 5 6 9\nf 6 7 9\nf 5 9 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"},
        {"a vertex far away in no face", header + cube + "v 1e6 0 0\n"}};
    const double good = forceOn(meshes.at("good"));

    EXPECT_GT(good, 0.05); // [N]
    for (const auto& [what, text] : meshes) EXPECT_NEAR(forceOn(text) / good, 1, 0.02) << what;
}

/// Points scattered over it face outward; normals of the file, which its program made of the same triangles, too.
TEST_F(SceneMesh, AClosedMeshThatLiesInsideOutIsTurned)
{
    const std::string corners = "v -40 -40 -40\nv 40 -40 -40\nv 40 40 -40\nv -40 40 -40\nv -40 -40 40\nv 40 -40 40\n"
                                "v 40 40 40\nv -40 40 40\n";
    const std::string inward  = "f 2 3 4 1\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n";
    const auto        outward = [](const LoadedCloud& loaded, const char* sentence) {
        EXPECT_EQ(loaded.normals.size(), loaded.cloud.size());
        for (std::size_t i = 0; i < loaded.normals.size(); ++i)
            ASSERT_GT(glm::dot(glm::dvec3(loaded.normals[i]), loaded.cloud.positions()[i]), 0);
        EXPECT_TRUE(std::ranges::any_of(loaded.report.warnings, [&](const std::string& said) {
            return said.find(sentence) != std::string::npos;
        })) << sentence;
    };
    outward(loadCloud(sceneOf(
                "", {{"cloud", folder_.write("inward.obj", corners + inward).string()}, {"length_unit", "mm"}})),
            "lay inside out");

    std::string ply = kCube;
    ply.replace(ply.find("property float stiffness"), 24,
                "property float stiffness\nproperty float nx\nproperty float ny\nproperty float nz");
    const auto swap = [&ply](const std::string& from, const std::string& to) {
        ply.replace(ply.find(from), from.size(), to);
    };
    for (int k = 0; k < 8; ++k) { // each corner's line, in the order of the file
        static constexpr const char* kLines[] = {"-40 -40 -40 1e5\n", "40 -40 -40 1e6\n", "40 40 -40 1e6\n",
                                                 "-40 40 -40 1e5\n",  "-40 -40 40 1e5\n", "40 -40 40 1e6\n",
                                                 "40 40 40 1e6\n",    "-40 40 40 1e5\n"};
        const std::string            line     = "\n" + std::string(kLines[k]);
        std::string                  inwards;
        for (const char* sign :
             {k == 0 || k == 3 || k == 4 || k == 7 ? " 1" : " -1", k % 4 < 2 ? " 1" : " -1", k < 4 ? " 1" : " -1"})
            inwards += sign;
        swap(line, line.substr(0, line.size() - 1) + inwards + "\n");
    }
    for (const char* face : {"4 0 3 2 1", "4 4 5 6 7", "4 0 1 5 4", "4 1 2 6 5", "4 2 3 7 6", "4 3 0 4 7"}) {
        std::string turned = face;
        std::swap(turned[4], turned[8]);
        swap(face, turned);
    }
    outward(loadCloud(sceneOf(ply, {{"scatter", "off"}})), "8 of the file's normals pointed into closed surfaces");
}

/// Where one triangle is flipped, what lies beyond its edge is no other side: a stiff corner there is felt.
TEST_F(SceneMesh, AFlippedTriangleHidesNoStiffness)
{
    const auto felt = [&](const char* second) {
        const Scene scene = sceneOf(std::string("ply\nformat ascii 1.0\ncomment length_unit mm\nelement vertex 4\n"
                                                "property float x\nproperty float y\nproperty float z\n"
                                                "property float stiffness\nelement face 2\n"
                                                "property list uchar int vertex_indices\nend_header\n"
                                                "-30 -30 0 3e5\n30 -30 0 3e5\n30 30 0 9e6\n-30 30 0 3e5\n3 0 1 3\n") +
                                    second);
        const LoadedObject loaded = loadObject(scene);
        const bool         said   = std::ranges::any_of(loaded.report.warnings, [](const std::string& sentence) {
            return sentence.find("1 of 2 triangles faced against") != std::string::npos;
        });
        PlateSolver        solver("host");
        return std::pair(deform(loaded.object, Contact{{0, 0, 0}, {0, 0, 1}}, scene.patch, solver).compliance, said);
    };
    const auto [good, saidOfGood] = felt("3 1 2 3\n");
    const auto [flipped, said]    = felt("3 1 3 2\n");

    EXPECT_FALSE(saidOfGood);
    EXPECT_TRUE(said);
    EXPECT_EQ(flipped, good) << "the triangle is turned back before points are scattered over it";
}

TEST_F(SceneMesh, AMeshThatIsNoSurfaceIsRefused)
{
    const char* const nanometres = "v 0 0 0\nv 1e-9 0 0\nv 0 1e-9 0\nf 1 2 3\n";
    const Scene       scene      = sceneOf("", {{"cloud", folder_.write("tiny.obj", nanometres).string()}});
    const SoftObject  object     = loadObject(scene).object;
    PlateSolver       solver("host");

    EXPECT_TRUE(holds(refusalOf([&] {
                          static_cast<void>(deform(object, Contact{{0, 0, 0}, {0, 0, 1}}, scene.patch, solver));
                      }),
                      {"fewer than seven points"}));
}

TEST_F(SceneMesh, PointsBesideAFewFacesAreACloud)
{
    std::string text = gridPly(40, 5e-3, false);
    const auto  cut  = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    cut("element face 1600", "element face 1");
    text.erase(text.find('\n', text.find("\n4 ") + 1) + 1);

    EXPECT_EQ(loadCloud(sceneOf(text)).report.scatteredPoints, 0u) << "1677 of 1681 lie in no face";
}

TEST_F(SceneMesh, PointsInNoFaceThatVanishAreCounted)
{
    std::string text = gridPly(20, 5e-3, false);
    text.replace(text.find("element vertex 441"), 18, "element vertex 443");
    const std::size_t faces = text.find("\n4 ") + 1;
    text.insert(faces, "0 0 0.05\n0 0 0.06\n");
    const LoadedCloud loaded = loadCloud(sceneOf(text));
    EXPECT_GT(loaded.report.scatteredPoints, 0u);
    EXPECT_TRUE(std::ranges::any_of(loaded.report.warnings, [](const std::string& warning) {
        return warning.find("2 points lie in no face and cannot be felt") != warning.npos;
    }));
}

TEST_F(SceneMesh, AScanAsDenseAsTheFingertipNeedsStaysTheSameToTheBit)
{
    const std::string text = gridPly(40, 0.9e-3, false);
    const LoadedCloud kept = loadCloud(sceneOf(text)), off = loadCloud(sceneOf(text, {{"scatter", "off"}}));

    EXPECT_EQ(kept.report.scatteredPoints, 0u);
    EXPECT_EQ(kept.faces, off.faces);
    EXPECT_EQ(fingerprint(kept.cloud), fingerprint(off.cloud));
    EXPECT_FALSE(scatterPlan(sceneOf(text), kept));
}

TEST_F(SceneMesh, ItIsScatteredIfTheFingertipIsSmallerOrAnEdgeMuchLonger)
{
    const auto scattered = [&](const Scene& scene) { return loadCloud(scene).report.scatteredPoints > 0; };
    EXPECT_TRUE(scattered(sceneOf(gridPly(40, 0.9e-3, false), {{"footprint_radius", "3mm"}})));
    EXPECT_TRUE(scattered(sceneOf(gridPly(40, 0.9e-3, true))));
    EXPECT_TRUE(scattered(sceneOf(gridPly(40, 0.9e-3, false), {{"scatter", "on"}})));
}

TEST_F(SceneMesh, ADistanceIsTakenAndComesBackFromARecording)
{
    const Scene scene = sceneOf(kCube, {{"scatter", "3 mm"}});
    EXPECT_EQ(loadCloud(scene).report.scatterDistance, 3e-3);
    for (const char* said : {"auto", "on", "off", "0.002"}) {
        const Scene before = sceneOf(kCube, {{"scatter", said}});
        const Scene after  = parseScene(sceneJson(before), "again", ".");
        EXPECT_EQ(after.scatter, before.scatter) << said;
        EXPECT_EQ(after.scatterDistance, before.scatterDistance) << said;
    }
    for (const char* wrong : {"always", "0", "-1mm", "2 m", "nan", "inf"})
        EXPECT_TRUE(holds(refusalOf([&] {
                              static_cast<void>(sceneOf(kCube, {{"scatter", wrong}}));
                          }),
                          {"--scatter"}))
            << wrong;
}

TEST_F(SceneMesh, PointsWithoutFacesCannotBeScattered)
{
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
    const Scene       scene  = parseScene(
               "{}", "a test", ".", {.flags = {{"cloud", folder_.write("points.xyz", points).string()}, {"scatter", "on"}}});
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(loadCloud(scene)); }),
                      {"--scatter: expected a cloud with faces", "points.xyz"}));
}

TEST_F(SceneMesh, TheLawCountsFromTheCornersOfTheFile)
{
    const LoadedCloud loaded = loadCloud(sceneOf(kCube, {{"stiffness", "linear:from=1e5,to=9e5,axis=x"}}));
    for (std::size_t n = 0; n < loaded.cloud.size(); ++n) {
        const double x = loaded.cloud.positions()[n].x;
        ASSERT_NEAR(loaded.cloud.stiffness()[n], 1e5 + 8e5 * (x + 40e-3) / 80e-3, 1);
    }
}

TEST_F(SceneMesh, TheFingertipDecidesTheCloudOfAMeshOnly)
{
    const auto at = [&](const char* radius, const char* scatter) {
        return sceneOf(kCube, {{"footprint_radius", radius}, {"scatter", scatter}});
    };
    EXPECT_FALSE(haveSameCloud(at("4mm", "auto"), at("5mm", "auto")));
    EXPECT_TRUE(haveSameCloud(at("4mm", "off"), at("5mm", "off")));
    EXPECT_TRUE(haveSameCloud(at("4mm", "1mm"), at("5mm", "1mm")));
    const auto sample = [](const char* radius) {
        return parseScene(R"({"cloud": "sample:skin"})", "a test", ".", {.flags = {{"footprint_radius", radius}}});
    };
    EXPECT_TRUE(haveSameCloud(sample("4mm"), sample("3mm")));
}

TEST_F(SceneMesh, WhatConvertsAFileKeepsItsPointsUnlessAskedToScatter)
{
    EXPECT_EQ(loadCloud(withPointsOfFile(sceneOf(kCube))).cloud.size(), 8u);
    EXPECT_GT(loadCloud(withPointsOfFile(sceneOf(kCube, {{"scatter", "auto"}}))).cloud.size(), 8u);
}

} // namespace
} // namespace palp
