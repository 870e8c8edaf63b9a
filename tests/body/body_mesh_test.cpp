#include "engine/body/body_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/body/two_faces.h"

namespace palp {
namespace {

constexpr Material kSoft{.thickness = 1e-3, .poissonRatio = 0.3};

/// A square sheet of points in no order.
SoftObject sheet(double half, double spacing, unsigned seed, double holeRadius = 0)
{
    std::mt19937                     random(seed);
    std::uniform_real_distribution<> off(-0.25, 0.25);
    std::vector<glm::dvec3>          points;
    for (double x = -half + spacing / 2; x < half; x += spacing)
        for (double y = -half + spacing / 2; y < half; y += spacing) {
            const glm::dvec3 p(x + off(random) * spacing, y + off(random) * spacing, 0);
            if (glm::length(p) > holeRadius) points.push_back(p);
        }
    std::vector<double> moduli(points.size(), 1e5);
    return SoftObject(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus), kSoft);
}

SoftObject sphere(double radius, std::size_t count)
{
    std::vector<glm::dvec3> points;
    for (std::size_t k = 0; k < count; ++k) {
        const double z = 1 - 2 * (double(k) + 0.5) / double(count), turn = std::numbers::pi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - z * z);
        points.push_back(radius * glm::dvec3(r * std::cos(turn * double(k)), r * std::sin(turn * double(k)), z));
    }
    std::vector<double> moduli(count, 1e5);
    return SoftObject(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus), kSoft);
}

double areaOf(const BodyMesh& mesh)
{
    double sum = 0;
    for (const BodyTriangle& triangle : mesh.triangles) {
        const glm::dvec3 a = mesh.nodes[triangle.nodes[0]].place;
        sum +=
            triangle.share / 2 *
            glm::length(glm::cross(mesh.nodes[triangle.nodes[1]].place - a, mesh.nodes[triangle.nodes[2]].place - a));
    }
    return sum;
}

TEST(BodyMesh, CoversAFlatSheetUpToItsBorder)
{
    const BodyMesh mesh = bodyMesh(sheet(30e-3, 1e-3, 1), 500);
    EXPECT_GT(mesh.nodes.size(), 350U);
    EXPECT_LT(mesh.nodes.size(), 700U) << "about as many as were asked for";
    // Along the border points lie half a spacing within, to a quarter of one: 2 % of the area for half a millimetre.
    EXPECT_NEAR(areaOf(mesh), 60e-3 * 60e-3, 0.02 * 60e-3 * 60e-3);
    for (const BodyTriangle& triangle : mesh.triangles)
        EXPECT_EQ(triangle.share, 1) << "in a plane a triangulation is one, but for nodes on one circle";
}

TEST(BodyMesh, LeavesAHoleOpen)
{
    const BodyMesh mesh = bodyMesh(sheet(30e-3, 1e-3, 2, 10e-3), 700);
    const double   area = 60e-3 * 60e-3 - std::numbers::pi * 10e-3 * 10e-3;
    EXPECT_NEAR(areaOf(mesh), area, 0.02 * area);
    for (const BodyTriangle& triangle : mesh.triangles) {
        glm::dvec3 middle{};
        for (const std::uint32_t node : triangle.nodes) middle += mesh.nodes[node].place / 3.0;
        EXPECT_GT(glm::length(middle), 8.5e-3) << "half of the nodes' spacing within the border";
    }
}

TEST(BodyMesh, ClosesASphere)
{
    const BodyMesh mesh = bodyMesh(sphere(30e-3, 12000), 2000);
    const double   area = 4 * std::numbers::pi * 30e-3 * 30e-3;
    EXPECT_NEAR(areaOf(mesh), area, 0.01 * area) << "chords are shorter by (spacing / R)^2 / 10, 0.1 %";
    for (const BodyNode& node : mesh.nodes) EXPECT_NEAR(glm::length(node.place), 30e-3, 3e-5);
    double whole = 0;
    for (const BodyTriangle& triangle : mesh.triangles) whole += triangle.share == 1;
    EXPECT_GT(whole, 0.95 * double(mesh.triangles.size())) << "neighbours hardly ever disagree";
}

TEST(BodyMesh, NodesKeepTheirDistance)
{
    const BodyMesh mesh = bodyMesh(sheet(30e-3, 1e-3, 3), 500);
    for (std::size_t a = 0; a < mesh.nodes.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) // those of the border were moved by half a spacing or so
            EXPECT_GT(glm::distance(mesh.nodes[a].place, mesh.nodes[b].place), mesh.spacing - 1.5e-3);
}

TEST(BodyMesh, BeginsWhereItIsHeld)
{
    const SoftObject    free = sheet(30e-3, 1e-3, 4);
    std::vector<double> held;
    for (const glm::dvec3& p : free.positions()) held.push_back(p.x < -20e-3);
    const BodyMesh mesh = bodyMesh(free.withHeld(held), 500);
    int            some = 0;
    for (const BodyNode& node : mesh.nodes) {
        EXPECT_GT(node.place.x, -20.8e-3) << "half way between points that are held and those that are not";
        if (!node.held) continue;
        EXPECT_NEAR(node.place.x, -20e-3, 0.8e-3);
        ++some;
    }
    EXPECT_GT(some, 10) << "a line of 60 mm, a node every 4 or less";
    EXPECT_NEAR(areaOf(mesh), 50e-3 * 60e-3, 0.025 * 50e-3 * 60e-3);
}

TEST(BodyMesh, TakesTheMeanRigidityOfThePointsAround)
{
    const SoftObject    plain = sheet(20e-3, 1e-3, 5);
    std::vector<double> moduli;
    for (const glm::dvec3& p : plain.positions()) moduli.push_back(p.x > 0 ? 1e6 : 1e5);
    const SoftObject two  = plain.repainted(std::move(moduli));
    const BodyMesh   mesh = bodyMesh(two, 300);
    for (const BodyNode& node : mesh.nodes) {
        if (std::abs(node.place.x) < mesh.spacing) continue;
        EXPECT_NEAR(node.rigidity / kSoft.rigidity(node.place.x > 0 ? 1e6 : 1e5), 1, 1e-9);
    }
}

TEST(BodyMesh, TakesNoiseOffItsNodes)
{
    const SoftObject                 clean = sheet(30e-3, 1e-3, 6);
    std::mt19937                     random(7);
    std::normal_distribution<double> noise(0, 0.3e-3);
    std::vector<glm::dvec3>          points(clean.positions().begin(), clean.positions().end());
    for (glm::dvec3& p : points) p.z += noise(random);
    std::vector<double> moduli(points.size(), 1e5);
    const SoftObject    noisy(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus), kSoft);
    double              square = 0, count = 0;
    for (const BodyNode& node : bodyMesh(noisy, 500).nodes) {
        square += node.place.z * node.place.z;
        ++count;
    }
    EXPECT_LT(std::sqrt(square / count), 0.6 * 0.3e-3) << "of some 20 points and six unknowns: the root of 6/20";
}

TEST(TwoFaces, AreThoseOfAThinSheetAndNotOfASphere)
{
    EXPECT_FALSE(hasTwoFaces(sheet(30e-3, 1e-3, 8)));
    EXPECT_FALSE(hasTwoFaces(sphere(30e-3, 12000)));
    std::vector<glm::dvec3> both;
    for (const glm::dvec3& p : sheet(20e-3, 0.5e-3, 9).positions()) both.push_back(p);
    for (const glm::dvec3& p : sheet(20e-3, 0.5e-3, 10).positions()) both.push_back(p + glm::dvec3(0, 0, 1e-3));
    std::vector<double> moduli(both.size(), 1e5);
    EXPECT_TRUE(hasTwoFaces(SoftObject(PointCloud(std::move(both), std::move(moduli), StiffnessKind::modulus), kSoft)));
}

} // namespace
} // namespace palp
