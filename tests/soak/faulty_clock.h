#pragma once
#include <limits>

#include "tests/soak/chance.h"

namespace palp::soak {

/// The servo's clock: a millisecond a tick, but for ticks that are late, early, stand still, stall or are no number.
class FaultyClock {
public:
    /// \param rate  troubles per tick [1]
    FaultyClock(double rate, std::uint64_t seed) : rate_(rate), chance_(seed) {}

    /// Goes on to the next tick and returns the time since the last one, as the servo is told [s].
    double step() noexcept
    {
        double dt = kTick;
        if (chance_.is(rate_)) {
            ++troubles_;
            switch (chance_.below(12)) {
            case 0:
                dt = 0;
                break;
            case 1:
                dt = -kTick;
                break;
            case 2:
                dt = std::numeric_limits<double>::quiet_NaN();
                break;
            case 3:
                dt = std::numeric_limits<double>::infinity();
                break;
            case 4:
                dt = 3600; // the machine was suspended
                break;
            case 5:
                dt = 0.15;
                break;
            default:
                dt = chance_.scaleFrom(1e-5, 0.09);
                break;
            }
        }
        if (dt > 0 && dt < kForever) time_ += dt;
        device_ += kTick;
        return dt;
    }

    [[nodiscard]] double        time() const noexcept { return time_; }     ///< [s] of the servo
    [[nodiscard]] double        device() const noexcept { return device_; } ///< [s] of the device, which never jumps
    [[nodiscard]] double        skipped() const noexcept { return time_ - device_; } ///< [s] between the two
    [[nodiscard]] std::uint64_t troubles() const noexcept { return troubles_; }

private:
    static constexpr double kTick = 1e-3, kForever = 1e6; // [s]

    double        rate_;
    Chance        chance_;
    double        time_ = 0, device_ = 0; ///< [s]
    std::uint64_t troubles_ = 0;
};

} // namespace palp::soak
