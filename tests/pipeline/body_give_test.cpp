#include "engine/pipeline/detail/body_give.h"

#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kMembrane = 1e-3; ///< 1/(E h) of 1 MPa and 1 mm [m/N]

/// A sphere of R 100 mm about the origin, as far down as z, of 1 mm and nu 0.45.
SoftObject sphere(double lowest)
{
    std::mt19937                     random(1);
    std::normal_distribution<double> along;
    std::vector<glm::dvec3>          points;
    while (points.size() < 4000)
        if (const glm::dvec3 p = 0.1 * glm::normalize(glm::dvec3(along(random), along(random), along(random)));
            p.z > lowest)
            points.push_back(p);
    return SoftObject(PointCloud(std::move(points), std::vector<double>(4000, 1e6), StiffnessKind::modulus),
                      {.thickness = 1e-3, .poissonRatio = 0.45});
}

Patch touched(double most, double least)
{
    Patch patch;
    patch.plate.grid  = {2, 2, 1e-3, 1e-3};
    patch.plate.edges = {Edge::supported, Edge::supported, Edge::supported, Edge::supported};
    patch.curvature.emplace();
    patch.curvature->x       = NodeField(patch.plate.grid, most);
    patch.curvature->z       = NodeField(patch.plate.grid, least);
    patch.curvature->xz      = NodeField(patch.plate.grid);
    patch.principal          = {most, least};
    patch.membraneCompliance = NodeField(patch.plate.grid, kMembrane);
    patch.chart.frame.normal = {0, 0, 1};
    return patch;
}

TEST(BodyGive, IsMembraneTheorysOfASphereHeldBelowItsWidest)
{
    const SoftObject closed = sphere(-1);
    // l = sqrt(R h) / (12 (1 - nu^2))^(1/4) = 4.02 mm, rho^4 = (0.95 l)^4 + (0.43 a)^4.
    const PatchSettings settings{.footprintRadius = 4e-3};
    const double        rho = std::pow(std::pow(0.95 * 4.0206e-3, 4) + std::pow(0.43 * 4e-3, 4), 0.25);
    // 102 degrees: ln tan(51 degrees) + 0.2 / 0.96 = 0.411.
    EXPECT_NEAR(bodyCompliance(touched(20, 20), closed, settings) /
                    (1.45 / (2 * std::numbers::pi) * kMembrane * (std::log(0.1 / rho) - 1 + 0.411)),
                1, 1e-3);
    EXPECT_EQ(bodyCompliance(touched(20, -20), closed, settings), 0) << "a saddle";
    EXPECT_EQ(bodyCompliance(touched(20, 20), sphere(0.08), settings), 0) << "a cap of 37 degrees is held at its rim";
    EXPECT_EQ(bodyCompliance(touched(-3e-20, -6e-21), closed, settings), 0) << "a face as flat as numbers are";
    EXPECT_EQ(bodyCompliance(touched(2, 2), closed, settings), 0) << "flat beside the body";
    EXPECT_GT(bodyCompliance(touched(-20, -20), closed, settings), 0) << "pressed from within";
}

/// The wall of a cut rim turns farther than what it is cut from; it is a small share of the points.
TEST(BodyGive, IsNothingForACapWhoseRimHasAWall)
{
    const SoftObject        cap = sphere(0.08); // 37 degrees
    std::vector<glm::dvec3> points(cap.positions().begin(), cap.positions().end());
    for (int n = 0; n < 400; ++n) { // a tenth, 6 mm high, straight down from the rim
        const double along = n * 0.6180339887 * 2 * std::numbers::pi;
        points.emplace_back(0.06 * std::cos(along), 0.06 * std::sin(along), 0.08 - 6e-3 * n / 400);
    }
    const std::size_t count = points.size();
    const SoftObject  walled(PointCloud(std::move(points), std::vector<double>(count, 1e6), StiffnessKind::modulus),
                             {.thickness = 1e-3, .poissonRatio = 0.45});
    EXPECT_EQ(bodyCompliance(touched(10, 10), cap, {.footprintRadius = 4e-3}), 0);
    EXPECT_EQ(bodyCompliance(touched(10, 10), walled, {.footprintRadius = 4e-3}), 0);
}

/// What a hand that slides from a bulge to a tube is told may not step.
TEST(BodyGive, ChangesWithoutAStep)
{
    const PatchSettings settings{.footprintRadius = 4e-3};
    const SoftObject    closed = sphere(-1);
    const double        whole  = bodyCompliance(touched(20, 20), closed, settings);
    double              last   = 0;
    for (double least = 0; least <= 20; least += 0.05) {
        const double now = bodyCompliance(touched(20, least), closed, settings);
        EXPECT_LT(std::abs(now - last), 0.05 * whole) << least;
        last = now;
    }
    EXPECT_NEAR(last, whole, 1e-3 * whole);
}

TEST(BodyGive, IsFeltWhereAWindowIsCutFromTheBodyAlone)
{
    Patch patch          = touched(20, 20);
    patch.bodyCompliance = 1;
    EXPECT_EQ(bodyFelt(patch), 1);
    for (const Edge edge : {Edge::clamped, Edge::free, Edge::guided}) {
        patch.plate.edges.z1 = edge;
        EXPECT_EQ(bodyFelt(patch), 0);
    }
}

TEST(BodyGive, AddsToEachFootprintOfATable)
{
    ComplianceTable table;
    table.side = 3;
    for (int n = 0; n < 9; ++n) table.compliance[std::size_t(n)] = {std::log(0.01 * (n + 1)), 10, -20};
    ComplianceTable more = table;
    addToCompliances(more, 0.05);
    for (std::size_t n = 0; n < 9; ++n) {
        const double own = 0.01 * double(n + 1);
        EXPECT_NEAR(std::exp(more.compliance[n].value), own + 0.05, 1e-12);
        EXPECT_NEAR(more.compliance[n].slopeX, 10 * own / (own + 0.05), 1e-12) << "d ln c = dc / c";
        EXPECT_NEAR(more.compliance[n].slopeZ, -20 * own / (own + 0.05), 1e-12);
    }
}

} // namespace
} // namespace palp
