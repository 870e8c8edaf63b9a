#include "engine/cloud/coarse_object.h"

#include <cmath>
#include <random>
#include <set>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

/// A random sheet of 20 mm with 0.1 mm between points, and perhaps a second one behind it.
SoftObject denseSheet(double gap, double strayAt = 0)
{
    std::mt19937_64                        random(7);
    std::uniform_real_distribution<double> along(0, 20e-3);
    std::vector<glm::dvec3>                points;
    std::vector<double>                    stiffness;
    std::vector<glm::vec3>                 normals;
    for (int n = 0; n < 40'000; ++n) {
        const double x = along(random), y = along(random), behind = gap > 0 ? n % 2 : 0;
        points.emplace_back(x, y, -behind * gap);
        stiffness.push_back(std::exp(12 + 100 * x) * (behind > 0 ? 1000 : 1));
        normals.emplace_back(0, 0, gap > 0 ? 1 - 2 * behind : 0);
    }
    if (strayAt > 0) {
        for (int n = 0; n < 3; ++n) {
            points.emplace_back(strayAt + 1e-5 * n, strayAt, 0);
            stiffness.push_back(1e5);
            normals.emplace_back(0);
        }
    }
    return SoftObject(PointCloud(std::move(points), std::move(stiffness), StiffnessKind::modulus), {}, {}, normals);
}

TEST(CoarseObject, StandsForEveryPointOnceAtMeanPlaceAndMeanLogarithm)
{
    const SoftObject             dense = denseSheet(0);
    const CoarseObject           coarse(dense, 1e-3);
    std::multiset<std::uint32_t> all;
    for (std::size_t k = 0; k < coarse.object().size(); ++k) {
        glm::dvec3 place{};
        double     logarithm = 0, widest = 0;
        const auto members = coarse.membersOf(k);
        ASSERT_FALSE(members.empty());
        for (const std::uint32_t point : members) {
            all.insert(point);
            place += dense.positions()[point] / double(members.size());
            logarithm += std::log(dense.cloud().stiffness()[point]) / double(members.size());
            widest = std::max(widest, std::abs(dense.positions()[point].x - dense.positions()[members[0]].x));
        }
        EXPECT_LT(widest, 1.42e-3) << "a power of two of the cells";
        EXPECT_LT(glm::length(place - coarse.object().positions()[k]), 1e-15);
        EXPECT_NEAR(std::log(coarse.object().cloud().stiffness()[k]), logarithm, 1e-12);
    }
    EXPECT_EQ(all.size(), dense.size());
    EXPECT_EQ(std::set(all.begin(), all.end()).size(), dense.size());
    EXPECT_GT(coarse.object().size(), 150u) << "400 mm^2 by cubes of up to 1.42 mm";
    EXPECT_LT(coarse.object().size(), 1200u);
}

/// The body is tilted: the middle of the object is a border of cubes, which would keep level faces apart by itself.
TEST(CoarseObject, KeepsTheFacesOfAThinBodyApart)
{
    const SoftObject        level = denseSheet(0.2e-3);
    const double            tilt  = 0.35; // [rad] about x
    const glm::dvec3        up(0, -std::sin(tilt), std::cos(tilt)), along(0, up.z, -up.y);
    std::vector<glm::dvec3> points;
    std::vector<glm::vec3>  normals;
    for (std::size_t i = 0; i < level.size(); ++i) {
        const glm::dvec3& p = level.positions()[i];
        points.push_back(glm::dvec3(p.x, 0, 0) + p.y * along + p.z * up);
        normals.push_back(i % 2 == 0 ? up : -up);
    }
    const auto         stiffness = level.cloud().stiffness();
    const SoftObject   dense(PointCloud(points, {stiffness.begin(), stiffness.end()}, StiffnessKind::modulus), {}, {},
                             normals);
    const CoarseObject coarse(dense, 1e-3);
    for (std::size_t k = 0; k < coarse.object().size(); ++k) {
        const std::uint32_t face = coarse.membersOf(k)[0] % 2;
        EXPECT_NEAR(glm::dot(coarse.object().positions()[k], up), face == 0 ? 0 : -0.2e-3, 1e-12);
        EXPECT_GT(glm::dot(coarse.object().survey().normal(k), up) * (face == 0 ? 1 : -1), 0.9);
        for (const std::uint32_t point : coarse.membersOf(k)) EXPECT_EQ(point % 2, face);
    }
}

/// One sheet has no layers to tell its side by: only what its points know does.
TEST(CoarseObject, KeepsTheSideThatNormalsGave)
{
    const SoftObject             plain = denseSheet(0);
    const std::vector<glm::vec3> down(plain.size(), glm::vec3(0, 0, -1));
    const SoftObject             dense(plain.cloud(), {}, {}, down);
    const CoarseObject           coarse(dense, 1e-3);
    for (std::size_t k = 0; k < coarse.object().size(); ++k) {
        EXPECT_TRUE(coarse.object().survey().sided(k));
        EXPECT_LT(coarse.object().survey().normal(k).z, -0.9);
    }
}

TEST(CoarseObject, StraysFarAwayStayApart)
{
    const SoftObject   dense = denseSheet(0, 50);
    const CoarseObject coarse(dense, 1e-3);
    int                strays = 0;
    for (const glm::dvec3& p : coarse.object().positions()) strays += p.x > 1;
    EXPECT_EQ(strays, 3);
}

TEST(CoarseObject, IsMadeOnceAndFollowsPaintAndMaterial)
{
    const SoftObject dense = denseSheet(0);
    const auto       first = dense.coarse(1e-3);
    EXPECT_EQ(dense.coarse(1e-3), first);
    EXPECT_EQ(SoftObject(dense).coarse(1e-3), first) << "copies share it";

    const SoftObject painted = dense.repainted(std::vector<double>(dense.size(), 2e5));
    const auto       second  = painted.coarse(1e-3);
    EXPECT_NEAR(second->object().cloud().stiffness()[5], 2e5, 1e-6);
    EXPECT_EQ(&second->object().index(), &first->object().index()) << "the shape is the same";
    EXPECT_EQ(dense.coarse(1e-3), first);

    Material thick;
    thick.thickness = 7e-3;
    EXPECT_EQ(dense.withMaterial(thick).coarse(1e-3)->object().material().thickness, 7e-3);
    EXPECT_LT(dense.coarse(4e-3)->object().size(), first->object().size() / 8);
}

} // namespace
} // namespace palp
