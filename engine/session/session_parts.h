#pragma once
#include "device/haptic_device.h"
#include "engine/session/deformation.h"
#include "engine/session/scene.h"
#include "engine/session/session_sample.h"

namespace palp {

/// Where a device's frame lies in the scene.
struct DeviceFrame {
    glm::dvec3 origin{};                    ///< [m] of the scene: where the middle of the workspace is
    glm::dquat sceneFromDevice{1, 0, 0, 0}; ///< rotation, a unit quaternion

    /// The hand of this state, in the scene.
    [[nodiscard]] Hand handOf(const HapticState& state) const noexcept
    {
        return {origin + sceneFromDevice * state.position,
                sceneFromDevice * state.velocity,
                state.homed,
                state.inBox,
                state.missed,
                state.fault};
    }

    /// A force of the scene, as the device takes it.
    [[nodiscard]] GovernedForce toDevice(const GovernedForce& force) const noexcept
    {
        return force.rotated(glm::conjugate(sceneFromDevice));
    }
};

/// What every session is made of, on whichever clock. All of it outlives the session.
struct SessionParts {
    const Scene&          scene;
    const PointCloud&     cloud;
    const NeighbourIndex& index;  ///< of the cloud
    PatchSolver           solver; ///< Deformation::solver() of the same scene and cloud
    HapticDevice&         device; ///< open
    DeviceFrame           frame{};
};

} // namespace palp
