#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/compute/command_list.h"

// The implementations behind the public classes of engine/compute, for each kind of processor: Vulkan in vulkan_*.cpp,
// this machine's own in host_*.cpp.

namespace palp::compute {

struct Context::Handles {
    Handles()                          = default;
    virtual ~Handles()                 = default;
    Handles(const Handles&)            = delete;
    Handles& operator=(const Handles&) = delete;

    // Arguments have been checked against the conditions of the classes' headers, but not against the processor.
    virtual std::unique_ptr<Buffer::Handles>      makeBuffer(std::string name, std::size_t bytes, Intent intent) = 0;
    virtual std::unique_ptr<Kernel::Handles>      makeKernel(const KernelCode& code, Workgroup workgroup,
                                                             std::span<const std::uint32_t> constants)           = 0;
    virtual std::unique_ptr<CommandList::Handles> makeList()                                                     = 0;
    virtual void                                  run(std::span<CommandList* const> lists)                       = 0;
    virtual std::vector<std::string>              takeMessages() { return {}; }

    Processor   description;
    std::string note; ///< see Context::note()
    Limits      limits;
    bool        bitExact  = false;
    std::size_t allocated = 0; ///< [byte] of all live buffers
};

struct Buffer::Handles {
    Handles(Context::Handles& owner, std::string called, std::size_t size)
        : name(std::move(called)), bytes(size), owner_(owner)
    {
        owner_.allocated += bytes;
    }
    virtual ~Handles() { owner_.allocated -= bytes; }
    Handles(const Handles&)            = delete;
    Handles& operator=(const Handles&) = delete;

    virtual void makeVisibleToHost() {}

    std::string name;
    std::size_t bytes;
    void*       mapped = nullptr;

private:
    Context::Handles& owner_;
};

struct Kernel::Handles {
    Handles(const KernelCode& what, Workgroup shape) : code(what), workgroup(shape) {}
    virtual ~Handles()                 = default;
    Handles(const Handles&)            = delete;
    Handles& operator=(const Handles&) = delete;

    KernelCode code;
    Workgroup  workgroup;
};

struct CommandList::Handles {
    explicit Handles(Context::Handles& owner) : context(owner) {}
    virtual ~Handles()                 = default;
    Handles(const Handles&)            = delete;
    Handles& operator=(const Handles&) = delete;

    virtual void dispatch(const Kernel& kernel, const Bindings& bindings, const Push& push, Groups groups) = 0;
    virtual void dispatchIndirect(const Kernel& kernel, const Bindings& bindings, const Push& push,
                                  const Buffer& groups, std::size_t offset)                                = 0;
    virtual void copy(const Buffer& from, std::size_t fromOffset, const Buffer& to, std::size_t toOffset,
                      std::size_t bytes)                                                                   = 0;
    virtual void fill(const Buffer& buffer, std::uint32_t word)                                            = 0;
    virtual void timestamp()                                                                               = 0;
    virtual void end()                                                                                     = 0;

    [[nodiscard]] virtual std::vector<double> timestampsMilliseconds() const = 0;

    Context::Handles& context;
    int               dispatches = 0, copies = 0;
    bool              ended      = false;
    bool              ran        = false;
};

/// Returns how much of a buffer a kernel sees [byte].
[[nodiscard]] inline std::size_t bytesOf(const Binding& binding)
{
    return binding.bytes == Binding::kRest ? binding.buffer->bytes() - binding.offset : binding.bytes;
}

} // namespace palp::compute
