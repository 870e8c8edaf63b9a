#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include <glm/vec3.hpp>

#include "device/haptic_device.h"
#include "device/hid/hid_port.h"
#include "device/hid/space_mouse_report.h"
#include "engine/core/latest.h"

namespace palp {

struct SpaceMouseSettings {
    double  speed = 0.1; ///< [m/s] at full deflection: from the middle to the edge of a Falcon's reach in half a second
    double  deadZone = 0.06; ///< [1] of full deflection, per axis: caps rest within a few counts of zero
    double  reach    = 0.05; ///< [m] radius of the sphere that the point stays in
    double  stale    = 0.5;  ///< [s] a deflection is believed for so long; held ones are reported every 8 to 16 ms
    HidPace pace     = HidPace::thread;
};

/// How far the cap is pushed and turned, -1 to 1, in the device's frame: x right, y up, z towards the user.
struct SpaceMouseAxes {
    glm::dvec3    push{};      ///< [1]
    glm::dvec3    turn{};      ///< [1] about these axes, by the right hand
    std::uint32_t buttons = 0; ///< as HapticState::buttons
};

/// A SpaceMouse as a hand without force: the deflection of its cap is the speed of a point. It senses no place, so it
/// is always homed and in its box. Its six axes serve a camera too.
/// \thread see HapticDevice; axes() on one more
class SpaceMouse : public HapticDevice {
public:
    /// \param system   outlives it
    /// \param listing  one that spaceMouseModel() knows
    /// \throws Error naming a setting out of its range, or a device that is none
    SpaceMouse(HidSystem& system, const HidListing& listing, const SpaceMouseSettings& settings = {});
    ~SpaceMouse() override;

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void        open() override;
    void        close() noexcept override;
    HapticState exchange(const GovernedForce& force, double now) noexcept override;
    void        light(std::uint8_t lights) noexcept override { lit_ = lights != 0; } ///< its ring, of one colour

    /// As of the newest exchange(), without the dead zone; for a camera.
    [[nodiscard]] SpaceMouseAxes axes() noexcept;

private:
    struct Reported {
        SpaceMouseCounts counts;
        std::uint64_t    reports = 0; ///< that were understood
        bool             lost    = false;
    };

    bool readAndWrite(double wait) noexcept;
    void move(const SpaceMouseAxes& axes, double now) noexcept;

    HidSystem&               system_;
    HidListing               listing_;
    SpaceMouseSettings       settings_;
    HapticDeviceInfo         info_;
    std::unique_ptr<HidPort> port_;          ///< the thread's while there is one
    Reported                 seen_;          ///< likewise
    bool                     isLit_ = false; ///< likewise: what was last written
    std::atomic<bool>        lit_{false};
    Latest<Reported>         inbox_;
    Latest<SpaceMouseAxes>   camera_;
    HapticState              state_;
    std::uint64_t            lastReports_ = 0;
    double                   lastReport_  = 0; ///< [s] by the clock of exchange()
    std::jthread             thread_;          ///< last: it ends before what it uses
};

} // namespace palp
