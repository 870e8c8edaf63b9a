#include "engine/viewer/cloud_skin.h"

#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kRadius = 0.05; // of the ball [m]

std::vector<glm::dvec3> ball(std::size_t points, const glm::dvec3& centre = {})
{
    std::mt19937                     random(7);
    std::normal_distribution<double> normal;
    std::vector<glm::dvec3>          positions(points);
    for (glm::dvec3& p : positions)
        p = centre + kRadius * glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    return positions;
}

double worstAngle(const std::vector<glm::dvec3>& positions, const std::vector<glm::dvec3>& normals,
                  const glm::dvec3& centre = {})
{
    double worst = 1; // smallest cosine [1]
    for (std::size_t n = 0; n < positions.size(); ++n)
        worst = std::min(worst, std::abs(glm::dot(normals[n], glm::normalize(positions[n] - centre))));
    return std::acos(worst);
}

TEST(CloudSkin, NormalsOfABallPointAlongItsRadii)
{
    const glm::dvec3     far(1000, -2000, 3000); // [m] surveyors count from far away
    const auto           positions = ball(8000, far);
    const NeighbourIndex index(positions);
    const CloudSkin      skin(positions, index);

    EXPECT_LT(worstAngle(positions, skin.normals(positions), far), 0.12) << "fourteen random points are noisy [rad]";
}

TEST(CloudSkin, DiscsLeaveNoPlaceOfABallBare)
{
    const auto           positions = ball(8000);
    const NeighbourIndex index(positions);
    const CloudSkin      skin(positions, index);

    int bare = 0;
    for (const glm::dvec3& place : ball(50000)) {
        bool covered = false;
        for (const Neighbour& near : index.nearest(place, 8))
            covered = covered || near.distance < skin.cores()[near.point];
        bare += !covered;
    }
    EXPECT_LE(bare, 5) << "of 50000 places";
}

TEST(CloudSkin, RefitFollowsADentAndLeavesTheRestAlone)
{
    std::vector<glm::dvec3> positions; // a sheet of 41 x 41 points, 1 mm apart
    for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j) positions.emplace_back(1e-3 * i, 1e-3 * j, 0);
    const NeighbourIndex index(positions);
    const CloudSkin      skin(positions, index);
    auto                 normals = skin.normals(positions);
    const auto           before  = normals;

    std::vector<std::uint32_t> moved;
    for (std::uint32_t n = 0; n < positions.size(); ++n)
        if (positions[n].x > 5e-3) {
            positions[n].z = 0.5 * (positions[n].x - 5e-3); // a slope of one half
            moved.push_back(n);
        }
    skin.refit(positions, moved, normals);

    const glm::dvec3 slope = glm::normalize(glm::dvec3(-0.5, 0, 1));
    for (std::size_t n = 0; n < positions.size(); ++n) {
        if (positions[n].x <= 5e-3) {
            EXPECT_EQ(normals[n], before[n]);
        } else if (positions[n].x > 8e-3) {
            EXPECT_NEAR(std::abs(glm::dot(normals[n], slope)), 1, 1e-9);
        }
    }
}

TEST(CloudSkin, TinyAndHugeObjectsAreTheSame)
{
    for (const double scale : {1e-6, 1.0, 1e6}) {
        auto positions = ball(2000);
        for (glm::dvec3& p : positions) p *= scale;
        const NeighbourIndex index(positions);
        const CloudSkin      skin(positions, index);
        EXPECT_LT(worstAngle(positions, skin.normals(positions)), 0.25) << "scale " << scale;
    }
}

} // namespace
} // namespace palp
