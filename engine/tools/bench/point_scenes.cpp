#include "engine/tools/bench/point_scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/cloud/morton.h"

namespace palp::bench {

std::vector<glm::dvec3> bumpyBall(std::size_t points)
{
    constexpr double           kRadius = 0.1; // [m]
    std::mt19937_64            random(7);
    std::normal_distribution<> normal;
    const auto                 cell = [](double x) {
        return std::uint32_t((x / kRadius + 2) / 4 * kMortonCells); // the bumps stay within 2 radii
    };
    std::vector<std::pair<std::uint64_t, glm::dvec3>> keyed(points);
    for (auto& [code, p] : keyed) {
        p    = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        p    = p * kRadius * (1 + 0.05 * std::sin(9 * p.x) * std::sin(9 * p.y) * std::sin(9 * p.z));
        code = mortonCode(cell(p.x), cell(p.y), cell(p.z));
    }
    std::sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<glm::dvec3> cloud(points);
    std::transform(keyed.begin(), keyed.end(), cloud.begin(), [](const auto& k) { return k.second; });
    return cloud;
}

std::vector<glm::dvec3> searchPlaces(const std::vector<glm::dvec3>& cloud, double spacing, std::size_t count)
{
    std::mt19937_64                  random(11);
    std::uniform_real_distribution<> shift(-0.5 * spacing, 0.5 * spacing);
    std::vector<glm::dvec3>          places;
    for (std::size_t i = 0; i < count; ++i)
        places.push_back(cloud[random() % cloud.size()] + glm::dvec3(shift(random), shift(random), shift(random)));
    return places;
}

GridMapScene::GridMapScene(int nodes, double pointsPerCell)
    : grid{nodes - 1, nodes - 1, 1e-3, 1e-3}, origin{-0.5 * grid.sizeX(), -0.5 * grid.sizeZ()}
{
    const double                     radius = 0.75 * grid.sizeX();
    const double                     square = 4 * radius * radius / (grid.spacingX * grid.spacingZ);
    std::mt19937                     random(4);
    std::uniform_real_distribution<> along(-radius, radius);
    const auto cell = [radius](double x) { return std::uint32_t((x / radius + 1) / 2 * (kMortonCells - 1)); };
    std::vector<std::pair<std::uint64_t, ChartPoint>> keyed;
    for (std::size_t p = 0; p < std::size_t(square * pointsPerCell); ++p) {
        const ChartPoint at{along(random), along(random)};
        if (std::hypot(at.x, at.z) > radius) continue;
        keyed.push_back({mortonCode(cell(at.x), cell(at.z), 0), at});
    }
    std::sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [code, at] : keyed) points.push_back(at);
}

} // namespace palp::bench
