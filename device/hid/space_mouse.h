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
    double  deadZone = 0.06; ///< [1] of full deflection, per axis, because caps rest within a few counts of zero
    double  reach    = 0.05; ///< [m] radius of the sphere that the point stays in
    double  stale    = 0.5;  ///< [s] for which a deflection is believed; held ones are reported every 8 to 16 ms
    HidPace pace     = HidPace::thread;
};

/// Push and turn of the cap, -1 to 1, in the device's frame: x right, y up, z towards the user.
struct SpaceMouseAxes {
    glm::dvec3    push{};      ///< [1]
    glm::dvec3    turn{};      ///< [1] right-handed about these axes
    std::uint32_t buttons = 0; ///< as HapticState::buttons
};

/// A SpaceMouse as a device without force: the deflection of its cap is the speed of a point. It senses no position, so
/// it is always homed and in its box. Its six axes also serve a camera.
/// \thread see HapticDevice; axes() on one more thread
class SpaceMouse : public HapticDevice {
public:
    /// \param system   must outlive this object
    /// \param listing  one that spaceMouseModel() knows
    /// \throws Error naming a setting out of its range, or a device that is not a SpaceMouse
    SpaceMouse(HidSystem& system, const HidListing& listing, const SpaceMouseSettings& settings = {});
    ~SpaceMouse() override;

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void        open() override;
    void        close() noexcept override;
    HapticState read(double now) noexcept override;
    void        render(const GovernedForce& /*force*/) noexcept override {}          ///< moves nothing
    void        light(std::uint8_t lights) noexcept override { lit_ = lights != 0; } ///< its ring, which has one colour

    /// Returns the axes as of the newest read(), without the dead zone; for a camera.
    [[nodiscard]] SpaceMouseAxes axes() noexcept;

private:
    struct Reported {
        SpaceMouseCounts counts;
        std::uint64_t    reports = 0; ///< reports that were understood
        bool             lost    = false;
    };

    bool readAndWrite(double wait) noexcept;
    void move(const SpaceMouseAxes& axes, double now) noexcept;

    HidSystem&               system_;
    HidListing               listing_;
    SpaceMouseSettings       settings_;
    HapticDeviceInfo         info_;
    std::unique_ptr<HidPort> port_;          ///< used by the thread while there is one
    Reported                 seen_;          ///< likewise
    bool                     isLit_ = false; ///< likewise; the state last written
    std::atomic<bool>        lit_{false};
    Latest<Reported>         inbox_;
    Latest<SpaceMouseAxes>   camera_;
    HapticState              state_;
    std::uint64_t            lastReports_ = 0;
    double                   lastReport_  = 0; ///< [s] by the clock of read()
    std::jthread             thread_;          ///< last member: it ends before what it uses
};

} // namespace palp
