#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "engine/compute/context.h"

namespace palp::compute {

/// What a buffer is for; decides its memory.
enum class Intent {
    device,  ///< the device's own, fastest memory; the host reaches it by copies only
    upload,  ///< the host writes, in order and without reading back; the device reads over the bus
    readback ///< the device writes, the host reads: cached memory where there is some
};

/// A range of bytes that kernels and copies reach. Its contents are undefined until something writes them.
///
/// Each buffer has memory of its own: a solver needs tens of buffers, devices allow at least 4096 allocations, and an
/// arena would tie the lives of unrelated buffers together for nothing.
class Buffer {
public:
    /// \param name   appears in messages of the validation layer and in captures
    /// \param bytes  > 0 and a multiple of 4
    /// \throws Error if the device does not allow a buffer of this size, ProcessorLost if memory runs out
    Buffer(Context& context, std::string name, std::size_t bytes, Intent intent);
    ~Buffer();
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;

    /// The bytes as the host sees them, mapped for good; null for Intent::device, unless the host is the device.
    [[nodiscard]] void* mapped() const noexcept;

    /// As above, as an array. Not for Intent::device.
    template <class T>
    [[nodiscard]] std::span<T> as() const
    {
        static_assert(std::is_trivially_copyable_v<T>);
        PALP_EXPECT(mapped(), "the buffer '" + name() + "' is the device's own and cannot be mapped");
        return {static_cast<T*>(mapped()), bytes() / sizeof(T)};
    }

    /// Call it after Context::run() and before reading a readback buffer; costs nothing where memory is coherent.
    void makeVisibleToHost() const;

    [[nodiscard]] std::size_t        bytes() const noexcept;
    [[nodiscard]] const std::string& name() const noexcept;

    /// For the files of engine/compute.
    struct Handles;
    [[nodiscard]] const Handles& handles() const noexcept { return *handles_; }

private:
    std::unique_ptr<Handles> handles_;
};

} // namespace palp::compute
