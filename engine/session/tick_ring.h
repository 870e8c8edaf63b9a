#pragma once
#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <span>
#include <vector>

namespace palp {

/// A first-in, first-out queue between one thread that must never wait and one that may.
///
/// Both ends count upwards and never wrap: tail - head values lie between them, and an index is a count modulo the
/// capacity, a power of two. Each end keeps a copy of the other's count and looks again only when that copy shows full
/// or empty, so that a push touches a line of the other core's cache once in many times.
/// Invariant: head <= tail <= head + capacity.
/// \thread push(): one producer; front(), pop(): one consumer; both wait-free, without allocation
template <class T>
class TickRing {
public:
    /// \param atLeast  rounded up to a power of two; allocated and touched here
    explicit TickRing(std::size_t atLeast) : slots_(std::bit_ceil(atLeast)), mask_(slots_.size() - 1) {}

    [[nodiscard]] std::size_t capacity() const noexcept { return slots_.size(); }

    /// Adds a value. Returns false, and changes nothing, if the ring is full.
    [[nodiscard]] bool push(const T& value) noexcept
    {
        const std::size_t tail = tail_.load(std::memory_order_relaxed);
        if (tail - headSeen_ == slots_.size()) {
            headSeen_ = head_.load(std::memory_order_acquire);
            if (tail - headSeen_ == slots_.size()) return false;
        }
        slots_[tail & mask_] = value;
        tail_.store(tail + 1, std::memory_order_release);
        return true;
    }

    /// Returns the oldest values that lie together, up to the end of the storage; empty if there is none.
    [[nodiscard]] std::span<const T> front() noexcept
    {
        const std::size_t head = head_.load(std::memory_order_relaxed);
        if (head == tailSeen_) tailSeen_ = tail_.load(std::memory_order_acquire);
        const std::size_t begin = head & mask_;
        return std::span<const T>(slots_).subspan(begin, std::min(tailSeen_ - head, slots_.size() - begin));
    }

    /// Removes the oldest values.
    /// \param count  at most front().size()
    void pop(std::size_t count) noexcept
    {
        head_.store(head_.load(std::memory_order_relaxed) + count, std::memory_order_release);
    }

private:
    static constexpr std::size_t kLine = 64; ///< [bytes] of a cache: the ends must not share one

    std::vector<T> slots_;
    std::size_t    mask_;
    alignas(kLine) std::atomic<std::size_t> tail_{0};
    std::size_t headSeen_ = 0; ///< of the producer
    alignas(kLine) std::atomic<std::size_t> head_{0};
    std::size_t tailSeen_ = 0; ///< of the consumer
};

} // namespace palp
