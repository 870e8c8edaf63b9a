#include "device/falcon/falcon_hold.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace palp {
namespace {

constexpr double kStiffness = 300, kIntegral = 300; ///< [N/m], [N/(m s)] as the calibration's
constexpr double kSettle  = 2;                      ///< [s] from one silence to the next
constexpr double kLongest = 0.5;                    ///< [s] of a silence
constexpr double kFell = 0.1e-3, kEnough = 1.5e-3;  ///< [m] two steps of the encoders; fourteen further ones
constexpr double kFine  = 5e-3; ///< [s] a step of the silence, so that at least three falls lie between these
constexpr double kShare = 0.1, kCoarse = 20e-3; ///< [1], [s] the grip falls by 2 mm in 20 ms, and by 5 until it stops

} // namespace

FalconHold::FalconHold(const glm::dvec3& carries, const glm::dvec3& up) : integral_(carries), up_(up)
{
    falls_.reserve(100);
}

glm::dvec3 FalconHold::step(FalconDevice& device, const HapticState& state, double gain, double dt) noexcept
{
    if (isDone_ || !(dt > 0)) return {};
    if (!isAnchored_) anchor_ = state.position;
    isAnchored_ = true;
    if (isSilent_) {
        waited_ += dt;
        if (waited_ > silence_ && state.sequence != before_.sequence) end(state);
        return integral_;
    }
    const glm::dvec3 away = state.position - anchor_;
    integral_ -= kIntegral * dt * away;
    settled_ = gain >= 1 && state.fault == DeviceFault::none ? settled_ + dt : 0;
    if (settled_ > kSettle) {
        before_   = state;
        isSilent_ = true;
        waited_   = 0;
        device.stopSending(silence_);
    }
    return integral_ - kStiffness * away;
}

/// Takes the first answer after a silence.
void FalconHold::end(const HapticState& state) noexcept
{
    const double fell = glm::dot(before_.position - state.position, up_);
    isSilent_         = false;
    settled_          = 0;
    if (fell > kFell && !isNear_ && step_ > kFine) {
        silence_ -= step_; // the hold ended somewhere within
    } else {
        if (fell > kFell && falls_.size() < falls_.capacity())
            falls_.push_back({state.time - before_.time, std::sqrt(fell)});
        isDone_ = fell > kEnough || silence_ >= kLongest;
    }
    isNear_  = isNear_ || fell > kFell;
    step_    = isNear_ ? kFine : std::clamp(kShare * silence_, kFine, kCoarse);
    silence_ = std::min(kLongest, silence_ + step_);
}

std::optional<double> FalconHold::hold() const noexcept
{
    if (!isDone_ || falls_.size() < 3) return {};
    // The straight line of least squares.
    double silence = 0, root = 0, both = 0, square = 0;
    for (const Fall& fall : falls_) {
        silence += fall.silence / double(falls_.size());
        root += fall.root / double(falls_.size());
    }
    for (const Fall& fall : falls_) {
        both += (fall.silence - silence) * (fall.root - root);
        square += (fall.silence - silence) * (fall.silence - silence);
    }
    if (!(both > 0)) return {};
    return std::max(0.0, silence - root * square / both);
}

} // namespace palp
