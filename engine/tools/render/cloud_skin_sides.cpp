#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <tuple>
#include <utility>

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

/// The neighbours of each point, all of a number, the point included.
struct Neighbourhood {
    std::span<const std::uint32_t> neighbours;
    std::size_t                    each; ///< of a point

    [[nodiscard]] auto of(std::uint32_t point) const { return neighbours.subspan(point * each, each); }
};

/// Returns whether the surface folds among a point's neighbours, as at the edge of a tetrahedron.
bool folds(std::span<const std::uint32_t> neighbours, std::span<const glm::dvec3> normals)
{
    constexpr double kFolded = 0.3; // cosine; round a tube of 25 points neighbours turn by less [1]
    return std::ranges::any_of(neighbours, [&](std::uint32_t a) {
        return std::ranges::any_of(neighbours,
                                   [&](std::uint32_t b) { return glm::dot(normals[a], normals[b]) < kFolded; });
    });
}

/// Returns whether the surface ends at a point: on one side of it, in the tangent plane, there are no neighbours,
/// although the surface does not fold there.
bool isAtABorder(std::uint32_t point, const Neighbourhood& near, std::span<const glm::dvec3> positions,
                 std::span<const glm::dvec3> normals)
{
    constexpr double  kGap   = 2.6; // of points strewn at random one in a thousand has so wide a one elsewhere [rad]
    const glm::dvec3& normal = normals[point];
    const glm::dvec3  u =
        glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3    v = glm::cross(normal, u);
    std::vector<double> angles;
    for (const std::uint32_t n : near.of(point)) {
        const glm::dvec3 away = positions[n] - positions[point];
        if (n != point) angles.push_back(std::atan2(glm::dot(away, v), glm::dot(away, u)));
    }
    std::ranges::sort(angles);
    double widest = angles.front() + 2 * std::numbers::pi - angles.back();
    for (std::size_t k = 1; k < angles.size(); ++k) widest = std::max(widest, angles[k] - angles[k - 1]);
    return widest > kGap && !folds(near.of(point), normals);
}

/// Returns the area of a piece's openings together, each as if it were round [m²].
double openingOf(const Piece& piece, const Neighbourhood& near, std::span<const glm::dvec3> positions,
                 std::span<const glm::dvec3> normals)
{
    std::vector<std::uint8_t> border(positions.size()); // of a rim that is not walked round yet
    for (const std::uint32_t n : piece.points) border[n] = isAtABorder(n, near, positions, normals);
    double area = 0;
    for (const std::uint32_t first : piece.points) {
        if (!std::exchange(border[first], 0)) continue;
        std::vector<std::uint32_t> rim{first};
        for (std::size_t k = 0; k < rim.size(); ++k)
            for (const std::uint32_t to : near.of(rim[k]))
                if (std::exchange(border[to], 0)) rim.push_back(to);
        glm::dvec3 middle(0);
        for (const std::uint32_t n : rim) middle += positions[n] / double(rim.size());
        double squares = 0;
        for (const std::uint32_t n : rim) squares += glm::dot(positions[n] - middle, positions[n] - middle);
        area += std::numbers::pi * squares / double(rim.size());
    }
    return area;
}

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
    const auto areaOf = [&](const Piece& piece) { // [m²]
        double sum = 0;
        for (const std::uint32_t n : piece.points) sum += areas[n];
        return sum / (kDisc * kDisc);
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
        double volume = piece.outwardVolume(positions, normals, areas);
        if (volume != 0 && openingOf(piece, {neighbours_, each_}, positions, normals) > kClosed * areaOf(piece))
            volume = 0; // the ends of a tube cancel each other in the sum
        for (const std::uint32_t n : piece.points) {
            closed[n] = volume != 0;
            if (volume < 0) normals[n] = -normals[n];
        }
    }
    return closed;
}

} // namespace palp
