#include "engine/cloud/mesh_points.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/cloud/neighbour_index.h"
#include "engine/core/contract.h"
#include "tests/cloud/meshes.h"

namespace palp {
namespace {

using test::areaOf;
using test::ball;
using test::cube;
using test::Mesh;
using test::square;

MeshPoints scattered(const Mesh& mesh, double distance, std::uint64_t seed = 1)
{
    return scatterOver(mesh.vertices, mesh.faces, {distance, seed});
}

/// Returns the least distance between two points [m].
double leastDistance(const MeshPoints& points)
{
    const NeighbourIndex index(points.positions);
    double               least = HUGE_VAL;
    for (const glm::dvec3& p : points.positions)
        least = std::min(least, glm::length(points.positions[index.nearest(p, 2)[1].point] - p));
    return least;
}

/// Returns the largest distance from a place of the mesh to the nearest point [m]; the places are a grid on each
/// triangle with at most `step` between neighbours [m].
double farthestPlace(const Mesh& mesh, const MeshPoints& points, double step)
{
    const NeighbourIndex index(points.positions);
    double               farthest = 0;
    for (const auto& [a, b, c] : mesh.faces) {
        const glm::dvec3 p = mesh.vertices[a], u = mesh.vertices[b] - p, v = mesh.vertices[c] - p;
        const int        n = int(std::max(glm::length(u), glm::length(v)) / step) + 1;
        for (int i = 0; i <= n; ++i)
            for (int j = 0; i + j <= n; ++j) {
                const glm::dvec3 place = p + double(i) / n * u + double(j) / n * v;
                farthest = std::max(farthest, glm::length(points.positions[index.nearest(place, 1)[0].point] - place));
            }
    }
    return farthest;
}

/// Meshes of one sheet, with a distance at which some thousand points fit.
struct Case {
    const char* name;
    Mesh        mesh;
    double      distance; ///< [m]
};
std::vector<Case> cases()
{
    Mesh flipped = square(1);
    std::swap(flipped.faces[1][0], flipped.faces[1][1]);
    Mesh doubled = cube(0.1);
    doubled.faces.insert(doubled.faces.end(), doubled.faces.begin(), doubled.faces.end());
    Mesh crossed = square(1);
    test::addSide(crossed, {0, 0.5, -0.5}, {1, 0, 0}, {0, 0, 1});
    Mesh fin = square(1); // a third triangle at the edge that the two share
    fin.vertices.emplace_back(0.5, 0.5, 1);
    fin.faces.push_back({0, 2, 4});
    return {{"square", square(1), 0.02},
            {"cube of 8 corners", cube(0.04), 0.8e-3},
            {"triangles far smaller than the distance", ball(0.05, 6), 4e-3},
            {"triangles about as large as the distance", ball(0.05, 4), 3e-3},
            {"one triangle turned round", flipped, 0.02},
            {"each triangle twice", doubled, 2e-3},
            {"two squares that intersect", crossed, 0.03},
            {"three triangles at an edge", fin, 0.03}};
}

TEST(MeshPoints, NoTwoAreCloserThanTheDistance)
{
    for (const auto& [name, mesh, distance] : cases()) {
        const MeshPoints points = scattered(mesh, distance);

        EXPECT_EQ(points.distance, distance) << name;
        EXPECT_GT(points.size(), 500u) << name;
        EXPECT_GE(leastDistance(points), distance) << name;
    }
}

TEST(MeshPoints, EveryPlaceOfTheSurfaceHasAPointWithinTheDistance)
{
    for (const auto& [name, mesh, distance] : cases()) {
        const MeshPoints points = scattered(mesh, distance);

        // What is promised: 1 + 1/64. Grid places are a sixth of a disc apart, so a gap of that size is not missed.
        EXPECT_LE(farthestPlace(mesh, points, distance / 6), distance * (1 + 1.0 / 64)) << name;
    }
}

// Discs thrown at random until no more fit cover 0.547 of a plane (Feder 1980, "Random sequential adsorption"), which
// are 0.697 points on distance^2; darts into the gaps that are left in the order of space make a few more. No maximal
// set has fewer than 0.385 or more than 1.155: the hexagonal lattices that just cover and just fit.
TEST(MeshPoints, TheirDensityIsAboutThatOfDiscsThrownAtRandomWhateverTheTriangles)
{
    for (const auto& [mesh, distance] :
         {std::pair{square(1), 0.008}, {cube(0.04), 0.4e-3}, {ball(0.05, 6), 1e-3}, {ball(0.05, 3), 1e-3}}) {
        const double density = double(scattered(mesh, distance).size()) * distance * distance / areaOf(mesh);

        EXPECT_GT(density, 0.70); // what is measured lies between 0.75 and 0.81: triangles as large as a disc hold most
        EXPECT_LT(density, 0.85);
    }
}

TEST(MeshPoints, EachFaceHasItsShareByArea)
{
    Mesh mesh;
    test::addSide(mesh, {0, 0, 0}, {1, 0, 0}, {0, 0.25, 0});
    test::addSide(mesh, {0, 1, 0}, {1, 0, 0}, {0.3, 0.75, 0});
    std::vector<double> shares(mesh.faces.size());
    const MeshPoints    points = scattered(mesh, 5e-3);

    for (const std::uint32_t face : points.triangles) shares[face] += 1.0 / double(points.size());

    // The noise of 4000 points that keep their distance is 0.5 %, and the narrow side has more border, which adds 2 %.
    // A dart for each triangle, whatever its area, would make all shares 0.25.
    for (std::size_t n = 0; n < 4; ++n) {
        const double expected = n < 2 ? 0.125 : 0.375;
        EXPECT_NEAR(shares[n], expected, 0.04 * expected) << n;
    }
}

TEST(MeshPoints, EachLiesWhereItsWeightsSayAndHasTheNormalOfItsTriangle)
{
    const Mesh       mesh   = ball(0.05, 2);
    const MeshPoints points = scattered(mesh, 2e-3);

    for (std::size_t n = 0; n < points.size(); ++n) {
        const auto& [a, b, c] = mesh.faces[points.triangles[n]];
        const glm::dvec2 w    = points.weights[n];
        const glm::dvec3 at   = (1 - w.x - w.y) * mesh.vertices[a] + w.x * mesh.vertices[b] + w.y * mesh.vertices[c];
        ASSERT_LT(glm::length(at - points.positions[n]), 1e-16 * 10); // rounding of sums of 0.05 m
        ASSERT_GE(std::min({w.x, w.y, 1 - w.x - w.y}), -1e-15);
        ASSERT_NEAR(glm::length(points.normals[n]), 1, 1e-15);
        ASSERT_GT(glm::dot(points.normals[n], glm::normalize(at)), 0.98); // outwards; facets tilt by 10 degrees at most
        ASSERT_NEAR(glm::dot(points.normals[n], mesh.vertices[b] - mesh.vertices[a]), 0, 1e-16);
    }
}

TEST(MeshPoints, InterpolationIsExactOfAFieldWhoseLogarithmIsLinear)
{
    const Mesh          mesh   = ball(0.05, 2);
    const MeshPoints    points = scattered(mesh, 2e-3);
    const auto          field  = [](const glm::dvec3& p) { return 1e5 * std::exp(30 * p.x - 50 * p.y + 7 * p.z); };
    std::vector<double> values;
    for (const glm::dvec3& p : mesh.vertices) values.push_back(field(p));

    const std::vector<double> between = logInterpolated(points, mesh.faces, values);

    ASSERT_EQ(between.size(), points.size());
    for (std::size_t n = 0; n < points.size(); ++n)
        EXPECT_NEAR(between[n] / field(points.positions[n]), 1, 1e-13); // rounding of exponents of 5
}

TEST(MeshPoints, AUniformStiffnessStaysTheSameToTheBit)
{
    const Mesh                mesh = cube(0.04);
    const std::vector<double> same(mesh.vertices.size(), 0.3e6);

    for (const double value : logInterpolated(scattered(mesh, 2e-3), mesh.faces, same)) ASSERT_EQ(value, 0.3e6);
}

TEST(MeshPoints, TheSeedDecidesEveryBit)
{
    const Mesh       mesh = ball(0.05, 3);
    const MeshPoints one = scattered(mesh, 1e-3, 7), same = scattered(mesh, 1e-3, 7), other = scattered(mesh, 1e-3, 8);

    EXPECT_EQ(one.positions, same.positions);
    EXPECT_EQ(one.triangles, same.triangles);
    EXPECT_NE(one.positions, other.positions);
    // Of today's program; another number on another machine, or after a change, makes other clouds of old scenes.
    EXPECT_EQ(scattered(square(1), 0.02).size(), 1961u);
}

TEST(MeshPoints, TheSidesOfAThinPlateHoldSetsOfTheirOwn)
{
    const double distance = 0.02;
    Mesh         plate    = square(1);
    test::addSide(plate, {0, 0, -0.3 * distance}, {0, 1, 0}, {1, 0, 0}); // seen from below
    Mesh stack = square(1);
    test::addSide(stack, {0, 0, -0.3 * distance}, {1, 0, 0}, {0, 1, 0}); // both seen from above

    const double one    = double(scattered(square(1), distance).size());
    const double two    = double(scattered(plate, distance).size());
    const double shared = double(scattered(stack, distance).size());

    EXPECT_NEAR(two / one, 2, 0.05); // noise of two thousand points
    EXPECT_LT(shared / one, 1.25);   // a disc takes most of its room from the other sheet
}

TEST(MeshPoints, AFewLongSliversAreNoWorkOfHours)
{
    // 98 slivers that lie one on the other, of 3 kB in a file: 27 s for 5 m of them, and more than in proportion.
    std::vector<Triangle> faces;
    for (std::uint32_t k = 1; k < 99; ++k) faces.push_back({0, k, k + 1});
    const auto sliversOf = [](double length) {
        std::vector<glm::dvec3> vertices{{0, 0, 0}};
        for (int k = 0; k < 99; ++k) vertices.emplace_back(length, 1e-4 * k, 1e-5 * (k % 3));
        return vertices;
    };
    constexpr ScatterSettings kAsked{.distance = 1e-3, .most = 100'000};
    EXPECT_EQ(scatterDistance(sliversOf(0.2), faces, kAsked), 1e-3); // 98 x 200 in a row, a fifth of `most`
    const double longer = scatterDistance(sliversOf(0.3), faces, kAsked);
    EXPECT_GT(longer, 1.1e-3);
    EXPECT_LT(longer, 0.3 / 0.2 * 1e-3) << "no step: as much larger as they are longer";
    EXPECT_NEAR(scatterDistance(sliversOf(0.33), faces, kAsked) / longer, 1.1, 0.01);
    const std::vector<glm::dvec3> far      = sliversOf(100);
    const double                  distance = scatterDistance(far, faces, kAsked);
    ASSERT_LE(98 * 100 / distance, 0.2 * 100'000 * 1.2); // a fifth of `most`, and what their area pays for
    const MeshPoints points = scatterOver(far, faces, kAsked);
    EXPECT_GE(points.distance, distance);
    EXPECT_GT(double(points.size()), 0.5 * 100 / points.distance);
}

TEST(MeshPoints, TrianglesWithoutAnAreaContributeNothingAndAreCounted)
{
    Mesh mesh = square(1);
    mesh.vertices.emplace_back(0.5, 0, 0); // on an edge, so that the next one is a line
    const auto n      = std::uint32_t(mesh.vertices.size() - 1);
    const auto before = scattered(mesh, 0.05);
    mesh.faces.push_back({0, 1, n});
    mesh.faces.push_back({0, 0, 1});
    mesh.faces.push_back({2, 2, 2});

    const auto after = scattered(mesh, 0.05);
    mesh.faces.erase(mesh.faces.begin(), mesh.faces.begin() + 2);
    const auto none = scattered(mesh, 0.05);

    EXPECT_EQ(before.degenerate, 0u);
    EXPECT_EQ(after.degenerate, 3u);
    EXPECT_EQ(after.positions, before.positions);
    EXPECT_EQ(none.size(), 0u);
    EXPECT_EQ(none.degenerate, 3u);
}

TEST(MeshPoints, TheDistanceGrowsWhereThePointsWouldBeTooMany)
{
    const Mesh       mesh   = square(1);
    const MeshPoints points = scatterOver(mesh.vertices, mesh.faces, {.distance = 1e-5, .most = 1000});

    EXPECT_EQ(points.wanted, 1e-5);
    EXPECT_NEAR(points.distance, std::sqrt(1.0 / 1000), 1e-12);
    EXPECT_LE(points.size(), 1000u);
    EXPECT_GE(leastDistance(points), points.distance);
}

TEST(MeshPoints, NeedlesDoNotMakeMorePointsThanAreAllowed)
{
    Mesh mesh; // next to no area, and ten metres of edges
    for (int k = 0; k < 10; ++k) {
        const auto n = std::uint32_t(mesh.vertices.size());
        for (const glm::dvec3& p : {glm::dvec3(0, k, 0), glm::dvec3(1, k, 0), glm::dvec3(0.5, k + 1e-8, 0)})
            mesh.vertices.push_back(p);
        mesh.faces.push_back({n, n + 1, n + 2});
    }

    const MeshPoints points = scatterOver(mesh.vertices, mesh.faces, {.distance = 1e-4, .most = 1000});

    EXPECT_GT(points.distance, 1e-4);
    EXPECT_GT(points.size(), 100u);
    EXPECT_LE(points.size(), 1000u);
    EXPECT_LE(farthestPlace(mesh, points, points.distance / 5), points.distance * (1 + 1.0 / 64));
}

TEST(MeshPoints, AMeshFarFromTheOriginIsFilledLikeOneAtIt)
{
    Mesh mesh = cube(0.04);
    for (glm::dvec3& p : mesh.vertices) p += glm::dvec3(4.5e5, 5.4e6, 300); // of a survey; their grain is 1e-9 m

    const MeshPoints points = scattered(mesh, 2e-3);

    EXPECT_GE(leastDistance(points), 2e-3);
    EXPECT_LE(farthestPlace(mesh, points, 2e-4), 2e-3 * (1 + 1.0 / 64));
}

TEST(MeshPoints, RefusesWhatIsNoMesh)
{
    const Mesh mesh = square(1);
    const auto with = [&](const Triangle& face, double x) {
        Mesh other = mesh;
        other.faces.push_back(face);
        other.vertices[1].x = x;
        return other;
    };

    EXPECT_THROW(static_cast<void>(scattered(with({0, 1, 4}, 1), 0.1)), ContractViolation);
    EXPECT_THROW(static_cast<void>(scattered(with({0, 1, 2}, NAN), 0.1)), ContractViolation);
    EXPECT_THROW(static_cast<void>(scattered(with({0, 1, 2}, INFINITY), 0.1)), ContractViolation);
    EXPECT_THROW(static_cast<void>(scattered(mesh, 0)), ContractViolation);
    EXPECT_THROW(static_cast<void>(scattered(mesh, NAN)), ContractViolation);
}

} // namespace
} // namespace palp
