#include "engine/tools/render/rest_relief.h"

#include <algorithm>
#include <numbers>

#include <glm/geometric.hpp>

#include "engine/cloud/neighbour_index.h"
#include "engine/core/uniform.h"

namespace palp {
namespace {

constexpr double kTaps  = 40;  ///< mean number of surroundings of a point; fewer look like grain
constexpr double kWider = 3.5; ///< a second look finds what is wide and shallow, as there [1]
constexpr double kEdge  = 0.5; ///< cosine of the angle of normals: beyond a sharp edge lies another face, as there [1]

/// Some of the points, strewn so thinly that a disc of the radius holds kTaps of them.
struct Strewn {
    std::vector<glm::dvec3> positions, normals; // [m], [1]

    Strewn(std::span<const glm::dvec3> all, std::span<const glm::dvec3> allNormals, double spacing, double radius)
    {
        const double share = kTaps * spacing * spacing / (std::numbers::pi * radius * radius); // of the points [1]
        Uniform      random(1);
        for (std::size_t n = 0; n < all.size(); ++n)
            if (random() < share) {
                positions.push_back(all[n]);
                normals.push_back(allNormals[n]);
            }
    }
};

void addRelief(std::span<double> relief, std::span<const glm::dvec3> positions, std::span<const glm::dvec3> normals,
               double spacing, double radius)
{
    const Strewn strewn(positions, normals, spacing, radius);
    if (strewn.positions.empty()) return;
    const NeighbourIndex       index(strewn.positions);
    std::vector<std::uint32_t> near;
    for (std::size_t n = 0; n < positions.size(); ++n) {
        index.gather(positions[n], radius, near);
        double sum = 0, weights = 0;
        for (const std::uint32_t k : near) {
            const glm::dvec3 rise     = strewn.positions[k] - positions[n];
            const double     distance = glm::length(rise), weight = 1 - distance / (2 * radius);
            const bool across = glm::dot(strewn.normals[k], normals[n]) < kEdge; // or the other side of a thin one
            if (across || distance == 0) continue;
            sum += weight * glm::dot(rise, normals[n]) / (distance + 0.1 * radius);
            weights += weight;
        }
        if (weights > 0) relief[n] += sum / std::max(weights, 0.25 * kTaps);
    }
}

} // namespace

std::vector<double> restRelief(std::span<const glm::dvec3> positions, std::span<const glm::dvec3> normals,
                               double spacing, double radius)
{
    std::vector<double> relief(positions.size());
    addRelief(relief, positions, normals, spacing, radius);
    addRelief(relief, positions, normals, spacing, kWider * radius);
    return relief;
}

} // namespace palp
