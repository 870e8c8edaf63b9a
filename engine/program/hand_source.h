#pragma once
#include <memory>
#include <optional>
#include <string>

#include "engine/session/hand_path.h"
#include "engine/session/session_parts.h"

namespace palp {

/// What the command line says about the hand.
struct HandOptions {
    std::string hand  = "scan"; ///< press, circle, scan, or a file
    std::string speed = "50 mm/s", depth, reach = "10 mm";
    std::string grip; ///< stiffness of the hand that holds the simulated arm; empty: the hand is not moved by forces
    double      seconds = 5; ///< [s]
};

/// A hand that is ready: its device is open.
struct HandSource {
    std::unique_ptr<const HandPath> path; ///< of a script or a file; null of a device that somebody holds
    std::unique_ptr<HapticDevice>   device;
    DeviceFrame                     frame;
};

/// \throws Error naming the option, the file, or why the device cannot be used
[[nodiscard]] HandSource handFor(const HandOptions& options, const Scene& scene, const PointCloud& cloud,
                                 const NeighbourIndex& index);

} // namespace palp
