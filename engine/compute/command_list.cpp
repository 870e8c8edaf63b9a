#include "engine/compute/command_list.h"

#include <string>

#include "engine/compute/backend.h"

namespace palp::compute {
namespace {

void expectFits(const Kernel& kernel, const Bindings& bindings, const Push& push)
{
    const KernelCode& code = kernel.code();
    const std::string who  = std::string("the kernel ") + code.name;
    PALP_EXPECT(bindings.size() == std::size_t(code.buffers),
                who + " takes " + std::to_string(code.buffers) + " buffers, not " + std::to_string(bindings.size()));
    PALP_EXPECT(push.size() == std::size_t(code.pushBytes), who + " takes " + std::to_string(code.pushBytes) +
                                                                " bytes of push constants, not " +
                                                                std::to_string(push.size()));
    for (const Binding& binding : bindings) {
        const std::size_t all = binding.buffer->bytes();
        PALP_EXPECT(binding.offset < all && bytesOf(binding) > 0 && bytesOf(binding) <= all - binding.offset,
                    who + " reaches beyond the buffer '" + binding.buffer->name() + "'");
    }
}

} // namespace

CommandList::CommandList(Context& context) : handles_(context.handles().makeList()) {}
CommandList::~CommandList()                                 = default;
CommandList::CommandList(CommandList&&) noexcept            = default;
CommandList& CommandList::operator=(CommandList&&) noexcept = default;

void CommandList::dispatch(const Kernel& kernel, const Bindings& bindings, const Push& push, Groups groups)
{
    PALP_EXPECT(!ended(), "a command list cannot be recorded after end()");
    expectFits(kernel, bindings, push);
    handles_->dispatch(kernel, bindings, push, groups);
    ++handles_->dispatches;
}

void CommandList::dispatchIndirect(const Kernel& kernel, const Bindings& bindings, const Push& push,
                                   const Buffer& groups, std::size_t offset)
{
    PALP_EXPECT(!ended(), "a command list cannot be recorded after end()");
    PALP_EXPECT(offset % 4 == 0 && groups.bytes() >= sizeof(Groups) && offset <= groups.bytes() - sizeof(Groups),
                "no three words at byte " + std::to_string(offset) + " of the buffer '" + groups.name() + "'");
    expectFits(kernel, bindings, push);
    handles_->dispatchIndirect(kernel, bindings, push, groups, offset);
    ++handles_->dispatches;
}

void CommandList::copy(const Buffer& from, std::size_t fromOffset, const Buffer& to, std::size_t toOffset,
                       std::size_t bytes)
{
    PALP_EXPECT(!ended(), "a command list cannot be recorded after end()");
    PALP_EXPECT(bytes > 0 && bytes <= from.bytes() && fromOffset <= from.bytes() - bytes && bytes <= to.bytes() &&
                    toOffset <= to.bytes() - bytes,
                "copying " + std::to_string(bytes) + " bytes from '" + from.name() + "' at " +
                    std::to_string(fromOffset) + " to '" + to.name() + "' at " + std::to_string(toOffset));
    handles_->copy(from, fromOffset, to, toOffset, bytes);
    ++handles_->copies;
}

void CommandList::fill(const Buffer& buffer, std::uint32_t word)
{
    PALP_EXPECT(!ended(), "a command list cannot be recorded after end()");
    handles_->fill(buffer, word);
    ++handles_->copies;
}

void CommandList::timestamp()
{
    PALP_EXPECT(!ended(), "a command list cannot be recorded after end()");
    handles_->timestamp();
}

void CommandList::end()
{
    PALP_EXPECT(!ended(), "a command list ends once");
    handles_->end();
    handles_->ended = true;
}

std::vector<double> CommandList::timestampsMilliseconds() const
{
    PALP_EXPECT(handles_->ran, "a command list has no times before it has run");
    return handles_->timestampsMilliseconds();
}

int CommandList::dispatches() const noexcept
{
    return handles_->dispatches;
}

int CommandList::copies() const noexcept
{
    return handles_->copies;
}

bool CommandList::ended() const noexcept
{
    return handles_->ended;
}

} // namespace palp::compute
