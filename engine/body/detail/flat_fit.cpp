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

glm::dvec3 FlatFit::place(const glm::dvec2& along) const
{
    const double x = along.x / radius, y = along.y / radius;
    const double height = of[0] + of[1] * x + of[2] * y + of[3] * x * x + of[4] * x * y + of[5] * y * y;
    return frame.place + frame.lifted(along) + height * radius * frame.normal;
}

glm::dvec3 FlatFit::normal(const glm::dvec2& along) const
{
    const double x = along.x / radius, y = along.y / radius;
    return glm::normalize(frame.normal - (of[1] + 2 * of[3] * x + of[4] * y) * frame.east -
                          (of[2] + of[4] * x + 2 * of[5] * y) * frame.north);
}

void CurveFit::add(double at, double value, double share)
{
    for (std::size_t n = 0; n < powers_.size(); ++n, share *= at) {
        powers_[n] += share;
        if (n < values_.size()) values_[n] += share * value;
    }
    ++count_;
}

std::optional<double> CurveFit::atMiddle() const
{
    constexpr int    kFewest = 4;
    constexpr double kSound  = 1e-4; // of the diagonal [1]
    Eigen::Matrix3d  matrix;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) matrix(i, j) = powers_[std::size_t(i + j)];
    const Eigen::LDLT<Eigen::Matrix3d> factors(matrix);
    if (count_ < kFewest || !(factors.vectorD().minCoeff() > kSound * factors.vectorD().maxCoeff())) return {};
    return factors.solve(Eigen::Vector3d(values_[0], values_[1], values_[2]))[0];
}

FlatFit flatFit(const FlatFrame& frame, std::span<const glm::dvec3> points, double radius)
{
    using Row                           = Eigen::Matrix<double, 6, 1>;
    constexpr std::size_t       kFewest = 8; // points for six unknowns
    Eigen::Matrix<double, 6, 6> matrix  = Eigen::Matrix<double, 6, 6>::Zero();
    Row                         right   = Row::Zero();
    FlatFit                     result{frame, radius, {}};
    if (points.size() < kFewest) return result;
    for (const glm::dvec3& point : points) {
        const glm::dvec2 p  = frame.laid(point) / radius;
        const double share  = std::max(0.0, 1 - glm::dot(point - frame.place, point - frame.place) / (radius * radius));
        const double height = glm::dot(point - frame.place, frame.normal) / radius;
        Row          row;
        row << 1, p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y;
        matrix += share * share * row * row.transpose();
        right += share * share * height * row;
    }
    const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> factors(matrix);
    constexpr double                               kSound = 1e-6; // of the diagonal [1]
    if (factors.info() != Eigen::Success || factors.vectorD().minCoeff() < kSound * factors.vectorD().maxCoeff())
        return result;
    const Row fit = factors.solve(right);
    std::copy(fit.begin(), fit.end(), result.of.begin());
    return result;
}

} // namespace palp
