#pragma once
#include <cstddef>

// What operator new has given and delete has not yet taken back, of the whole program, which has to have memory_use.cpp
// among its own sources.

namespace palp {

[[nodiscard]] std::size_t memoryNow() noexcept;  ///< [bytes]
[[nodiscard]] std::size_t mostMemory() noexcept; ///< since the program or forgetMostMemory() began [bytes]
void                      forgetMostMemory() noexcept;

} // namespace palp
