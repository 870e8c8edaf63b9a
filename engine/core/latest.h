#pragma once
#include <array>
#include <atomic>
#include <cstddef>

namespace palp {

/// The indices of three slots: the one that the writer fills, the one that the reader holds, and the one in between.
/// The newest value wins.
///
/// The class knows nothing of the slots' contents, so that it serves arrays and mapped memory of a processor alike. The
/// reader may keep its slot for any time; the writer always has one to fill. Writes before publish() are visible after
/// held() has returned that slot. Invariant: the three numbers are a permutation of 0, 1, 2.
/// \thread one writer and one reader; wait-free
class LatestSlots {
public:
    /// Returns the slot that the writer fills next. For the writer.
    [[nodiscard]] int draft() const noexcept { return draft_; }

    /// Makes the draft the newest slot. For the writer.
    void publish() noexcept { draft_ = between_.exchange(draft_ | kFresh, std::memory_order_acq_rel) & kIndex; }

    /// Takes the newest published slot, or keeps the one that the reader has. For the reader.
    /// \return true if it is another one
    bool take() noexcept
    {
        if (!(between_.load(std::memory_order_relaxed) & kFresh)) return false;
        held_ = between_.exchange(held_, std::memory_order_acq_rel) & kIndex;
        return true;
    }

    /// Returns the slot that the reader holds; before the first take() that returned true, one without contents. For
    /// the reader.
    [[nodiscard]] int held() const noexcept { return held_; }

private:
    static constexpr int         kFresh = 4, kIndex = 3;
    static constexpr std::size_t kLine =
        64; ///< of the cache [byte]; on one line the two threads would wait for each other

    alignas(kLine) std::atomic<int> between_{1};
    alignas(kLine) int draft_ = 0;
    alignas(kLine) int held_  = 2;
};

/// The newest value, handed from one thread to another; see LatestSlots. Values are written in place, in memory that is
/// allocated beforehand.
/// \thread one writer (draft, publish), one reader (take, held)
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

    /// Returns the value that the reader holds; null until the first one has been taken.
    [[nodiscard]] const T* held() const noexcept { return any_ ? &values_[std::size_t(slots_.held())] : nullptr; }

    /// Returns every slot, to be prepared before the threads start.
    [[nodiscard]] std::array<T, 3>& all() noexcept { return values_; }

private:
    LatestSlots      slots_;
    std::array<T, 3> values_{};
    bool             any_ = false; ///< used by the reader only
};

} // namespace palp
