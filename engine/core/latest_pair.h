#pragma once
#include <array>
#include <atomic>
#include <cstddef>

namespace palp {

/// The newest value, handed from one thread to another that may go on with an older one: Latest with a fourth slot.
///
/// The reader has two slots, the newest and one that it keeps, so that it can compare them where they lie. The writer
/// always has one to fill, and one lies between. Writes before publish() are visible after take().
/// Invariant: the four numbers are a permutation of 0, 1, 2, 3.
/// \thread one writer (draft, publish), one reader (take, newest); wait-free. A slot's old value ends where the writer
///         overwrites it, never at the reader's
template <class T>
class LatestPair {
public:
    [[nodiscard]] T& draft() noexcept { return values_[std::size_t(draft_)]; }

    /// Makes the draft the newest value. For the writer.
    void publish() noexcept { draft_ = between_.exchange(draft_ | kFresh, std::memory_order_acq_rel) & kIndex; }

    /// Takes the newest published value, and gives back one of the reader's two. For the reader.
    /// \param isKept  whether the reader still uses a value; of at most one
    /// \return true if newest() is another one
    template <class IsKept>
    bool take(const IsKept& isKept) noexcept
    {
        if (!(between_.load(std::memory_order_relaxed) & kFresh)) return false;
        const bool keepsNewest = any_ && isKept(values_[std::size_t(newest_)]);
        const int  back        = keepsNewest ? kept_ : newest_;
        if (keepsNewest) kept_ = newest_;
        newest_ = between_.exchange(back, std::memory_order_acq_rel) & kIndex;
        any_    = true;
        return true;
    }

    /// Returns the value taken last; null until there is one. For the reader.
    [[nodiscard]] const T* newest() const noexcept { return any_ ? &values_[std::size_t(newest_)] : nullptr; }

private:
    static constexpr int         kFresh = 4, kIndex = 3;
    static constexpr std::size_t kLine = 64; ///< of the cache [byte]; on one line the threads would wait for each other

    alignas(kLine) std::atomic<int> between_{1};
    alignas(kLine) int draft_  = 0;
    alignas(kLine) int newest_ = 2;
    int              kept_     = 3;
    bool             any_      = false;
    std::array<T, 4> values_{};
};

} // namespace palp
