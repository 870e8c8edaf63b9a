#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "engine/compute/context.h"
#include "engine/compute/host_dispatch.h"

namespace palp::compute {

/// A compiled shader and its interface. Its arrays live as long as the program, see palp_shader() in
/// compute_shaders/CMakeLists.txt.
struct KernelCode {
    const char*                    name = "";
    std::span<const std::uint32_t> spirv;               ///< none if only the host has it
    int                            buffers   = 0;       ///< storage buffers at bindings 0 .. buffers-1 of set 0
    int                            pushBytes = 0;       ///< [byte] size of the push constants, at most 128
    HostKernel                     host      = nullptr; ///< the same for the host, if there is one
};

/// A shader with its constants fixed, ready to be dispatched. Drivers compile it at construction, lavapipe at its first
/// dispatch (20 to 150 ms, less than 3 ms when the driver remembers it), so a kernel should run once before it is
/// timed.
class Kernel {
public:
    /// \param workgroup  becomes specialization constants 0, 1 and 2: layout(local_size_x_id = 0, ...) in the shader
    /// \param constants  specialization constants 3, 4, ... as 32-bit words; floats by std::bit_cast
    /// \throws Error if the processor does not allow what the kernel needs
    Kernel(Context& context, const KernelCode& code, Workgroup workgroup,
           std::span<const std::uint32_t> constants = {});
    ~Kernel();
    Kernel(Kernel&&) noexcept;
    Kernel& operator=(Kernel&&) noexcept;

    /// Returns the groups that cover this number of invocations, rounded up.
    [[nodiscard]] Groups groupsOver(std::uint32_t nx, std::uint32_t ny = 1, std::uint32_t nz = 1) const noexcept;

    [[nodiscard]] const KernelCode& code() const noexcept;
    [[nodiscard]] Workgroup         workgroup() const noexcept;

    /// Returns the implementation, for the files of engine/compute.
    struct Handles;
    [[nodiscard]] const Handles& handles() const noexcept { return *handles_; }

private:
    std::unique_ptr<Handles> handles_;
};

} // namespace palp::compute
