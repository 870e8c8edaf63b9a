#include "device/simulated_arm.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "device/detail/setting_range.h"

namespace palp {
namespace {

constexpr double kPiece = 125e-6; ///< [s] longest piece of the integration: friction turns once per piece
constexpr int    kOrder = 10;     ///< of the Taylor series; the rest is below 1e-12 for a hand of 1e6 N/m

} // namespace

SimulatedArmSettings fallingArm()
{
    SimulatedArmSettings settings;
    settings.weight = {0, -0.21 * 9.81, 0};
    return settings;
}

SimulatedArm::SimulatedArm(const SimulatedArmSettings& settings, const glm::dvec3& position, const glm::dvec3& velocity)
    : settings_(settings), position_(position), velocity_(velocity), velocityFilter_(settings.velocityWindow)
{
    demandRange("simulated arm", "mass", settings.mass, 1e-3, 1e3);
    demandRange("simulated arm", "damping", settings.damping, 0, 1e3);
    demandRange("simulated arm", "friction", settings.friction, 0, 1e3);
    demandRange("simulated arm", "encoderStep", settings.encoderStep, 0, 1e-2);
    demandRange("simulated arm", "velocityWindow", settings.velocityWindow, 0, 1);
    demandRange("simulated arm", "halfWorkspace", settings.halfWorkspace, 1e-3, 1e3);
    demandRange("simulated arm", "boxRadius", settings.boxRadius, 0, 1e3);
    demandRange("simulated arm", "delayTicks", settings.delayTicks, 0, int(kDelays) - 1);
    demandRange("simulated arm", "the size of weight", glm::length(settings.weight), 0, 1e3);
    velocityFilter_.add(time_, encoded());
}

ArmState SimulatedArm::step(const glm::dvec3& force, double period) noexcept
{
    if (!(period > 0) || !std::isfinite(period)) return state();
    const double whole       = force.x + force.y + force.z;
    forces_[tick_ % kDelays] = std::isfinite(whole) ? force : glm::dvec3(0);
    const glm::dvec3 held    = forces_[(tick_ + kDelays - std::size_t(settings_.delayTicks)) % kDelays];
    ++tick_;

    const double pieces = std::ceil(period / kPiece * (1 - 1e-12));
    for (double piece = 0; piece < pieces; ++piece) move(held, period / pieces);
    time_ += period;
    velocityFilter_.add(time_, encoded());
    return state();
}

ArmState SimulatedArm::state() const noexcept
{
    const glm::dvec3 place = encoded();
    return {time_, place, velocityFilter_.velocity(), glm::length(place) <= settings_.boxRadius};
}

glm::dvec3 SimulatedArm::encoded() const noexcept
{
    const double step = settings_.encoderStep;
    return step > 0 ? glm::floor(position_ / step + 0.5) * step : position_;
}

void SimulatedArm::move(const glm::dvec3& force, double dt) noexcept
{
    const double m = settings_.mass, b = settings_.damping + hand_.damping, k = hand_.stiffness;

    // m x'' = push + drag - k x - b x', where the hand pulls towards its own place and velocity. Friction acts against
    // the motion; at rest it balances the force as far as it can.
    const glm::dvec3 push   = force + settings_.weight + k * hand_.target + hand_.damping * hand_.targetVelocity;
    const glm::dvec3 pull   = push - k * position_;
    const bool       rests  = velocity_ == glm::dvec3(0);
    const bool       sticks = rests && glm::length(pull) <= settings_.friction;
    glm::dvec3       drag{};
    if (settings_.friction > 0 && !sticks) drag = -settings_.friction * glm::normalize(rests ? pull : velocity_);

    // The equation gives one derivative of x after the other, each with its power of dt over its factorial.
    const glm::dvec3 before = velocity_;
    if (!sticks) {
        glm::dvec3 lower = position_, upper = velocity_; // the n-th and the next derivative
        glm::dvec3 position = position_, velocity = velocity_;
        double     power = 1; // dt^n / n!
        for (int n = 0; n < kOrder; ++n) {
            glm::dvec3 next = (-b * upper - k * lower) / m;
            if (n == 0) next += (push + drag) / m;
            if (n == 1) next += k * hand_.targetVelocity / m;
            position += upper * (power * dt / (n + 1));
            velocity += next * (power * dt / (n + 1));
            power *= dt / (n + 1);
            lower = upper;
            upper = next;
        }
        position_ = position;
        velocity_ = velocity;
    }
    if (settings_.friction > 0 && glm::dot(before, velocity_) < 0) velocity_ = {}; // it reversed: it came to rest
    hand_.target += hand_.targetVelocity * dt;
    stopAtWalls();
}

void SimulatedArm::stopAtWalls() noexcept
{
    for (int axis = 0; axis < 3; ++axis) {
        const double side = std::copysign(settings_.halfWorkspace, position_[axis]);
        if (std::abs(position_[axis]) <= settings_.halfWorkspace) continue;
        position_[axis] = side;
        if (velocity_[axis] * side > 0) velocity_[axis] = 0;
    }
}

} // namespace palp
