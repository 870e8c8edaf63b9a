#pragma once
#include <string>

#include <CLI/CLI.hpp>

#include "engine/gpu/device_error.h"
#include "engine/plate/plate_device.h"

namespace palp {

/// The options --device and --tolerance of commands that solve plates.
struct SolverChoice {
    std::string device    = "auto";
    double      tolerance = 1e-4; ///< of the error, relative [1]

    void addTo(CLI::App& command);

    /// Says on standard error why "auto" is not a Vulkan device.
    /// \throws Error for a tolerance out of range, gpu::UnknownDevice for a name that no device has, gpu::DeviceError
    /// for
    ///         a device that cannot be used
    [[nodiscard]] PlateDevice open() const;
};

/// \throws Error that names --tolerance and its bounds
void checkTolerance(double tolerance);

/// A value of --device as PlateDevice spells it: "auto" and "reference" may be given in any case.
[[nodiscard]] std::string deviceWord(const std::string& given);

/// Returns open(); where the device is refused, the sentence adds that --device takes the reference solver too.
template <class Open>
[[nodiscard]] auto orTheReference(const Open& open)
{
    constexpr const char* kToo =
        "\n  or host: the same solver as native code; or reference: sparse Cholesky in double precision";
    try {
        return open();
    } catch (const gpu::UnknownDevice& error) {
        throw gpu::UnknownDevice(std::string(error.what()) + kToo);
    } catch (const gpu::DeviceError& error) {
        throw gpu::DeviceError(std::string(error.what()) + kToo);
    }
}

} // namespace palp
