#include "engine/body/detail/flat_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

namespace palp {

FlatFrame FlatFrame::about(const glm::dvec3& place, const glm::dvec3& normal)
{
    const glm::dvec3 other = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 east  = glm::normalize(other - glm::dot(other, normal) * normal);
    return {place, normal, east, glm::cross(normal, east)};
}

glm::dvec2 FlatFrame::laid(const glm::dvec3& point) const
{
    return {glm::dot(point - place, east), glm::dot(point - place, north)};
}

glm::dvec2 FlatFrame::unrolled(const glm::dvec3& point) const
{
    const glm::dvec2 flat   = laid(point);
    const double     length = glm::length(flat);
    return length > 0 ? flat * (glm::length(point - place) / length) : flat;
}

glm::dvec3 FlatFrame::lifted(const glm::dvec2& along) const
{
    return along.x * east + along.y * north;
}

FlatFit flatFit(const FlatFrame& frame, std::span<const glm::dvec3> points, double radius)
{
    using Row = Eigen::Matrix<double, 6, 1>;
    constexpr std::size_t       kFewest = 8; // points for six unknowns
    Eigen::Matrix<double, 6, 6> matrix  = Eigen::Matrix<double, 6, 6>::Zero();
    Row                         right   = Row::Zero();
    if (points.size() < kFewest) return {frame.place, frame.normal};
    for (const glm::dvec3& point : points) {
        const glm::dvec2 p     = frame.laid(point) / radius;
        const double     share = std::max(0.0, 1 - glm::dot(point - frame.place, point - frame.place) / (radius * radius));
        const double     height = glm::dot(point - frame.place, frame.normal) / radius;
        Row              row;
        row << 1, p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y;
        matrix += share * share * row * row.transpose();
        right += share * share * height * row;
    }
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factors(matrix);
    constexpr double                               kSound = 1e-6; // of the diagonal [1]
    if (factors.info() != Eigen::Success || factors.vectorD().minCoeff() < kSound * factors.vectorD().maxCoeff())
        return {frame.place, frame.normal};
    const Row fit = factors.solve(right);
    return {frame.place + fit[0] * radius * frame.normal,
            glm::normalize(frame.normal - fit[1] * frame.east - fit[2] * frame.north)};
}

} // namespace palp
