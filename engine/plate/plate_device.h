#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "engine/plate/plate.h"

namespace palp {

/// Where plates are solved: on a Vulkan device, or on the host by the reference solver.
///
/// Keeps the solver of the last plate: another rigidity on the same grid, edges and foundation costs no new memory.
/// \thread one at a time
class PlateDevice {
public:
    /// Opens the device: 40 ms for lavapipe, and its kernels are compiled at their first use, once per machine.
    /// \param wanted  "reference"; "host"; else as gpu::chooseDevice() has it: "auto", "lavapipe", an INDEX or part of a
    ///                NAME.
    ///                Where "auto" finds no usable device it takes the reference, and name() says so
    /// \throws gpu::DeviceError if a device that is asked for by name cannot be used
    /// \param patience  see gpu::ContextSettings [s]
    explicit PlateDevice(std::string_view wanted = "auto", double patience = 0);
    ~PlateDevice();
    PlateDevice(PlateDevice&&) noexcept;
    PlateDevice& operator=(PlateDevice&&) noexcept;

    [[nodiscard]] const std::string& name() const noexcept; ///< of the Vulkan device, or "reference"
    [[nodiscard]] const std::string&
    note() const noexcept; ///< why "auto" is the reference, or what went wrong; or empty

    /// Deflection under forces at the nodes [N]; see VulkanPlateSolver and ReferencePlateSolver for the report.
    ///
    /// If the Vulkan device is lost or runs out of memory, this and all later plates are solved by the reference; if it
    /// does not reach the tolerance, this one is, up to 513 x 513 nodes. note() says so. See report.converged.
    /// \param tolerance  of the error estimate, relative [1]; the reference solver is as accurate as doubles allow
    /// \throws Error if the plate, the load or the tolerance are not acceptable
    [[nodiscard]] PlateSolution solve(const Plate& plate, const NodeField& nodalForce, double tolerance = 1e-4);

private:
    struct Vulkan;
    std::unique_ptr<Vulkan> vulkan_; ///< empty: the reference
    std::string             name_ = "reference";
    std::string             note_;
};

} // namespace palp
