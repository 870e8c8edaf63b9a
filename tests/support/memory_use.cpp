#include "tests/support/memory_use.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace {
std::atomic<std::size_t> live{0}, peak{0}; // [bytes]
}

std::size_t palp::memoryNow() noexcept
{
    return live;
}

std::size_t palp::mostMemory() noexcept
{
    return peak;
}

void palp::forgetMostMemory() noexcept
{
    peak = live.load();
}

// AddressSanitizer has an operator of its own for each that is not here, whose memory the operator below must not free.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept
{
    void* const memory = std::malloc(size ? size : 1);
    if (!memory) return nullptr;
    const std::size_t now = live += ::malloc_usable_size(memory);
    for (std::size_t most = peak; now > most && !peak.compare_exchange_weak(most, now);) {
    }
    return memory;
}
void* operator new(std::size_t size)
{
    void* const memory = operator new(size, std::nothrow);
    if (!memory) throw std::bad_alloc();
    return memory;
}
void operator delete(void* memory) noexcept
{
    if (memory) live -= ::malloc_usable_size(memory);
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
    operator delete(memory);
}
