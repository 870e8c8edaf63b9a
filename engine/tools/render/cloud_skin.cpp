#include "engine/tools/render/cloud_skin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "engine/cloud/local_spacing.h"

namespace palp {
namespace {

constexpr std::size_t kNeighbours = 20; ///< of a fit, the point included: fewer are noisy, more round off edges

/// Radius of a core over the spacing, at least and at most: of points strewn at random one place in 10^5 is farther
/// from all of them than the latter [1].
constexpr double kLeastCore = 0.7, kMostCore = 2.0;

/// Over the distance that a core must reach: neighbours in a tangent plane are not quite where they are in space [1].
constexpr double kReserve = 1.08;

/// Returns the smallest eigenvalue of a symmetric matrix.
/// \source O. K. Smith 1961, "Eigenvalues of a symmetric 3 x 3 matrix"
double leastEigenvalue(const glm::dmat3& a)
{
    const double     mean    = (a[0][0] + a[1][1] + a[2][2]) / 3;
    const glm::dmat3 b       = a - glm::dmat3(mean);
    double           squares = 0;
    for (int k = 0; k < 3; ++k) squares += glm::dot(b[k], b[k]);
    const double p = std::sqrt(squares / 6);
    if (!(p > 0)) return mean;
    const double half = std::clamp(glm::dot(b[0], glm::cross(b[1], b[2])) / (2 * p * p * p), -1.0, 1.0);
    return mean + 2 * p * std::cos(std::acos(half) / 3 + 2 * std::numbers::pi / 3);
}

/// Returns a unit vector perpendicular to the plane that the rows of a singular matrix span.
glm::dvec3 perpendicularTo(const glm::dmat3& a)
{
    glm::dvec3 best(0);
    for (const auto& [i, j] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
        const glm::dvec3 candidate = glm::cross(a[i], a[j]);
        if (glm::dot(candidate, candidate) > glm::dot(best, best)) best = candidate;
    }
    const double length = glm::length(best);
    return length > 0 ? best / length : glm::dvec3(0, 0, 1); // points on a line have no plane
}

} // namespace

CloudSkin::CloudSkin(std::span<const glm::dvec3> positions, const NeighbourIndex& index)
    : each_(std::min(kNeighbours, positions.size())), radii_(localSpacings(index)), cores_(radii_.size())
{
    neighbours_.reserve(each_ * positions.size());
    for (const glm::dvec3& position : positions)
        for (const Neighbour& near : index.nearest(position, each_)) neighbours_.push_back(near.point);
    for (std::size_t n = 0; n < cores_.size(); ++n) {
        const double spacing = radii_[n];
        cores_[n]            = coreOf(positions, n, spacing);
        radii_[n]            = std::max(kDisc * spacing, cores_[n]);
    }
}

// The farthest corner of the point's Voronoi cell in its tangent plane: the centre of a circle through the point and
// two neighbours that holds no other one.
double CloudSkin::coreOf(std::span<const glm::dvec3> positions, std::size_t point, double spacing) const
{
    const glm::dvec3 normal = normalOf(positions, point);
    const glm::dvec3 u =
        glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3                    v = glm::cross(normal, u);
    std::array<glm::dvec2, kNeighbours> at{}; // [spacings]
    std::size_t                         count = 0;
    for (const std::uint32_t n : std::span(neighbours_).subspan(point * each_, each_)) {
        const glm::dvec3 away = (positions[n] - positions[point]) / spacing;
        if (n != point) at[count++] = {glm::dot(away, u), glm::dot(away, v)};
    }
    const auto near = std::span(at).first(count);
    double     most = kLeastCore * kLeastCore; // square of the radius so far [1]
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = a + 1; b < count; ++b) {
            const double twice = 2 * (at[a].x * at[b].y - at[a].y * at[b].x);
            if (twice == 0) continue;
            const double     aa = glm::dot(at[a], at[a]), bb = glm::dot(at[b], at[b]);
            const glm::dvec2 centre((aa * at[b].y - bb * at[a].y) / twice, (bb * at[a].x - aa * at[b].x) / twice);
            const double     square = glm::dot(centre, centre);
            if (!(square > most)) continue;
            const auto within = [&](const glm::dvec2& p) {
                return glm::dot(p - centre, p - centre) < square * (1 - 1e-9);
            };
            if (std::ranges::none_of(near, within)) most = square; // beyond the neighbours it may be less
        }
    return std::min(kReserve * std::sqrt(most), kMostCore) * spacing;
}

glm::dvec3 CloudSkin::normalOf(std::span<const glm::dvec3> positions, std::size_t point) const
{
    const auto near = std::span(neighbours_).subspan(point * each_, each_);
    glm::dvec3 mean(0);
    for (const std::uint32_t n : near) mean += positions[n];
    mean /= double(near.size());
    glm::dmat3   spread(0);
    const double scale = 1 / radii_[point]; // squares of tiny lengths must not underflow
    for (const std::uint32_t n : near) {
        const glm::dvec3 away = scale * (positions[n] - mean);
        spread += glm::dmat3(away.x * away, away.y * away, away.z * away);
    }
    return perpendicularTo(spread - glm::dmat3(leastEigenvalue(spread)));
}

std::vector<glm::dvec3> CloudSkin::normals(std::span<const glm::dvec3> positions) const
{
    std::vector<glm::dvec3> result(positions.size());
    for (std::size_t n = 0; n < result.size(); ++n) result[n] = normalOf(positions, n);
    return result;
}

std::vector<double> CloudSkin::smoothed(std::span<const double> values) const
{
    std::vector<double> result(values.size());
    for (std::size_t n = 0; n < values.size(); ++n) {
        for (const std::uint32_t k : std::span(neighbours_).subspan(n * each_, each_)) result[n] += values[k];
        result[n] /= double(each_);
    }
    return result;
}

void CloudSkin::refit(std::span<const glm::dvec3> positions, std::span<const std::uint32_t> points,
                      std::span<glm::dvec3> normals) const
{
    for (const std::uint32_t n : points) {
        const glm::dvec3 fitted = normalOf(positions, n);
        normals[n]              = glm::dot(fitted, normals[n]) < 0 ? -fitted : fitted;
    }
}

} // namespace palp
