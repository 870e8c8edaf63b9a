#pragma once
#include <cstdint>

#include <glm/vec3.hpp>

#include "device/device_record.h"
#include "device/haptic_device.h"
#include "engine/core/latest.h"

namespace palp {

/// Settings of the pointer of a window.
extern const DeviceRecord kMouseRecord;

struct MouseDeviceSettings {
    double     settle = 20e-3; ///< [s] time constant of the spring to the target; a display shows a picture every 16 ms
    glm::dvec3 rest{};         ///< [m] to which the point returns when it is released
    double     reach = 0.05;   ///< [m] radius of the sphere that the point stays in
};

/// A pointer in a window as a device: a point on a critically damped spring to the window's target. The target moves
/// once per picture, the point smoothly and, for any tick, exactly along the solution of x'' = -(x - target)/s² - 2
/// x'/s. Forces move nothing.
/// \thread see HapticDevice; target() and release() on one more thread, the window's
class MouseDevice : public HapticDevice {
public:
    /// \throws Error naming a setting out of its range
    explicit MouseDevice(const MouseDeviceSettings& settings = {});

    [[nodiscard]] const HapticDeviceInfo& info() const noexcept override { return info_; }

    void        open() override;
    void        close() noexcept override;
    HapticState read(double now) noexcept override;
    void        render(const GovernedForce& force) noexcept override;

    /// Sets, for the window, where the point is pulled from now on and which buttons are down. Wait-free.
    /// \param point  [m] in the device's frame, limited to the reach; one that is not finite is omitted
    void target(const glm::dvec3& point, std::uint32_t buttons = 0) noexcept;

    /// Lets the point return to its rest, for the window, with all buttons up. Wait-free.
    void release() noexcept { target(settings_.rest); }

private:
    struct Target {
        glm::dvec3    point{};     ///< [m]
        std::uint32_t buttons = 0; ///< as HapticState::buttons
    };

    MouseDeviceSettings settings_;
    HapticDeviceInfo    info_;
    HapticState         state_;
    bool                badForce_ = false; ///< of the last render()
    Latest<Target>      target_;
};

} // namespace palp
