#pragma once
#include <array>

#include <glm/vec3.hpp>

#include "engine/force/compliance_tracker.h"

namespace palp {

/// The centre of the next patch window and the reach of its table, so that it fits the hand when it arrives.

/// The velocity of a moving point over its last 10 ms: long enough to average an encoder's steps (a step of 60 µm in
/// 10 ms is 6 mm/s), short enough to follow a stroking hand.
/// \thread one at a time; no allocation
class RecentMotion {
public:
    static constexpr double kSpan = 10e-3; ///< [s]

    void add(double time, const glm::dvec3& position) noexcept; ///< [s], [m]; a time that does not advance is omitted

    /// Returns the velocity [m/s] from the oldest position of the last kSpan to the newest; zero with fewer than two.
    [[nodiscard]] glm::dvec3 velocity() const noexcept;

private:
    struct TimedPosition {
        double     time = 0;
        glm::dvec3 position{};
    };
    static constexpr std::size_t kMost = 32; // at 1 kHz three times the span; if faster, the span shrinks

    std::array<TimedPosition, kMost> past_{}; // a ring
    std::size_t                      newest_ = 0;
    std::size_t                      count_  = 0;
};

/// Returns the centre of the next patch window [m]: contact + lead velocity. For the laws that hold one number: the
/// contact.
/// \param lead  [s] from the contact to the middle of the time during which the table will be in use: the time that a
///              solve takes, and half a period of the deformation thread
[[nodiscard]] glm::dvec3 aheadOf(ComplianceLaw law, const glm::dvec3& contact, const glm::dvec3& velocity,
                                 double lead) noexcept;

/// Returns the number of entries along each axis of a table that covers what a hand can do before the next one
/// arrives: 1 for the laws that hold one number, else 3, 5 or 7.
///
/// The reach must be v T/2 + a (2T)^2/2 for a hand of 0.2 m/s and 3 m/s^2: 3.3 mm at 60 Hz, 10 mm at 30 Hz.
/// \param period   of the deformation thread [s]
/// \param spacing  of the table, the radius of the footprint [m]
/// \source our own prototype of hands that slide and stroke at up to 0.2 m/s
[[nodiscard]] int tableSide(ComplianceLaw law, double period, double spacing) noexcept;

} // namespace palp
