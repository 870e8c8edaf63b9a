#include "engine/compute/detail/host_context.h"

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <new>

#include <unistd.h>

#include "engine/compute/processor_error.h"
#include "engine/core/contract.h"

namespace palp::compute {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kAlignment = 64; ///< size of a cache line, and of the widest vector registers [byte]

/// Room before and after each buffer: kernels work on whole vectors, and may read numbers there that they do not use.
constexpr std::size_t kMargin = kAlignment;

struct HostBuffer : Buffer::Handles {
    HostBuffer(HostContext& owner, std::string called, std::size_t size) : Handles(owner, std::move(called), size)
    {
        const std::size_t whole = (size + kAlignment - 1) / kAlignment * kAlignment + 2 * kMargin;
        memory_                 = static_cast<std::byte*>(std::aligned_alloc(kAlignment, whole));
        if (!memory_)
            throw ProcessorOutOfMemory("this machine has no " + std::to_string(size >> 20) + " MiB for the buffer '" +
                                       name + "'; try fewer cells");
        std::memset(memory_, 0, kMargin);
        std::memset(memory_ + whole - 2 * kMargin, 0, 2 * kMargin);
        mapped = memory_ + kMargin;
    }
    ~HostBuffer() override { std::free(memory_); }

private:
    std::byte* memory_;
};

struct HostKernelHandles : Kernel::Handles {
    HostKernelHandles(const KernelCode& what, Workgroup shape, std::span<const std::uint32_t> given)
        : Handles(what, shape), constants(given.begin(), given.end())
    {
    }

    std::vector<std::uint32_t> constants;
};

struct HostList : CommandList::Handles {
    using Handles::Handles;

    void dispatch(const Kernel& kernel, const Bindings& bindings, const Push& push, Groups groups) override
    {
        add(kernel, bindings, push, groups, nullptr);
    }

    void dispatchIndirect(const Kernel& kernel, const Bindings& bindings, const Push& push, const Buffer& groups,
                          std::size_t offset) override
    {
        add(kernel, bindings, push, {}, static_cast<const std::byte*>(groups.handles().mapped) + offset);
    }

    void copy(const Buffer& from, std::size_t fromOffset, const Buffer& to, std::size_t toOffset,
              std::size_t bytes) override
    {
        const auto* source = static_cast<const std::byte*>(from.handles().mapped) + fromOffset;
        auto*       target = static_cast<std::byte*>(to.handles().mapped) + toOffset;
        commands.emplace_back([=] { std::memcpy(target, source, bytes); });
    }

    void fill(const Buffer& buffer, std::uint32_t word) override
    {
        auto* const       target = static_cast<std::uint32_t*>(buffer.handles().mapped);
        const std::size_t words  = buffer.bytes() / 4;
        commands.emplace_back([=] { std::fill_n(target, words, word); });
    }

    void timestamp() override
    {
        commands.emplace_back([this] { times.push_back(Clock::now()); });
    }

    void end() override {}

    [[nodiscard]] std::vector<double> timestampsMilliseconds() const override
    {
        std::vector<double> since;
        for (const auto& time : times)
            since.push_back(std::chrono::duration<double, std::milli>(time - times.front()).count());
        return since;
    }

    std::vector<std::function<void()>> commands;
    std::vector<Clock::time_point>     times;

private:
    void add(const Kernel& kernel, const Bindings& bindings, const Push& push, Groups groups, const std::byte* indirect)
    {
        const auto&        handles = static_cast<const HostKernelHandles&>(kernel.handles());
        std::vector<void*> buffers;
        for (const Binding& binding : bindings)
            buffers.push_back(static_cast<std::byte*>(binding.buffer->handles().mapped) + binding.offset);
        std::vector<std::byte> constants(push.begin(), push.end());
        commands.emplace_back([code = handles.code.host, workgroup = handles.workgroup, constants = handles.constants,
                               buffers = std::move(buffers), pushed = std::move(constants), groups, indirect] {
            Groups now = groups;
            if (indirect) std::memcpy(&now, indirect, sizeof now);
            if (now.x && now.y && now.z) code({buffers.data(), pushed.data(), constants.data(), workgroup, now});
        });
    }
};

} // namespace

Processor describeHost()
{
    Processor host;
    host.index   = -1;
    host.name    = std::string(kHostProcessor);
    host.kind    = ProcessorKind::host;
    host.float64 = true;
    host.memory  = std::uint64_t(sysconf(_SC_PHYS_PAGES)) * std::uint64_t(sysconf(_SC_PAGESIZE));
    return host;
}

HostContext::HostContext()
{
    description = describeHost();
    limits      = {std::numeric_limits<std::ptrdiff_t>::max(), 1024, std::numeric_limits<std::uint32_t>::max(), 0};
    bitExact    = true;
}

std::unique_ptr<Buffer::Handles> HostContext::makeBuffer(std::string name, std::size_t bytes, Intent)
{
    return std::make_unique<HostBuffer>(*this, std::move(name), bytes);
}

std::unique_ptr<Kernel::Handles> HostContext::makeKernel(const KernelCode& code, Workgroup workgroup,
                                                         std::span<const std::uint32_t> constants)
{
    PALP_EXPECT(code.host, std::string("the kernel ") + code.name + " has no code for the host");
    return std::make_unique<HostKernelHandles>(code, workgroup, constants);
}

std::unique_ptr<CommandList::Handles> HostContext::makeList()
{
    return std::make_unique<HostList>(*this);
}

void HostContext::run(std::span<CommandList* const> lists)
{
    for (const CommandList* list : lists) {
        auto& handles = static_cast<HostList&>(list->handles());
        handles.times.clear();
        for (const auto& command : handles.commands) command();
    }
}

} // namespace palp::compute
