#pragma once
#include <array>
#include <limits>

#include "device/haptic_device.h"
#include "engine/core/enum_names.h"
#include "tests/soak/chance.h"

namespace palp::soak {

/// What goes wrong between a device and the servo.
enum class DeviceTrouble {
    none,
    lost,       ///< no answers: the state stays as it was
    notANumber, ///< in position or velocity
    endless,    ///< infinite or huge
    jump,       ///< the position is another one, up to 0.1 m away
    fast,       ///< the velocity is a hundred times as high
    flagged,    ///< any fault of the device
    outOfBox,   ///< the grip is out of its workspace
    notHomed,   ///< the position is unknown
    wrongTime,  ///< the answer's time or age makes no sense
    buttons,    ///< any buttons are down
    clutched,   ///< its own clutch
    count
};
inline constexpr std::array kDeviceTroubles{"none",      "lost",       "not a number", "endless",
                                            "jump",      "fast",       "flagged",      "out of box",
                                            "not homed", "wrong time", "buttons",      "clutched"};
static_assert(kDeviceTroubles.size() == std::size_t(DeviceTrouble::count));

/// A device that fails at random: another one behind faults that last for some ticks.
class FaultyDevice {
public:
    /// \param rate  troubles per tick [1]
    /// \param inner outlives this
    FaultyDevice(HapticDevice& inner, double rate, std::uint64_t seed) : inner_(inner), rate_(rate), chance_(seed) {}

    /// Reads the state as the servo gets it.
    /// \param now      [s] of the device's own clock, which never jumps
    /// \param skipped  [s] by which the servo's clock is ahead of it
    HapticState read(double now, double skipped) noexcept
    {
        if (left_ == 0 && chance_.is(rate_)) begin();
        HapticState state = inner_.read(now);
        state.time += skipped;
        if (left_ > 0) {
            --left_;
            spoil(state);
        } else {
            last_ = state;
        }
        if (pressed_ > 0) {
            --pressed_;
            state.buttons |= 1U;
        }
        return state;
    }

    /// The operator presses the first button for some ticks.
    void press(int ticks) noexcept { pressed_ = ticks; }

    [[nodiscard]] std::uint64_t troubles() const noexcept { return troubles_; } ///< so far

private:
    void begin() noexcept
    {
        trouble_ = DeviceTrouble(1 + chance_.below(int(DeviceTrouble::count) - 1));
        left_    = int(chance_.scaleFrom(1, 400));
        way_     = {chance_.from(-0.06, 0.06), chance_.from(-0.06, 0.06), chance_.from(-0.06, 0.06)};
        pick_    = chance_.below(12);
        ++troubles_;
    }

    void spoil(HapticState& state) noexcept
    {
        constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
        constexpr double kEndless = std::numeric_limits<double>::infinity();
        switch (trouble_) {
        case DeviceTrouble::lost:
            ++last_.missed;
            state = last_;
            if (state.missed > 20) state.fault = DeviceFault::silent;
            break;
        case DeviceTrouble::notANumber:
            (pick_ % 2 ? state.position : state.velocity)[pick_ / 2 % 3] = kNothing;
            break;
        case DeviceTrouble::endless:
            (pick_ % 2 ? state.position : state.velocity)[pick_ / 2 % 3] = pick_ < 6 ? kEndless : -1e300;
            break;
        case DeviceTrouble::jump:
            state.position += way_;
            break;
        case DeviceTrouble::fast:
            state.velocity *= 100;
            break;
        case DeviceTrouble::flagged:
            state.fault = DeviceFault(pick_);
            break;
        case DeviceTrouble::outOfBox:
            state.inBox = false;
            break;
        case DeviceTrouble::notHomed:
            state.homed = false;
            break;
        case DeviceTrouble::wrongTime:
            (pick_ % 2 ? state.time : state.age) = pick_ < 4 ? kNothing : pick_ < 8 ? -1e6 : 1e6;
            break;
        case DeviceTrouble::buttons:
            state.buttons = std::uint32_t(chance_.bits());
            break;
        case DeviceTrouble::clutched:
            state.clutched = true;
            break;
        default:
            break;
        }
    }

    HapticDevice& inner_;
    double        rate_;
    Chance        chance_;
    DeviceTrouble trouble_ = DeviceTrouble::none;
    int           left_    = 0; ///< ticks of the trouble
    int           pick_    = 0; ///< which of its variants
    int           pressed_ = 0; ///< ticks
    glm::dvec3    way_{};       ///< [m]
    HapticState   last_{};      ///< the last good one
    std::uint64_t troubles_ = 0;
};

} // namespace palp::soak
