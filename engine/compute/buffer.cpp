#include "engine/compute/buffer.h"

#include "engine/compute/backend.h"

namespace palp::compute {

Buffer::Buffer(Context& context, std::string name, std::size_t bytes, Intent intent)
{
    PALP_EXPECT(bytes > 0 && bytes % 4 == 0, "the buffer '" + name + "' has " + std::to_string(bytes) +
                                                 " bytes: a positive multiple of 4 it must be");
    handles_ = context.handles().makeBuffer(std::move(name), bytes, intent);
}

Buffer::~Buffer()                            = default;
Buffer::Buffer(Buffer&&) noexcept            = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;

void* Buffer::mapped() const noexcept
{
    return handles_->mapped;
}

void Buffer::makeVisibleToHost() const
{
    handles_->makeVisibleToHost();
}

std::size_t Buffer::bytes() const noexcept
{
    return handles_->bytes;
}

const std::string& Buffer::name() const noexcept
{
    return handles_->name;
}

} // namespace palp::compute
