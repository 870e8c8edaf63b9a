#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/session/scene.h"
#include "tests/support/temporary_folder.h"

// Stiffness from a volume, at the points of a cloud and through the sheet below them.

namespace palp {
namespace {

constexpr double kGrowth = 230.0; // of ln E along z [1/m]: a factor of 10 in a centimetre

/// E = 1e5 exp(kGrowth z) over a cube of 81 mm about the origin, by two values along each axis.
std::string volumeBytes()
{
    std::string header = "{'descr': '<f8', 'fortran_order': True, 'shape': (2, 2, 2), }";
    header.resize(117, ' ');
    std::string bytes = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n";
    for (const double z : {-40.5e-3, 40.5e-3})
        for (int n = 0; n < 4; ++n) {
            const double value = 1e5 * std::exp(kGrowth * z);
            bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
        }
    return bytes;
}

const char* const kCube = "v -40 -40 -40\nv 40 -40 -40\nv 40 40 -40\nv -40 40 -40\nv -40 -40 40\nv 40 -40 40\n"
                          "v 40 40 40\nv -40 40 40\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

class SceneVolume : public testing::Test {
protected:
    Scene sceneOf(const std::string& along, std::map<std::string, std::string, std::less<>> flags = {}) const
    {
        static_cast<void>(folder_.write("e.npy", volumeBytes()));
        flags.try_emplace("cloud", folder_.write("cube.obj", kCube).string());
        flags.try_emplace("length_unit", "mm");
        flags.try_emplace("footprint_radius", "8mm");
        flags.try_emplace("thickness", "4mm");
        flags.try_emplace("stiffness", "grid:file=" + (folder_ / "e.npy").string() +
                                           ",origin=-0.0405;-0.0405;-0.0405,spacing=0.081" + along);
        return parseScene("{}", "a test", ".", {.flags = std::move(flags)});
    }

    TemporaryFolder folder_;
};

/// The modulus that bends as e^(a t) over [0, 1] does.
double closedForm(double a)
{
    const double e = std::exp(a), m0 = (e - 1) / a, m1 = (e - m0) / a, m2 = (e - 2 * m1) / a;
    return 12 * (m2 - m1 * m1 / m0);
}

/// Points on the faces, away from the edges, where the normal is that of a face.
std::vector<std::size_t> onFaces(const LoadedCloud& loaded)
{
    std::vector<std::size_t> points;
    for (std::size_t n = 0; n < loaded.cloud.size(); ++n) {
        int far = 0;
        for (int k = 0; k < 3; ++k) far += std::abs(loaded.cloud.positions()[n][k]) < 30e-3;
        if (far == 2) points.push_back(n);
    }
    return points;
}

TEST_F(SceneVolume, ThePointsHaveTheVolumesValues)
{
    for (const char* along : {"", ",along=points"}) {
        const LoadedCloud loaded = loadCloud(sceneOf(along));

        ASSERT_GT(loaded.cloud.size(), 1000u);
        for (std::size_t n = 0; n < loaded.cloud.size(); ++n)
            ASSERT_NEAR(loaded.cloud.stiffness()[n] / (1e5 * std::exp(kGrowth * loaded.cloud.positions()[n].z)), 1,
                        1e-6)
                << "nodes are floats";
    }
}

TEST_F(SceneVolume, ThroughTheThicknessTheSheetLiesBelowEachFace)
{
    const LoadedCloud loaded = loadCloud(sceneOf(",along=thickness"));
    const double      sheet  = closedForm(kGrowth * 4e-3);

    int tops = 0, bottoms = 0, sides = 0;
    for (const std::size_t n : onFaces(loaded)) {
        const glm::dvec3 p   = loaded.cloud.positions()[n];
        const bool       top = p.z > 39e-3, bottom = p.z < -39e-3;
        const double     deepest  = top ? p.z - 4e-3 : p.z; // where the sheet is softest
        const double     expected = 1e5 * std::exp(kGrowth * deepest) * (top || bottom ? sheet : 1);
        // Sixteen layers are right to 1e-3; on the sides a normal that is off by a hundredth is worth 4 mm / 100, 1 %.
        ASSERT_NEAR(loaded.cloud.stiffness()[n] / expected, 1, 0.01) << p.x << " " << p.y << " " << p.z;
        ++(top ? tops : bottom ? bottoms : sides);
    }
    EXPECT_GT(tops, 100);
    EXPECT_GT(bottoms, 100);
    EXPECT_GT(sides, 400);
    EXPECT_GT(sheet, 1.5) << "it is another value than that of the points";
}

TEST_F(SceneVolume, TheThicknessDecidesTheCloudOnlyIfTheLawLooksThroughIt)
{
    EXPECT_TRUE(haveSameCloud(sceneOf(""), sceneOf("", {{"thickness", "3mm"}})));
    EXPECT_FALSE(haveSameCloud(sceneOf(",along=thickness"), sceneOf(",along=thickness", {{"thickness", "3mm"}})));
    EXPECT_TRUE(haveSameCloud(sceneOf(",along=thickness"), sceneOf(",along=thickness")));
}

TEST_F(SceneVolume, ARigidityIsOfAWholeSheetAlready)
{
    const Scene scene = sceneOf(
        ",along=thickness", {{"cloud", folder_.write("points.csv", "x,y,z,D\n0,0,0,1\n1,0,0,1\n0,1,0,1\n").string()},
                             {"stiffness_unit", "N_m"}});

    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(loadCloud(scene)); }), {"along", "stiffness_unit N_m"}));
}

TEST_F(SceneVolume, PointsOutsideAreRefusedOrHaveTheValueThatIsNamed)
{
    const std::string small = "grid:file=" + (folder_ / "e.npy").string() + ",origin=-0.0405;-0.0405;0,spacing=0.081";
    static_cast<void>(sceneOf("")); // writes the file
    for (const char* along : {"", ",along=thickness"}) {
        EXPECT_TRUE(holds(refusalOf([&] {
                              static_cast<void>(loadCloud(sceneOf("", {{"stiffness", small + along}})));
                          }),
                          {"e.npy: expected a volume that holds point", "\"outside\""}));

        const LoadedCloud loaded = loadCloud(sceneOf("", {{"stiffness", small + along + ",outside=7e3"}}));

        for (const std::size_t n : onFaces(loaded))
            if (loaded.cloud.positions()[n].z < -39e-3) {
                ASSERT_EQ(loaded.cloud.stiffness()[n], 7e3);
            }
    }
}

} // namespace
} // namespace palp
