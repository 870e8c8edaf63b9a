#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <ctime>

// What a program that pushes and its guardian process share, see guardian.h. The process has no other code of Palpate.
namespace palp {

/// The page of memory that both see. Times are of CLOCK_MONOTONIC [ns].
struct GuardianPage {
    static constexpr std::size_t kPacket = 256; ///< [byte] most of a packet

    std::atomic<std::int64_t>  alive{0};    ///< last sign of life of the program
    std::atomic<std::int64_t>  watching{0}; ///< last look of the guardian; 0: not yet
    std::atomic<std::uint32_t> pushing{0};  ///< 1: the device may push
    std::atomic<std::uint32_t> silenced{0}; ///< times that the guardian took the force of a program that was silent
    std::atomic<std::uint32_t> noticed{0};  ///< of these, the program knows, and has sent zero itself

    std::atomic<std::uint32_t>                       zero{0};  ///< which of `zeros` is whole
    std::uint32_t                                    size = 0; ///< [byte] of each packet below
    std::array<std::array<std::uint8_t, kPacket>, 2> zeros{};  ///< zero force, as the device takes it now
    std::array<std::uint8_t, kPacket>                packet{}; ///< what the program sends: it goes out from here
};
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "two processes share it");

inline constexpr std::int64_t kGuardianPatience = 25'000'000; ///< [ns] of silence from which on the guardian acts

inline std::int64_t guardianClock() noexcept
{
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * std::int64_t(1'000'000'000) + now.tv_nsec;
}

/// Descriptors of the guardian process.
enum GuardianDescriptor : int {
    kGuardianPageFd   = 3,
    kGuardianLifeFd   = 4, ///< a pipe that ends with the program
    kGuardianDeviceFd = 5
};

} // namespace palp
