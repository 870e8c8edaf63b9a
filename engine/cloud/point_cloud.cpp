#include "engine/cloud/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp {
namespace {

bool finite(const glm::dvec3& p)
{
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

} // namespace

const char* unitOf(StiffnessKind kind) noexcept
{
    return kind == StiffnessKind::modulus ? "Pa" : kind == StiffnessKind::rigidity ? "N_m" : "N/m";
}

const char* propertyOf(StiffnessKind kind) noexcept
{
    return kind == StiffnessKind::modulus    ? "stiffness"
           : kind == StiffnessKind::rigidity ? "flexural_rigidity"
                                             : "felt_stiffness";
}

Dimension dimensionOf(StiffnessKind kind) noexcept
{
    return kind == StiffnessKind::modulus    ? Dimension::pressure
           : kind == StiffnessKind::rigidity ? Dimension::rigidity
                                             : Dimension::stiffness;
}

double Bounds::diagonal() const noexcept
{
    return glm::length(high - low);
}

PointCloud::PointCloud(std::vector<glm::dvec3> positions, std::vector<double> stiffness, StiffnessKind kind)
    : positions_(std::make_shared<const std::vector<glm::dvec3>>(std::move(positions))),
      stiffness_(std::move(stiffness)), kind_(kind)
{
    if (positions_->empty()) throw Error("the cloud is empty: expected at least one point");
    bounds_ = {positions_->front(), positions_->front()};
    for (std::size_t i = 0; i < positions_->size(); ++i) {
        const glm::dvec3& p = (*positions_)[i];
        if (!finite(p))
            throw Error("point " + std::to_string(i) + ": expected a finite position, found (" + std::to_string(p.x) +
                        ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")");
        if (std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kLargestCoordinate)
            throw Error("point " + std::to_string(i) + ": expected coordinates of at most 1e9 m, found (" +
                        std::to_string(p.x) + ", " + std::to_string(p.y) + ", " + std::to_string(p.z) + ")");
        bounds_.low  = glm::min(bounds_.low, p);
        bounds_.high = glm::max(bounds_.high, p);
    }
    checkStiffness();
}

PointCloud::PointCloud(const PointCloud& points, std::vector<double> stiffness)
    : positions_(points.positions_), stiffness_(std::move(stiffness)), kind_(points.kind_), bounds_(points.bounds_)
{
    checkStiffness();
}

void PointCloud::checkStiffness() const
{
    PALP_EXPECT(positions_->size() == stiffness_.size(), std::to_string(positions_->size()) + " positions, " +
                                                             std::to_string(stiffness_.size()) + " stiffnesses");
    for (std::size_t i = 0; i < stiffness_.size(); ++i)
        if (!(stiffness_[i] > 0) || !std::isfinite(stiffness_[i]))
            throw Error("point " + std::to_string(i) + ": expected a finite stiffness above zero [" + unitOf(kind_) +
                        "], found " + std::to_string(stiffness_[i]));
}

double PointCloud::rigidity(std::size_t point, const Material& material) const noexcept
{
    if (kind_ == StiffnessKind::felt) return std::numeric_limits<double>::quiet_NaN();
    return kind_ == StiffnessKind::rigidity ? stiffness_[point] : material.rigidity(stiffness_[point]);
}

double PointCloud::modulus(std::size_t point, const Material& material) const noexcept
{
    if (kind_ == StiffnessKind::felt) return std::numeric_limits<double>::quiet_NaN();
    return kind_ == StiffnessKind::modulus ? stiffness_[point] : material.modulus(stiffness_[point]);
}

} // namespace palp
