#include "tests/support/failing_memory.h"

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>
#include <string_view>

#include <dlfcn.h>

namespace {

constexpr std::int64_t kEnough = std::numeric_limits<std::int64_t>::max();

thread_local std::int64_t left   = kEnough; // allocations that succeed
thread_local std::size_t  least  = 0;       // [bytes]
thread_local bool         ranOut = false;

/// Returns true for a place in Embree or TBB, which do not survive a throw out of their own allocations: Embree 3.13
/// goes on with a tree that it has half built.
bool isInEmbree(const void* caller)
{
    Dl_info where{};
    if (::dladdr(caller, &where) == 0 || !where.dli_fname) return false;
    const std::string_view library(where.dli_fname);
    return library.find("libembree") != library.npos || library.find("libtbb") != library.npos;
}

void* take(std::size_t size, std::size_t alignment, const void* caller)
{
    if (left != kEnough && size >= least && !isInEmbree(caller) && left-- <= 0) {
        left   = 0;
        ranOut = true;
        throw std::bad_alloc();
    }
    void* memory = nullptr;
    if (alignment <= alignof(std::max_align_t))
        memory = std::malloc(size ? size : 1);
    else if (::posix_memalign(&memory, alignment, size) != 0)
        memory = nullptr;
    if (!memory) throw std::bad_alloc();
    return memory;
}

} // namespace

palp::FailingMemory::FailingMemory(std::int64_t allocations, std::size_t leastBytes) noexcept
{
    least  = leastBytes;
    left   = allocations;
    ranOut = false;
}

palp::FailingMemory::~FailingMemory()
{
    left = kEnough;
}

bool palp::FailingMemory::failed() noexcept
{
    return ranOut;
}

void* operator new(std::size_t size)
{
    return take(size, 1, __builtin_return_address(0));
}
void* operator new(std::size_t size, std::align_val_t alignment)
{
    return take(size, std::size_t(alignment), __builtin_return_address(0));
}
void operator delete(void* memory) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept
{
    std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept
{
    std::free(memory);
}
