#include "engine/viewer/cloud_skin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "engine/contact/local_spacing.h"

namespace palp {
namespace {

constexpr std::size_t kNeighbours = 20; ///< of a fit, the point included: fewer are noisy, more round off edges [1]

/// Radius of a disc over the spacing: of points strewn at random one place in 10^6 stays bare [1].
constexpr double kRadius = 2.5;

/// The smallest eigenvalue of a symmetric matrix.
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

/// A unit vector perpendicular to the plane that the rows of a singular matrix span.
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
    : each_(std::min(kNeighbours, positions.size())), radii_(localSpacings(positions, index))
{
    for (double& radius : radii_) radius *= kRadius;
    neighbours_.reserve(each_ * positions.size());
    for (const glm::dvec3& position : positions)
        for (const Neighbour& near : index.nearest(position, each_)) neighbours_.push_back(near.point);
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

void CloudSkin::refit(std::span<const glm::dvec3> positions, std::span<const std::uint32_t> points,
                      std::span<glm::dvec3> normals) const
{
    for (const std::uint32_t n : points) normals[n] = normalOf(positions, n);
}

} // namespace palp
