#include "engine/cloud/face_orientation.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/cloud/meshes.h"

namespace palp {
namespace {

/// A ball of triangles that share their corners, seen from outside.
test::Mesh ball(int rings, double radius, const glm::dvec3& middle)
{
    test::Mesh mesh;
    const int  around = 2 * rings;
    for (int i = 1; i < rings; ++i)
        for (int j = 0; j < around; ++j) {
            const double latitude = std::numbers::pi * i / rings, longitude = 2 * std::numbers::pi * j / around;
            mesh.vertices.push_back(middle + radius * glm::dvec3(std::sin(latitude) * std::cos(longitude),
                                                                 std::sin(latitude) * std::sin(longitude),
                                                                 std::cos(latitude)));
        }
    const auto at  = [&](int i, int j) { return std::uint32_t((i - 1) * around + j % around); };
    const auto top = std::uint32_t(mesh.vertices.size()), bottom = top + 1;
    mesh.vertices.push_back(middle + glm::dvec3(0, 0, radius));
    mesh.vertices.push_back(middle - glm::dvec3(0, 0, radius));
    for (int j = 0; j < around; ++j) {
        mesh.faces.push_back({top, at(1, j), at(1, j + 1)});
        mesh.faces.push_back({bottom, at(rings - 1, j + 1), at(rings - 1, j)});
        for (int i = 1; i + 1 < rings; ++i) {
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

/// Turns a share of the triangles round; returns how many.
std::size_t flip(std::vector<Triangle>& faces, double share, unsigned seed)
{
    std::mt19937                     random(seed);
    std::uniform_real_distribution<> uniform;
    std::size_t                      count = 0;
    for (Triangle& face : faces)
        if (uniform(random) < share) {
            std::swap(face[1], face[2]);
            ++count;
        }
    return count;
}

std::size_t facingInward(const test::Mesh& mesh, std::span<const Triangle> faces, const glm::dvec3& middle)
{
    return std::size_t(std::ranges::count_if(faces, [&](const Triangle& face) {
        const glm::dvec3 a = mesh.vertices[face[0]], b = mesh.vertices[face[1]], c = mesh.vertices[face[2]];
        return glm::dot(glm::cross(b - a, c - a), (a + b + c) / 3.0 - middle) < 0;
    }));
}

TEST(FaceOrientation, AMeshWithoutFlippedTrianglesKeepsItsBits)
{
    for (test::Mesh mesh : {ball(12, 1, {}), test::cube(1), test::sharedCube(1)}) {
        const auto before = mesh.faces;
        EXPECT_EQ(turnToNeighbours(mesh.faces, mesh.vertices), 0u);
        EXPECT_EQ(mesh.faces, before);
    }
}

TEST(FaceOrientation, FlippedTrianglesAreTurnedBackAndNoOthers)
{
    for (const double share : {0.02, 0.2, 0.4}) {
        test::Mesh        mesh    = ball(12, 1, {5, 0, 0});
        const std::size_t flipped = flip(mesh.faces, share, 7);
        ASSERT_EQ(facingInward(mesh, mesh.faces, {5, 0, 0}), flipped);
        EXPECT_EQ(turnToNeighbours(mesh.faces, mesh.vertices), flipped) << share;
        EXPECT_EQ(facingInward(mesh, mesh.faces, {5, 0, 0}), 0u) << share;
    }
}

/// What lies inside out on purpose, such as the wall of a cavity, stays so.
TEST(FaceOrientation, EachPieceIsSettledByItself)
{
    test::Mesh        mesh  = ball(8, 2, {});
    const test::Mesh  inner = ball(8, 1, {});
    const std::size_t half  = mesh.faces.size();
    const auto        shift = std::uint32_t(mesh.vertices.size());
    for (const Triangle& face : inner.faces) mesh.faces.push_back({face[0] + shift, face[2] + shift, face[1] + shift});
    mesh.vertices.insert(mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
    const std::size_t flipped = flip(mesh.faces, 0.1, 3);

    EXPECT_EQ(turnToNeighbours(mesh.faces, mesh.vertices), flipped);
    EXPECT_EQ(facingInward(mesh, std::span(mesh.faces).first(half), {}), 0u);
    EXPECT_EQ(facingInward(mesh, std::span(mesh.faces).subspan(half), {}), half);
}

TEST(FaceOrientation, TheSmallerAreaIsTurnedAndOfEqualOnesNotTheFirst)
{
    // Two triangles that face away from each other; the second is larger, then as large.
    std::vector<glm::dvec3> places{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {3, 3, 0}};
    std::vector<Triangle>   faces{{0, 1, 2}, {2, 1, 3}};
    std::swap(faces[1][1], faces[1][2]);
    std::vector<Triangle> even = faces;
    EXPECT_EQ(turnToNeighbours(faces, places), 1u);
    EXPECT_EQ(faces[0], (Triangle{0, 2, 1}));
    places[3] = {1, 1, 0};
    EXPECT_EQ(turnToNeighbours(even, places), 1u);
    EXPECT_EQ(even[0], (Triangle{0, 1, 2}));
}

TEST(FaceOrientation, ThreeFacesAtAnEdgeAndOneSidedStripsDoNoHarm)
{
    // Three leaves about an edge: none is another's neighbour.
    const std::vector<glm::dvec3> leaves{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
    std::vector<Triangle>         book{{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
    EXPECT_EQ(turnToNeighbours(book, leaves), 0u);

    // A strip of eight triangles whose ends are joined with a half turn.
    constexpr std::uint32_t kAround = 8;
    std::vector<glm::dvec3> places;
    std::vector<Triangle>   strip;
    for (std::uint32_t k = 0; k < kAround; ++k) {
        places.push_back({std::cos(0.7 * k), std::sin(0.7 * k), 0.1 * k});
        strip.push_back({k, (k + 1) % kAround, (k + 2) % kAround});
    }
    EXPECT_LE(turnToNeighbours(strip, places), strip.size() / 2);
}

TEST(FaceOrientation, AClosedBodyThatLiesInsideOutIsTurnedWhole)
{
    const auto inverted = [](std::vector<Triangle> faces) {
        for (Triangle& face : faces) std::swap(face[1], face[2]);
        return faces;
    };
    // Far from the origin, whose side of each triangle says nothing then; a plate a thousandth of its width thin.
    test::Mesh plate = test::sharedCube(1);
    for (glm::dvec3& p : plate.vertices) p = p * glm::dvec3(1, 1, 0.001) + glm::dvec3(500, -300, 200);
    for (const test::Mesh& mesh : {ball(12, 1, {1e3, 0, 0}), plate}) {
        std::vector<Triangle> faces = inverted(mesh.faces);
        EXPECT_EQ(turnOutward(faces, mesh.vertices).faces, faces.size());
        EXPECT_EQ(faces, mesh.faces);
        EXPECT_EQ(turnOutward(faces, mesh.vertices).faces, 0u) << "it lies right now";
        EXPECT_EQ(faces, mesh.faces);
    }
}

/// A shell of two balls: the wall of its cavity faces into the cavity, also where the file has both the wrong way.
TEST(FaceOrientation, TheWallOfACavityIsTurnedWithItsBodyOnly)
{
    test::Mesh       mesh  = ball(8, 2, {});
    const test::Mesh inner = ball(8, 1, {});
    const auto       shift = std::uint32_t(mesh.vertices.size());
    for (const Triangle& face : inner.faces) mesh.faces.push_back({face[0] + shift, face[2] + shift, face[1] + shift});
    mesh.vertices.insert(mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
    std::vector<Triangle> faces = mesh.faces;
    EXPECT_EQ(turnOutward(faces, mesh.vertices).faces, 0u);
    for (Triangle& face : faces) std::swap(face[1], face[2]);
    EXPECT_EQ(turnOutward(faces, mesh.vertices).faces, faces.size());
    EXPECT_EQ(faces, mesh.faces);
}

/// Each body has a side of its own, whatever others in the file do; an open scrap among them keeps its bits.
TEST(FaceOrientation, BodiesAreTurnedEachByItself)
{
    const test::Mesh large = ball(10, 3, {}), small = ball(6, 1, {10, 0, 0}), scrap = test::square(1);
    for (const bool largeIsWrong : {true, false}) {
        test::Mesh            all = large;
        std::vector<Triangle> wrong;
        const auto            add = [&](const test::Mesh& mesh, bool turned) {
            const auto shift = std::uint32_t(wrong.empty() ? 0 : all.vertices.size());
            if (!wrong.empty()) all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
            for (const auto& [a, b, c] : mesh.faces) {
                const Triangle right{a + shift, b + shift, c + shift};
                if (!wrong.empty() && shift > 0) all.faces.push_back(right);
                wrong.push_back(turned ? Triangle{right[0], right[2], right[1]} : right);
            }
        };
        add(large, largeIsWrong);
        add(small, !largeIsWrong);
        add(scrap, false);
        EXPECT_EQ(turnOutward(wrong, all.vertices).faces, (largeIsWrong ? large : small).faces.size());
        EXPECT_EQ(wrong, all.faces);
    }
}

TEST(FaceOrientation, NormalsThatPointIntoAClosedSurfaceAreTurnedAlsoWhereItsFacesLieRight)
{
    const test::Mesh       mesh  = ball(8, 2, {});
    std::vector<Triangle>  faces = mesh.faces;
    std::vector<glm::vec3> normals;
    for (const glm::dvec3& p : mesh.vertices) normals.push_back(-glm::normalize(glm::vec3(p)));
    normals[3]                 = {}; // unknown
    const TurnedOutward turned = turnOutward(faces, mesh.vertices, normals);
    EXPECT_EQ(turned.faces, 0u);
    EXPECT_EQ(turned.normals, mesh.vertices.size());
    EXPECT_EQ(faces, mesh.faces);
    for (std::size_t n = 0; n < normals.size(); ++n)
        EXPECT_EQ(glm::dot(normals[n], glm::vec3(mesh.vertices[n])) > 0, n != 3);
    EXPECT_EQ(turnOutward(faces, mesh.vertices, normals).normals, 0u);
}

/// A dome, a ball that lacks one triangle, and a leaf of two sides that encloses nothing: which side is out, nobody
/// says.
TEST(FaceOrientation, WhatIsOpenOrEnclosesNothingKeepsItsBits)
{
    const test::Mesh      mesh  = ball(12, 1, {});
    std::vector<Triangle> faces = mesh.faces;
    for (Triangle& face : faces) std::swap(face[1], face[2]);
    faces.pop_back();
    const auto before = faces;
    EXPECT_EQ(turnOutward(faces, mesh.vertices).faces, 0u);
    EXPECT_EQ(faces, before);

    const std::vector<glm::dvec3> corners{{0.1, 0.2, 0.3}, {1.7, 0.3, 0.1}, {0.2, 1.9, 0.7}};
    std::vector<Triangle>         leaf{{0, 1, 2}, {0, 2, 1}};
    EXPECT_EQ(turnOutward(leaf, corners).faces, 0u);
}

TEST(FaceOrientation, NoFacesAreNone)
{
    std::vector<Triangle> none;
    EXPECT_EQ(turnToNeighbours(none, {}), 0u);
    EXPECT_EQ(turnOutward(none, {}).faces, 0u);
}

} // namespace
} // namespace palp
