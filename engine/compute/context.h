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

/// The checks of Khronos' validation layer. Each includes the one before it, except that gpuAssisted omits
/// synchronization. All need the package vulkan-validationlayers.
enum class Validation {
    off,
    core,            ///< wrong use of the interface
    synchronization, ///< also hazards between dispatches, found only where blocks are readonly or writeonly
    gpuAssisted      ///< also accesses beyond the ends of buffers, by instrumented shaders: 9 to 23 times slower
};

/// The purpose for which a processor is opened.
enum class Purpose {
    compute, ///< kernels
    draw,    ///< pictures, by engine/tools/render: a queue that also draws; GPUs first, then software, never the host
    show     ///< pictures in a window
};

/// The limits of a processor.
struct Limits {
    std::size_t   buffer       = 0; ///< [byte] one Buffer
    std::uint32_t invocations  = 0; ///< per workgroup
    std::uint32_t buffers      = 0; ///< per kernel
    std::size_t   sharedMemory = 0; ///< [byte] per workgroup
};

struct ContextSettings {
    std::string              processor  = "auto"; ///< see chooseProcessor()
    Validation               validation = Validation::off;
    double                   patience   = 0; ///< [s] limit of a submission; 0: 10 s, or 300 s for Vulkan in software
    Purpose                  purpose    = Purpose::compute;
    std::vector<std::string> windowExtensions{}; ///< of Vulkan, that windows need on this desktop; with Purpose::show
    Limits                   most{};         ///< what to use of it at most, as if it were a smaller one; 0: all it has
    bool                     float64 = true; ///< false: as if its shaders had no doubles
};

/// A processor that is open for computing, with one queue: one of Vulkan, or the host, whose kernels are functions
/// and whose lists run on the calling thread. Buffers, kernels and command lists are made from a context and must be
/// destroyed before it. It may be moved meanwhile.
/// \thread one at a time, together with everything made from it
class Context {
public:
    /// Opens a processor. Loading drivers takes 30 to 50 ms; the host needs none.
    ///
    /// For computing, "auto" always opens a processor: a GPU that fails is skipped for the next best, and where all of
    /// Vulkan fails the host is taken; note() reports it. With validation "auto" finds a GPU or throws, because the
    /// host has no validation.
    /// \throws UnknownProcessor if no processor has the requested name
    /// \throws ProcessorError if the processor cannot be used, or if validation is requested and is not installed, or
    ///         is requested on the host
    explicit Context(const ContextSettings& settings = {});
    ~Context();
    Context(Context&&) noexcept;
    Context& operator=(Context&&) noexcept;

    /// Submits a finished list and waits until it is done; then its readback buffers may be read.
    ///
    /// A submission that outlasts the patience counts as a hang: drivers reset hardware after about that time, and a
    /// thread that renders forces must not wait for ever. Every later call then throws at once. Memory that the
    /// processor still uses when its owner is destroyed is leaked, not freed.
    /// \throws ProcessorLost if the processor went away, ran out of memory or hangs
    void run(CommandList& list);
    /// Runs several lists, one after the other in a single submission, with no round trip between them.
    void run(std::span<CommandList* const> lists);

    /// Returns the warnings and errors of the validation layer since the last call.
    [[nodiscard]] std::vector<std::string> takeMessages();

    [[nodiscard]] const Processor& processor() const noexcept;

    /// Returns what "auto" found broken and skipped, in a sentence without a full stop; else empty. A machine without a
    /// Vulkan driver, or whose GPUs lack a feature, is not broken: listProcessors() lists those.
    [[nodiscard]] const std::string& note() const noexcept;

    [[nodiscard]] const Limits& limits() const noexcept;

    /// Returns whether results equal those of C++ without contraction, bit for bit: true for the host, and for
    /// lavapipe, whose compiler neither fuses nor re-associates and whose division and square root are correctly
    /// rounded.
    [[nodiscard]] bool bitExact() const noexcept;

    /// Returns the size of all live buffers [byte].
    [[nodiscard]] std::size_t allocatedBytes() const noexcept;

    /// Returns the implementation, see backend.h; for Vulkan it is the VulkanContext of vulkan_handles.h.
    struct Handles;
    [[nodiscard]] Handles& handles() const noexcept { return *handles_; }

private:
    std::unique_ptr<Handles> handles_;
};

/// Returns whether a context has ended while its driver still worked on what never finished. A driver in software works
/// on threads of its own, and crashes if the exit handlers of its libraries run beneath them: a program leaves by
/// std::_Exit() then.
/// \thread any
[[nodiscard]] bool driverLeftAtWork() noexcept;

} // namespace palp::compute
