#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>

#include "engine/compute/context.h"

namespace palp::compute {

/// The use of a buffer, which decides where its memory lies.
enum class Intent {
    processor, ///< its own, fastest memory; the host reaches it by copies only
    upload,    ///< the host writes in order and does not read back; the processor reads over the bus
    readback   ///< the processor writes, the host reads: cached memory where available
};

/// A range of bytes that kernels and copies reach. Its contents are undefined until something writes them.
///
/// Each buffer has memory of its own: a solver needs tens of buffers, Vulkan allows at least 4096 allocations, and an
/// arena would couple the lifetimes of unrelated buffers without need.
class Buffer {
public:
    /// \param name   appears in messages of the validation layer and in captures
    /// \param bytes  > 0 and a multiple of 4
    /// \throws Error if the processor does not allow a buffer of this size
    /// \throws ProcessorLost if memory runs out
    Buffer(Context& context, std::string name, std::size_t bytes, Intent intent);
    ~Buffer();
    Buffer(Buffer&&) noexcept;
    Buffer& operator=(Buffer&&) noexcept;

    /// Returns the bytes as the host sees them, mapped permanently. Null for Intent::processor, unless the host
    /// computes.
    [[nodiscard]] void* mapped() const noexcept;

    /// Returns the same as an array. Not for Intent::processor.
    template <class T>
    [[nodiscard]] std::span<T> as() const
    {
        static_assert(std::is_trivially_copyable_v<T>);
        PALP_EXPECT(mapped(), "the buffer '" + name() + "' is the processor's own and cannot be mapped");
        return {static_cast<T*>(mapped()), bytes() / sizeof(T)};
    }

    /// Makes the processor's writes visible. Call it after Context::run() and before a readback buffer is read. It
    /// costs nothing where memory is coherent.
    void makeVisibleToHost() const;

    [[nodiscard]] std::size_t        bytes() const noexcept;
    [[nodiscard]] const std::string& name() const noexcept;

    /// Returns the implementation, for the files of engine/compute.
    struct Handles;
    [[nodiscard]] const Handles& handles() const noexcept { return *handles_; }

private:
    std::unique_ptr<Handles> handles_;
};

} // namespace palp::compute
