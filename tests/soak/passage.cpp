#include "tests/soak/passage.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

namespace palp::soak {
namespace {

constexpr double kReach  = 3;    // [spacings] from a point within which its plane stands for the surface
constexpr double kMargin = 1;    // [spacings] behind the plane from which on a hand is behind it; contacts begin sooner
constexpr double kSame   = 0.9;  // [1] cosine between normals of one surface
constexpr double kWay    = 3e-3; // [m] in a tick: two hands' worth; whatever goes farther has jumped

/// Returns whether the largest gap between the points, as seen from the first along the plane, is below a third of a
/// turn.
bool isSurrounded(const std::vector<glm::dvec3>& points, const glm::dvec3& normal)
{
    const glm::dvec3    other = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3    one = glm::normalize(glm::cross(normal, other)), two = glm::cross(normal, one);
    std::vector<double> angles;
    for (std::size_t n = 1; n < points.size(); ++n)
        angles.push_back(std::atan2(glm::dot(points[n] - points[0], two), glm::dot(points[n] - points[0], one)));
    std::ranges::sort(angles);
    double widest = angles.front() + 2 * std::numbers::pi - angles.back();
    for (std::size_t n = 1; n < angles.size(); ++n) widest = std::max(widest, angles[n] - angles[n - 1]);
    return widest < 2 * std::numbers::pi / 3;
}

} // namespace

Passage::Passage(const SoftObject& object) : object_(object), planes_(object.size()) {}

const Passage::Plane& Passage::planeAt(std::uint32_t point)
{
    constexpr std::size_t kPoints = 24;   // about 3 spacings across, besides the point itself
    constexpr double      kRough  = 0.15; // [spacings] root mean square, of noise and of curvature
    Plane&                plane   = planes_[point];
    if (plane.isKnown) return plane;
    plane.isKnown     = true;
    const auto around = object_.index().nearest(object_.positions()[point], kPoints + 1);
    if (around.size() <= kPoints) return plane;
    plane.spacing = around[6].distance * std::sqrt(std::numbers::pi / 6);

    std::vector<glm::dvec3> points;
    glm::dvec3              middle{};
    for (const Neighbour& one : around) points.push_back(object_.positions()[one.point]);
    for (const glm::dvec3& one : points) middle += one / double(points.size());
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const glm::dvec3& one : points) {
        const Eigen::Vector3d from(one.x - middle.x, one.y - middle.y, one.z - middle.z);
        spread += from * from.transpose() / double(points.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
    const Eigen::Vector3d                                normal = axes.eigenvectors().col(0);
    plane.normal                                                = {normal.x(), normal.y(), normal.z()};
    plane.isPlain =
        std::sqrt(std::max(0.0, axes.eigenvalues()(0))) < kRough * plane.spacing && isSurrounded(points, plane.normal);
    return plane;
}

std::optional<std::string> Passage::check(const TickRecord& record)
{
    const auto forget = [&] {
        side_.reset();
        touched_.reset();
        hip_.reset();
    };
    const bool isSound = (record.device & 0xFFU) == 0 && (record.device >> 8U & 1U) != 0 && // homed
                         (record.device >> 11U & 1U) == 0 && std::isfinite(glm::length(record.hip));
    if (!isSound || (hip_ && glm::distance(*hip_, record.hip) > kWay)) {
        forget();
        if (!isSound) return {};
    }
    const glm::dvec3 before = std::exchange(proxy_, record.proxy);
    hip_                    = record.hip;
    if (record.normal != glm::dvec3(0)) {
        side_.reset();
        touched_ = record.normal;
        return {};
    }
    const auto touched = std::exchange(touched_, std::nullopt);
    if (!touched && glm::distance(record.hip, clearOf_) < clearance_) {
        side_.reset();
        return {};
    }
    const Neighbour nearest = object_.index().nearest(record.hip, 1).front();
    const double    reach   = kReach * object_.spacing();
    clearOf_                = record.hip;
    clearance_              = std::max(0.0, nearest.distance - 2 * reach);
    // Where the contact was elsewhere, as at the rim of a thin body, the hand may well be behind this surface.
    if (touched && glm::distance(before, object_.positions()[nearest.point]) < reach)
        side_ = Side{nearest.point, *touched};
    const Plane& plane = planeAt(nearest.point);
    if (!plane.isPlain || nearest.distance > kReach * plane.spacing) {
        side_.reset();
        return {};
    }
    return judge(record, nearest.point);
}

std::optional<std::string> Passage::judge(const TickRecord& record, std::uint32_t nearest)
{
    const Plane& plane  = planes_[nearest];
    const double height = glm::dot(record.hip - object_.positions()[nearest], plane.normal);
    const auto   sideOf = [&](double way) { return Side{nearest, way < 0 ? -plane.normal : plane.normal}; };
    if (side_ && std::abs(glm::dot(side_->outward, plane.normal)) > kSame) {
        ++judged_;
        const double along = glm::dot(side_->outward, plane.normal);
        const double above = along < 0 ? -height : height;
        if (above < -kMargin * plane.spacing) {
            std::ostringstream text;
            text << "at " << record.time << " s: the hand is " << -1e3 * above
                 << " mm behind the surface that it was in front of, and there is no contact";
            return text.str();
        }
        side_ = sideOf(along);
        return {};
    }
    side_.reset();
    if (std::abs(height) > kMargin * plane.spacing) side_ = sideOf(height);
    return {};
}

} // namespace palp::soak
