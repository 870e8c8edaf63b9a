#pragma once
#include <optional>

#include "device/haptic_device.h"
#include "engine/session/deformation.h"
#include "engine/session/scene.h"
#include "engine/session/tick_record.h"

namespace palp {

/// The place of a device's frame in the scene. Lengths are scaled, forces are not.
struct DeviceFrame {
    glm::dvec3    origin{};                    ///< [m] of the scene: place of the middle of the workspace
    glm::dquat    sceneFromDevice{1, 0, 0, 0}; ///< rotation, a unit quaternion
    double        scale  = 1;                  ///< [1] metres of the scene per metre of the device
    std::uint32_t clutch = 0;                  ///< bit of the device's button that is its clutch, see Clutch; 0: none

    /// Converts the hand of this state into the scene. No part of the orientation is a negative zero, so that a replay,
    /// whose frame is the scene's, gives the same bits.
    [[nodiscard]] Hand handOf(const HapticState& state) const noexcept
    {
        return {origin + sceneFromDevice * (scale * state.position),
                sceneFromDevice * (scale * state.velocity),
                state.homed,
                state.inBox,
                state.missed,
                state.fault,
                state.buttons & 0xFFFFU,
                state.time,
                state.age,
                state.sequence,
                sceneFromDevice * state.orientation + glm::dquat(0, 0, 0, 0),
                state.gripperAngle};
    }

    /// Converts a place of the scene into the device's frame [m].
    [[nodiscard]] glm::dvec3 toDevice(const glm::dvec3& place) const noexcept
    {
        return glm::conjugate(sceneFromDevice) * (place - origin) / scale;
    }

    /// Returns what a device states, its weight turned into the scene's frame.
    [[nodiscard]] HapticDeviceInfo inScene(HapticDeviceInfo info) const
    {
        info.weight = sceneFromDevice * info.weight;
        return info;
    }

    /// Turns a force of the scene into the device's frame.
    [[nodiscard]] GovernedForce toDevice(const GovernedForce& force) const noexcept
    {
        return force.rotated(glm::conjugate(sceneFromDevice));
    }
};

/// Puts a device on a table before the object: its origin at `origin`, its y along `outward`, its x along the scene's x
/// as far as the surface lets it.
[[nodiscard]] DeviceFrame deviceFrame(const glm::dvec3& origin, const glm::dvec3& outward);

/// Everything that a session needs, on either clock. All of it outlives the session.
struct SessionParts {
    const Scene&          scene;
    const SoftObject&     object; ///< of the scene
    PatchSolver           solver; ///< Deformation::solver() of the same scene and object
    HapticDevice&         device; ///< open
    DeviceFrame           frame{};
    const HomogeneousLaw* first = nullptr; ///< Deformation::firstLaw(); null: no force before the first table

    std::optional<glm::dvec3> from{}; ///< [m] where the hand has come from, see ContactHalf
};

} // namespace palp
