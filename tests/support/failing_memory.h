#pragma once
#include <cstddef>
#include <cstdint>

namespace palp {

/// While one lives, the n-th allocation of this thread by operator new fails, and every one after it. The program has
/// to link failing_memory.cpp.
class FailingMemory {
public:
    /// \param allocations  that still succeed
    /// \param leastBytes   smaller ones always do
    explicit FailingMemory(std::int64_t allocations, std::size_t leastBytes = 0) noexcept;
    ~FailingMemory();
    FailingMemory(const FailingMemory&)            = delete;
    FailingMemory& operator=(const FailingMemory&) = delete;

    [[nodiscard]] static bool failed() noexcept; ///< since the newest of this thread began
};

} // namespace palp
