#include "tests/session/allocations.h"

#include <cstdlib>
#include <new>

// In a file of its own: where a compiler sees malloc() behind new and free() behind delete it calls them mismatched.

namespace {
thread_local std::size_t allocations = 0;
}

void* operator new(std::size_t size)
{
    ++allocations;
    if (void* const memory = std::malloc(size ? size : 1)) return memory;
    throw std::bad_alloc();
}

void operator delete(void* memory) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}

std::size_t palp::allocationsOfThisThread() noexcept
{
    return allocations;
}
