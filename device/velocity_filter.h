#pragma once
#include <array>
#include <cstddef>

#include <glm/vec3.hpp>

namespace palp {

/// Filters the velocity of a position that comes in encoder steps: the difference over some time, as in drivers of
/// haptic devices (CHAI3D 15 ms, the Force Dimension SDK 20 ms). At 1 kHz one step of 48 um is 0.05 m/s between two
/// positions, and 0.003 m/s over 15 ms.
/// \thread one; allocates nothing
class VelocityFilter {
public:
    /// \param window  [s]; shorter if 128 positions cover less time
    explicit VelocityFilter(double window) noexcept : window_(window) {}

    /// Forgets all positions, so that a jump of the position gives no velocity.
    void restart() noexcept { count_ = 0; }

    /// Adds a position.
    /// \param time  [s] above the last one; otherwise the position replaces the last
    void add(double time, const glm::dvec3& position) noexcept
    {
        if (count_ == 0 || time > past_[newest_].time) {
            newest_ = (newest_ + 1) % kPast;
            count_  = count_ < kPast ? count_ + 1 : kPast;
        }
        past_[newest_] = {time, position};
    }

    /// Returns the velocity [m/s] since the first position that is a window old, or the oldest; zero if there is only
    /// one.
    [[nodiscard]] glm::dvec3 velocity() const noexcept
    {
        if (count_ < 2) return {};
        const TimedPosition& now  = past_[newest_];
        std::size_t          back = 1;
        while (back + 1 < count_ && now.time - before(back).time < window_ * (1 - 1e-9)) ++back;
        return (now.position - before(back).position) / (now.time - before(back).time);
    }

private:
    static constexpr std::size_t kPast = 128; ///< size of the ring of positions

    struct TimedPosition {
        double     time = 0;   ///< [s]
        glm::dvec3 position{}; ///< [m]
    };

    [[nodiscard]] const TimedPosition& before(std::size_t back) const noexcept
    {
        return past_[(newest_ + kPast - back) % kPast];
    }

    double                           window_; ///< [s]
    std::array<TimedPosition, kPast> past_{};
    std::size_t                      newest_ = 0;
    std::size_t                      count_  = 0;
};

} // namespace palp
