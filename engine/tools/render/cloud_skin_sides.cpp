#include <cmath>
#include <queue>
#include <tuple>

#include <glm/geometric.hpp>

#include "engine/tools/render/cloud_skin.h"

// Which side of a cloud's surface is outside, handed on from neighbour to neighbour along a minimum spanning tree.
// This work is based on: Hoppe et al. 1992, "Surface reconstruction from unorganized points" (the tree); König and
// Gumhold 2009, "Consistent propagation of normal orientations in point clouds" (around sharp edges a normal is handed
// on mirrored, so that it turns with the surface and does not jump through it).

namespace palp {
namespace {

constexpr std::size_t kHandedTo = 10; ///< neighbours of a point, the nearest ones, itself included

/// What closes: the sum of the areas as vectors is zero by Gauss; a tenth of holes, or of mistakes, leaves less than
/// this of their plain sum [1].
constexpr double kClosed = 0.05;

constexpr std::size_t kFewest = 100; ///< least points of a piece that may count as closed

/// A piece of the cloud that hangs together.
struct Piece {
    std::vector<std::uint32_t> points;

    /// \param areas  of the points, up to a factor [m²]
    [[nodiscard]] double outwardVolume(std::span<const glm::dvec3> positions, std::span<const glm::dvec3> normals,
                                       std::span<const double> areas) const
    {
        glm::dvec3 sum(0);
        double     plain = 0, volume = 0;
        for (const std::uint32_t n : points) {
            sum += areas[n] * normals[n];
            plain += areas[n];
            volume += areas[n] * glm::dot(normals[n], positions[n] - positions[points.front()]);
        }
        return points.size() >= kFewest && glm::length(sum) < kClosed * plain ? volume : 0;
    }
};

} // namespace

std::vector<std::uint8_t> CloudSkin::turnOutwards(std::span<const glm::dvec3> positions,
                                                  std::span<glm::dvec3>       normals) const
{
    using Handed = std::tuple<double, std::uint32_t, std::uint32_t>; // how much it turns; from, to
    std::priority_queue<Handed, std::vector<Handed>, std::greater<>> next;
    std::vector<std::uint8_t>                                        done(positions.size()), closed(positions.size());
    std::vector<double>                                              areas(positions.size());
    for (std::size_t n = 0; n < areas.size(); ++n) areas[n] = radii_[n] * radii_[n];

    // Near points are scattered across the surface as far as along it: for them the edge between them says little.
    const auto handed = [&](std::uint32_t from, std::uint32_t to) {
        const glm::dvec3 edge = positions[to] - positions[from];
        const double     soft = 0.02 * areas[from]; // square of a third of the spacing [m²]
        return normals[from] - 2 * glm::dot(normals[from], edge) / (glm::dot(edge, edge) + soft) * edge;
    };
    const auto reach = [&](std::uint32_t point, Piece& piece) {
        done[point] = 1;
        piece.points.push_back(point);
        for (const std::uint32_t to : std::span(neighbours_).subspan(point * each_, std::min(each_, kHandedTo)))
            if (!done[to]) next.emplace(1 - std::abs(glm::dot(handed(point, to), normals[to])), point, to);
    };
    for (std::uint32_t first = 0; first < positions.size(); ++first) {
        if (done[first]) continue;
        Piece piece;
        reach(first, piece);
        while (!next.empty()) {
            const auto [turn, from, to] = next.top();
            next.pop();
            if (done[to]) continue;
            if (glm::dot(handed(from, to), normals[to]) < 0) normals[to] = -normals[to];
            reach(to, piece);
        }
        const double volume = piece.outwardVolume(positions, normals, areas);
        for (const std::uint32_t n : piece.points) {
            closed[n] = volume != 0;
            if (volume < 0) normals[n] = -normals[n];
        }
    }
    return closed;
}

} // namespace palp
