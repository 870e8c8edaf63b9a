#include "device/falcon/falcon_motors.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "device/detail/setting_range.h"

namespace palp {

FalconMotors::FalconMotors(const FalconKinematics& kinematics, double countsPerTorque)
    : kinematics_(kinematics), countsPerTorque_(countsPerTorque)
{
    demandCountsPerTorque(countsPerTorque);
}

void FalconMotors::demandCountsPerTorque(double countsPerTorque)
{
    demandRange("motors of the Falcon", "countsPerTorque", countsPerTorque, kLeastCountsPerTorque,
                kMostCountsPerTorque);
}

void FalconMotors::setCountsPerTorque(double countsPerTorque) noexcept
{
    countsPerTorque_ = std::clamp(countsPerTorque, kLeastCountsPerTorque, kMostCountsPerTorque);
}

FalconDrive FalconMotors::drive(const glm::dvec3& position, const glm::dvec3& force) const noexcept
{
    FalconDrive out;
    out.badForce = !(std::isfinite(force.x) && std::isfinite(force.y) && std::isfinite(force.z));
    if (out.badForce) return out;
    const std::optional<std::array<double, 3>> torques = kinematics_.torques(position, force);
    out.singular                                       = !torques;
    if (out.singular) return out;

    const double largest =
        countsPerTorque_ * std::max({std::abs((*torques)[0]), std::abs((*torques)[1]), std::abs((*torques)[2])});
    out.badForce = !std::isfinite(largest); // also catches overflow of finite forces such as 1e308 N
    if (out.badForce) return out;
    out.scale = largest > kMost ? kMost / largest : 1;

    for (std::size_t i = 0; i < 3; ++i) {
        const double count = std::round(-countsPerTorque_ * out.scale * (*torques)[i]);
        out.motors[i] = std::int16_t(std::clamp(count, -double(kMost), double(kMost))); // the last line before the wire
    }
    return out;
}

std::array<double, 3> FalconMotors::torques(const std::array<std::int16_t, 3>& motors) const noexcept
{
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = -motors[i] / countsPerTorque_;
    return out;
}

} // namespace palp
