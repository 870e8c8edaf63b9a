#pragma once
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include "engine/compute/buffer.h"
#include "engine/compute/kernel.h"

namespace palp::compute {

/// A buffer, or part of one, as a kernel sees it.
struct Binding {
    static constexpr std::size_t kRest = ~std::size_t(0);

    // A plain buffer converts to a binding.
    Binding(const Buffer& whole) : buffer(&whole) {}
    Binding(const Buffer& part, std::size_t first, std::size_t count = kRest)
        : buffer(&part), offset(first), bytes(count)
    {
    }

    const Buffer* buffer;
    std::size_t   offset = 0;     ///< [byte] a multiple of 256 suits every processor
    std::size_t   bytes  = kRest; ///< [byte]
};

/// Bindings 0, 1, ... of a dispatch: {a, b, {c, 256, 1024}} or an array of them.
struct Bindings : std::span<const Binding> {
    Bindings(std::initializer_list<Binding> list) : span(list.begin(), list.size()) {}
    Bindings(const std::vector<Binding>& list) : span(list) {}
    Bindings(std::span<const Binding> list) : span(list) {}
};

/// Push constants: any plain struct, laid out as in the shader; {} for none.
struct Push : std::span<const std::byte> {
    Push() = default;
    template <class T>
    requires(std::is_trivially_copyable_v<T>&& std::is_class_v<T>) Push(const T& value)
        : span(std::as_bytes(std::span<const T, 1>(&value, 1)))
    {
    }
};

/// Commands that are recorded once and run any number of times, one after the other: each sees all that the earlier
/// ones wrote. Kernels and buffers that a list names must live until it has run for the last time.
class CommandList {
public:
    explicit CommandList(Context& context);
    ~CommandList();
    CommandList(CommandList&&) noexcept;
    CommandList& operator=(CommandList&&) noexcept;

    void dispatch(const Kernel& kernel, const Bindings& bindings, const Push& push, Groups groups);

    /// Dispatches with the groups, three 32-bit words, that a buffer holds when the list runs. A kernel may have
    /// written them; with zeroes the dispatch does nothing at almost no cost.
    /// \param offset  of the words [byte], a multiple of 4
    void dispatchIndirect(const Kernel& kernel, const Bindings& bindings, const Push& push, const Buffer& groups,
                          std::size_t offset = 0);

    /// Copies a range of bytes. The ranges lie within the buffers and do not overlap.
    void copy(const Buffer& from, std::size_t fromOffset, const Buffer& to, std::size_t toOffset, std::size_t bytes);

    /// Copies the whole of a buffer into one of at least its size.
    void copy(const Buffer& from, const Buffer& to) { copy(from, 0, to, 0, from.bytes()); }

    /// Fills the whole buffer with a word.
    void fill(const Buffer& buffer, std::uint32_t word);

    /// Records the time when everything before it is done.
    void timestamp();

    /// Ends the recording: nothing can be recorded after this, and the list cannot run before it.
    void end();

    /// Returns the times of the last run, one for each timestamp(), since the first of them [ms]; nothing if the
    /// processor has no clock.
    [[nodiscard]] std::vector<double> timestampsMilliseconds() const;

    [[nodiscard]] int  dispatches() const noexcept; ///< number recorded, indirect ones included
    [[nodiscard]] int  copies() const noexcept;     ///< number recorded, fills included
    [[nodiscard]] bool ended() const noexcept;

    /// Returns the implementation, for the files of engine/compute.
    struct Handles;
    [[nodiscard]] Handles& handles() const noexcept { return *handles_; }

private:
    std::unique_ptr<Handles> handles_;
};

} // namespace palp::compute
