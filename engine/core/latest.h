#pragma once
#include <array>
#include <atomic>
#include <cstddef>

namespace palp {

/// Which of three slots the writer fills, which one the reader holds, and which one lies in between: newest wins.
///
/// Apart from what the slots are, so that arrays and mapped memory of a device are handed over alike. The reader may
/// keep its slot for as long as it likes; the writer always has one to fill. What was written before publish() is seen
/// after held() has returned its slot. Invariant: the three numbers are a permutation of 0, 1, 2. \thread one writer
/// and one reader; wait-free
class LatestSlots {
public:
    /// The writer's: which slot to fill next.
    [[nodiscard]] int draft() const noexcept { return draft_; }

    /// The writer's: the draft is the newest now.
    void publish() noexcept { draft_ = between_.exchange(draft_ | kFresh, std::memory_order_acq_rel) & kIndex; }

    /// The reader's: takes the newest published slot, or keeps the one that it has. \return whether it is another one
    bool take() noexcept
    {
        if (!(between_.load(std::memory_order_relaxed) & kFresh)) return false;
        held_ = between_.exchange(held_, std::memory_order_acq_rel) & kIndex;
        return true;
    }

    /// The reader's: which slot it holds; before the first take() that returned true, one without contents.
    [[nodiscard]] int held() const noexcept { return held_; }

private:
    static constexpr int         kFresh = 4, kIndex = 3;
    static constexpr std::size_t kLine =
        64; ///< of the cache [byte]; on one line the two threads would wait for each other

    alignas(kLine) std::atomic<int> between_{1};
    alignas(kLine) int draft_ = 0;
    alignas(kLine) int held_  = 2;
};

/// The newest value from one thread to another; see LatestSlots. Values are written in place: what they need is
/// allocated beforehand. \thread one writer (draft, publish), one reader (take, held)
template <class T>
class Latest {
public:
    [[nodiscard]] T& draft() noexcept { return values_[std::size_t(slots_.draft())]; }
    void             publish() noexcept { slots_.publish(); }

    bool take() noexcept
    {
        const bool isNew = slots_.take();
        any_             = any_ || isNew;
        return isNew;
    }

    /// Null until the first value has been taken.
    [[nodiscard]] const T* held() const noexcept { return any_ ? &values_[std::size_t(slots_.held())] : nullptr; }

    /// Every slot, to be prepared before the threads start.
    [[nodiscard]] std::array<T, 3>& all() noexcept { return values_; }

private:
    LatestSlots      slots_;
    std::array<T, 3> values_{};
    bool             any_ = false; ///< the reader's
};

} // namespace palp
