#include "engine/tools/render/mesh_refine.h"

#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/cloud/meshes.h"

namespace palp {
namespace {

SurfaceMesh asSurface(const test::Mesh& mesh)
{
    return {mesh.vertices, mesh.faces};
}

SurfaceMesh sharedCube(double edge)
{
    return asSurface(test::sharedCube(edge));
}

double longestOf(const CreasedMesh& mesh)
{
    double longest = 0;
    for (const auto& [a, b, c] : mesh.faces)
        for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}})
            longest = std::max(longest, glm::distance(mesh.positions[from], mesh.positions[to]));
    return longest;
}

double areaOf(const CreasedMesh& mesh)
{
    return test::areaOf({mesh.positions, mesh.faces});
}

TEST(MeshRefine, ACubeKeepsItsEdges)
{
    const CreasedMesh mesh = creased(sharedCube(0.1));

    EXPECT_EQ(mesh.positions.size(), 24U) << "each corner belongs to three sides";
    for (const glm::dvec3& normal : mesh.normals)
        EXPECT_NEAR(std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)}), 1, 1e-12);
    std::set<std::uint32_t> places(mesh.placeOf.begin(), mesh.placeOf.end());
    EXPECT_EQ(places.size(), 8U);
}

TEST(MeshRefine, ABallIsSmoothAndItsNormalsAreItsRadii)
{
    test::Mesh ball = test::ball(0.05, 3);
    std::swap(ball.faces[5][0], ball.faces[5][1]); // turned round, as meshes in the wild have some

    const CreasedMesh mesh = creased(asSurface(ball));

    ASSERT_EQ(mesh.positions.size(), ball.vertices.size()) << "no corner is split";
    for (std::size_t n = 0; n < mesh.positions.size(); ++n)
        EXPECT_GT(std::abs(glm::dot(mesh.normals[n], glm::normalize(mesh.positions[n]))), std::cos(0.02)) << n;
}

TEST(MeshRefine, FacesMeetAtACreaseFromFortyDegreesOn)
{
    for (const double degrees : {30.0, 38.0, 42.0, 60.0}) {
        const double      turn = degrees * std::numbers::pi / 180;
        const SurfaceMesh roof{{{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {std::cos(turn), 0, -std::sin(turn)}},
                               {{0, 1, 2}, {1, 0, 3}}};

        EXPECT_EQ(creased(roof).positions.size(), degrees < 40 ? 4U : 6U) << degrees;
    }
}

TEST(MeshRefine, NoEdgeIsLongerThanAskedAndTheSurfaceIsTheSame)
{
    for (const double longest : {0.2, 0.05, 0.011, 0.003}) {
        const CreasedMesh mesh = refined(creased(sharedCube(0.1)), longest, 1'000'000);

        EXPECT_LE(longestOf(mesh), longest);
        EXPECT_GT(longestOf(mesh), 0.45 * std::min(longest, 0.1 * std::sqrt(2.0))) << "halved once too often";
        EXPECT_NEAR(areaOf(mesh), 0.06, 1e-12);
        for (const glm::dvec3& p : mesh.positions)
            EXPECT_NEAR(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 0.05, 1e-15);
    }
}

TEST(MeshRefine, NoGapOpensBetweenTriangles)
{
    // One side is long, so its neighbours are halved along that edge alone.
    SurfaceMesh cube = sharedCube(0.1);
    for (glm::dvec3& p : cube.vertices) p.x *= 7;

    const CreasedMesh mesh = refined(creased(cube), 0.03, 1'000'000);

    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges; // by place
    std::map<std::uint32_t, glm::dvec3>                    places;
    for (std::size_t n = 0; n < mesh.positions.size(); ++n) {
        const auto [found, isNew] = places.try_emplace(mesh.placeOf[n], mesh.positions[n]);
        EXPECT_EQ(found->second, mesh.positions[n]) << "corner " << n;
        if (n > 0) {
            EXPECT_GE(mesh.placeOf[n], mesh.placeOf[n - 1]);
        }
    }
    for (const auto& [a, b, c] : mesh.faces)
        for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}})
            ++edges[std::minmax(mesh.placeOf[from], mesh.placeOf[to])];
    for (const auto& [edge, triangles] : edges) EXPECT_EQ(triangles, 2) << edge.first << " " << edge.second;
}

TEST(MeshRefine, TrianglesKeepTheirSide)
{
    test::Mesh both = test::square(0.1);
    test::addSide(both, {1, 0, 0}, {0.1, 0, 0}, {0.03, 0.02, 0}); // whose triangles have one long edge, or two

    const CreasedMesh mesh = refined(creased(asSurface(both)), 0.013, 1'000'000);

    for (const auto& [a, b, c] : mesh.faces)
        EXPECT_GT(glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]).z, 0);
}

TEST(MeshRefine, NormalsBetweenCornersAreTheirMeans)
{
    const CreasedMesh mesh = refined(creased(asSurface(test::ball(0.05, 2))), 0.004, 1'000'000);

    for (std::size_t n = 0; n < mesh.positions.size(); ++n)
        EXPECT_GT(std::abs(glm::dot(mesh.normals[n], glm::normalize(mesh.positions[n]))), std::cos(0.06))
            << "a face of this ball is up to 0.16 wide [rad]";
}

TEST(MeshRefine, TrianglesAreBoundedAndTheLongestGoFirst)
{
    test::Mesh both = test::ball(0.05, 3); // 1280 small triangles, which stay as they are
    test::addSide(both, {2, 0, 0}, {1, 0, 0}, {0, 1, 0});

    const CreasedMesh mesh   = refined(creased(asSurface(both)), 0.001, 1500);
    const CreasedMesh asItIs = refined(creased(asSurface(both)), 0.001, 1281);

    EXPECT_LE(mesh.faces.size(), 1500U);
    EXPECT_EQ(mesh.faces.size(), 1280U + 128U) << "twice four, four and four";
    EXPECT_EQ(asItIs.faces.size(), 1282U) << "more than 1281 stay as they are";
}

TEST(MeshRefine, FacesWithoutAnAreaHaveANormalToo)
{
    const SurfaceMesh line{{{0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}}, {{0, 1, 2}}};

    const CreasedMesh mesh = refined(creased(line), 0.3, 100);

    for (const glm::dvec3& normal : mesh.normals) EXPECT_NEAR(glm::length(normal), 1, 1e-12);
}

} // namespace
} // namespace palp
