#include "device/falcon/falcon_kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr double kTolerance = 1e-9; ///< [rad] of Newton's method: 1e-10 m, and far above rounding
constexpr int    kSteps = 20; ///< of Newton's method; it takes 9 at most from the middle, 2 to 4 from the last position
constexpr int    kHalvings = 10;    ///< of a step; after these the residual has a minimum here that is not 0
constexpr double kLongest  = 20e-3; ///< [m] of a step; without this limit one start in 6000 leads out of the workspace

/// Bounds below which the Jacobian is not used, because a singularity is near. The measures are 1 for a leg at right
/// angles and for three legs at right angles to each other. In the ball of 40 mm about the middle both are above 0.4 (a
/// test checks this), so forces are never refused there. In the cube about the ball 2 places in 10 000 are refused.
constexpr double kLeastLever  = 0.15; ///< [1] sin t3 sin(t2 - t1), 0 where shin and thigh are in line
constexpr double kLeastVolume = 0.15; ///< [1] of the box that the rows of the Jacobian span, each made a unit vector

void demand(const char* what, double value, double least, double most)
{
    if (!(value >= least && value <= most))
        throw Error("geometry of the Falcon: " + std::string(what) + " must be from " + std::to_string(least) + " to " +
                    std::to_string(most) + ", found " + std::to_string(value));
}

bool isFinite(const glm::dvec3& v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Solves  rows x = right  by Cramer's rule; x is not finite where the rows lie in a plane.
glm::dvec3 solve(const std::array<glm::dvec3, 3>& rows, const std::array<double, 3>& right)
{
    const glm::dvec3 c0 = glm::cross(rows[1], rows[2]), c1 = glm::cross(rows[2], rows[0]),
                     c2 = glm::cross(rows[0], rows[1]);
    return (right[0] * c0 + right[1] * c1 + right[2] * c2) / glm::dot(rows[0], c0);
}

/// Returns the largest difference of the three [rad].
double distance(const std::array<double, 3>& a, const std::array<double, 3>& b)
{
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

} // namespace

double FalconGeometry::countsPerRadian() const noexcept
{
    return countsPerTurn * driveRatio / (2 * std::numbers::pi);
}

FalconKinematics::FalconKinematics(const FalconGeometry& geometry) : geometry_(geometry)
{
    demand("thigh", geometry.thigh, 1e-3, 1);
    demand("shin", geometry.shin, 1e-3, 1);
    demand("joints", geometry.joints, 0, 1);
    demand("gripOut", geometry.gripOut, -1, 1);
    demand("gripSide", geometry.gripSide, -1, 1);
    demand("baseOut", geometry.baseOut, -1, 1);
    demand("baseSide", geometry.baseSide, -1, 1);
    demand("zeroAngle", geometry.zeroAngle, -std::numbers::pi, std::numbers::pi);
    demand("countsPerTurn", geometry.countsPerTurn, 1, 1e6);
    demand("driveRatio", geometry.driveRatio, 0.1, 1e3);
    for (std::size_t i = 0; i < 3; ++i) {
        demand("azimuths", geometry.azimuths[i], -2 * std::numbers::pi, 2 * std::numbers::pi);
        cosAzimuth_[i] = std::cos(geometry.azimuths[i]);
        sinAzimuth_[i] = std::sin(geometry.azimuths[i]);
    }
}

// One leg. Its closure, in the class's words with U = u + gripOut, R^2 = U^2 + w^2:
//
//     cos t3 = (v + gripSide) / shin,
//     U - thigh cos t1 = L cos t2,  w - thigh sin t1 = L sin t2.
//
// Squared and added: U cos t1 + w sin t1 = (R^2 + thigh^2 - L^2) / (2 thigh) = k, so
//
//     t1 = atan2(w, U) - acos(k / R),  t2 = atan2(w - thigh sin t1, U - thigh cos t1),
//
// which is the outer one of the two elbows. As the grip moves by dx, the shin's length does not change. The elbow
// follows along the rods n = (sin t3 cos t2, cos t3, sin t3 sin t2):  n.dx = thigh sin t3 sin(t2 - t1) dt1,  hence
//
//     d t1 / d x = n / (thigh sin t3 sin(t2 - t1)).
std::optional<FalconKinematics::Pose> FalconKinematics::pose(const glm::dvec3& position) const noexcept
{
    const FalconGeometry& g = geometry_;
    Pose                  out;
    double                least = 1; // lever
    double                scale = 1; // product of the lengths of the rows
    for (std::size_t i = 0; i < 3; ++i) {
        const double c = cosAzimuth_[i], s = sinAzimuth_[i];
        const double U = position.x * c + position.y * s - g.baseOut + g.gripOut;
        const double v = -position.x * s + position.y * c - g.baseSide;
        const double w = position.z;

        const double cos3 = (v + g.gripSide) / g.shin;
        if (!(std::abs(cos3) <= 1)) return std::nullopt; // written so that NaN is refused too
        const double sin3 = std::sqrt((1 - cos3) * (1 + cos3));
        const double L = g.joints + g.shin * sin3, R = std::hypot(U, w);
        const double k = (R * R + g.thigh * g.thigh - L * L) / (2 * g.thigh);
        if (!(std::abs(k) <= R && std::isfinite(k)) || R == 0) return std::nullopt;

        const double t1    = std::atan2(w, U) - std::acos(k / R);
        const double t2    = std::atan2(w - g.thigh * std::sin(t1), U - g.thigh * std::cos(t1));
        const double lever = sin3 * std::sin(t2 - t1);

        const double nu = sin3 * std::cos(t2), nv = cos3, nw = sin3 * std::sin(t2);
        out.angles[i] = t1;
        out.rows[i]   = glm::dvec3(c * nu - s * nv, s * nu + c * nv, nw) / (g.thigh * lever);
        scale *= glm::length(out.rows[i]);
        least = std::min(least, std::abs(lever));
    }
    const double volume = std::abs(glm::dot(out.rows[0], glm::cross(out.rows[1], out.rows[2]))) / scale;
    out.regular         = least >= kLeastLever && volume >= kLeastVolume;
    return out;
}

std::optional<std::array<double, 3>> FalconKinematics::angles(const glm::dvec3& position) const noexcept
{
    const std::optional<Pose> legs = pose(position);
    if (!legs) return std::nullopt;
    return legs->angles;
}

// Newton's method on angles(x) - angles = 0. A step is cut to kLongest, then halved while it leads out of reach or not
// nearer.
std::optional<glm::dvec3> FalconKinematics::position(const std::array<double, 3>& angles,
                                                     const glm::dvec3&            start) const noexcept
{
    glm::dvec3          at   = start;
    std::optional<Pose> legs = pose(at);
    if (!legs) legs = pose(at = kMiddle);
    if (!legs) return std::nullopt;

    double error = distance(angles, legs->angles);
    for (int n = 0; n < kSteps && error > kTolerance; ++n) {
        glm::dvec3 step =
            solve(legs->rows, {angles[0] - legs->angles[0], angles[1] - legs->angles[1], angles[2] - legs->angles[2]});
        if (!isFinite(step)) return std::nullopt;
        step *= std::min(1.0, kLongest / glm::length(step));

        std::optional<Pose> next;
        double              nextError = error;
        for (int half = 0; half <= kHalvings; ++half, step *= 0.5) {
            next = pose(at + step);
            if (next) nextError = distance(angles, next->angles);
            if (next && nextError < error) break;
        }
        if (!next || !(nextError < error)) return std::nullopt;
        at += step;
        legs  = next;
        error = nextError;
    }
    if (!(error <= kTolerance)) return std::nullopt;
    return at;
}

std::optional<std::array<glm::dvec3, 3>> FalconKinematics::jacobian(const glm::dvec3& position) const noexcept
{
    const std::optional<Pose> legs = pose(position);
    if (!legs || !legs->regular) return std::nullopt;
    return legs->rows;
}

// The work of the torques is that of the force: torque . rows dx = force . dx for every dx. So the force is the sum of
// the rows, each times its torque; and by Cramer's rule each torque is the force against the cross product of the other
// two rows, over the volume of the three.
std::optional<std::array<double, 3>> FalconKinematics::torques(const glm::dvec3& position,
                                                               const glm::dvec3& force) const noexcept
{
    const std::optional<std::array<glm::dvec3, 3>> rows = jacobian(position);
    if (!rows || !isFinite(force)) return std::nullopt;
    const glm::dvec3 c0 = glm::cross((*rows)[1], (*rows)[2]), c1 = glm::cross((*rows)[2], (*rows)[0]),
                     c2 = glm::cross((*rows)[0], (*rows)[1]);
    const double volume = glm::dot((*rows)[0], c0);
    return std::array<double, 3>{glm::dot(force, c0) / volume, glm::dot(force, c1) / volume,
                                 glm::dot(force, c2) / volume};
}

std::optional<glm::dvec3> FalconKinematics::force(const glm::dvec3&            position,
                                                  const std::array<double, 3>& torques) const noexcept
{
    const std::optional<std::array<glm::dvec3, 3>> rows = jacobian(position);
    if (!rows) return std::nullopt;
    return (*rows)[0] * torques[0] + (*rows)[1] * torques[1] + (*rows)[2] * torques[2];
}

std::array<double, 3> FalconKinematics::angles(const std::array<std::int16_t, 3>& counts) const noexcept
{
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = geometry_.zeroAngle + counts[i] / geometry_.countsPerRadian();
    return out;
}

std::array<double, 3> FalconKinematics::counts(const std::array<double, 3>& angles) const noexcept
{
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = (angles[i] - geometry_.zeroAngle) * geometry_.countsPerRadian();
    return out;
}

} // namespace palp
