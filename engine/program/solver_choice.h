#pragma once
#include <string>

#include <CLI/CLI.hpp>

#include "engine/plate/plate_device.h"

namespace palp {

/// The options --device and --tolerance of commands that solve plates.
struct SolverChoice {
    std::string device    = "auto";
    double      tolerance = 1e-4; ///< of the error, relative [1]

    void addTo(CLI::App& command);

    /// Says on standard error why "auto" is not a Vulkan device.
    /// \throws Error for a tolerance out of range, gpu::DeviceError for a device that cannot be used
    [[nodiscard]] PlateDevice open() const;
};

} // namespace palp
