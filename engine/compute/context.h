#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/compute/processor_list.h"

namespace palp::compute {

class CommandList;

/// What Khronos' validation layer looks for; each includes the one before it, except that gpuAssisted leaves out
/// synchronization. All need the package vulkan-validationlayers.
enum class Validation {
    off,
    core,            ///< wrong use of the interface
    synchronization, ///< and hazards between dispatches, seen only where blocks are readonly or writeonly
    gpuAssisted      ///< and accesses beyond the ends of buffers, by instrumented shaders: 9 to 23 times slower
};

/// What a device is opened for.
enum class Purpose {
    compute, ///< kernels
    draw,    ///< pictures, by engine/tools/render: a queue that also draws; GPUs first, then software, never the host
    show     ///< the same, in a window
};

struct ContextSettings {
    std::string device     = "auto"; ///< see chooseProcessor()
    Validation  validation = Validation::off;
    double      patience   = 0; ///< [s] how long a submission may take; 0: 10 s, or 300 s for a device in software
    Purpose     purpose    = Purpose::compute;
    std::vector<std::string> windowExtensions{}; ///< of Vulkan, that windows need on this desktop; with Purpose::show
};

/// What the device can hold at most.
struct Limits {
    std::size_t   buffer       = 0; ///< [byte] one Buffer
    std::uint32_t invocations  = 0; ///< per workgroup [1]
    std::size_t   sharedMemory = 0; ///< [byte] per workgroup
};

/// One device, opened for computing, with one queue: Vulkan's, or the host, whose kernels are functions and whose lists
/// run on the calling thread. Buffers, kernels and command lists are made from it and must go
/// before it does; it may be moved meanwhile. \thread one at a time, together with everything made from it
class Context {
public:
    /// Takes 30 to 50 ms where it loads drivers, which it does except for the host.
    ///
    /// "auto" to compute always opens: a GPU that does not is passed over for the next best, and where all of Vulkan
    /// fails there is the host; note() tells. With validation it finds a GPU or throws, as nothing is validated on the
    /// host. \throws UnknownProcessor or ProcessorError if no device fits the settings; ProcessorError also if validation is
    /// asked for
    ///         and not installed, or on the host
    explicit Context(const ContextSettings& settings = {});
    ~Context();
    Context(Context&&) noexcept;
    Context& operator=(Context&&) noexcept;

    /// Submits a finished list and waits until it is done; then its readback buffers may be read.
    ///
    /// A submission that outlasts the patience counts as a hang: drivers reset hardware after about that time, and a
    /// thread that feeds a hand must not wait for ever. Every later call throws at once then. What the device is still
    /// using when its owner goes is leaked, not freed.
    /// \throws ProcessorLost if the device went away, ran out of memory or hangs
    void run(CommandList& list);
    /// As above, one after the other in a single submission: no round trip between them.
    void run(std::span<CommandList* const> lists);

    /// Warnings and errors of the validation layer since the last call.
    [[nodiscard]] std::vector<std::string> takeMessages();

    [[nodiscard]] const Processor& device() const noexcept;

    /// What "auto" found broken and passed over, in a sentence without a full stop; else empty. A machine without a
    /// Vulkan driver, or whose GPUs lack a feature, is not broken: listProcessors() tells of those.
    [[nodiscard]] const std::string& note() const noexcept;

    [[nodiscard]] const Limits& limits() const noexcept;

    /// Whether results equal those of C++ without contraction, bit for bit: true for the host, and for lavapipe, whose
    /// compiler neither fuses nor re-associates and whose division and square root are correctly rounded.
    [[nodiscard]] bool bitExact() const noexcept;

    /// In all buffers that live now [byte].
    [[nodiscard]] std::size_t allocatedBytes() const noexcept;

    /// For the files of engine/compute.
    struct Handles;
    [[nodiscard]] Handles& handles() const noexcept { return *handles_; }

private:
    std::unique_ptr<Handles> handles_;
};

} // namespace palp::compute
