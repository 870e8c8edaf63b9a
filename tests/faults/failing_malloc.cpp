// Memory that ends, for whole programs: loaded before the C library (LD_PRELOAD), it counts what is asked for and gives
// none
//
//     FAILING_MALLOC_AT=n        to the n-th request, counted from 1; those after it get theirs
//     FAILING_MALLOC_FROM=n      to the n-th and all later ones of 4 KiB and more: a limit that was met
//     FAILING_MALLOC_COUNT=FILE  how many there were goes there at the end
//
// Requests of the library's own loader, and those before the environment is known, are not counted.
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>

// NOLINTBEGIN: names and forms are the C library's
extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
}

namespace {

std::atomic<long> counted{0};
std::atomic<long> at{0}, from{0};
std::atomic<bool> ready{false};

long setting(const char* name)
{
    const char* const text = std::getenv(name);
    return text ? std::atol(text) : 0;
}

struct Switch {
    Switch()
    {
        at    = setting("FAILING_MALLOC_AT");
        from  = setting("FAILING_MALLOC_FROM");
        ready = true;
    }
    ~Switch()
    {
        ready                  = false;
        const char* const path = std::getenv("FAILING_MALLOC_COUNT");
        std::FILE* const  file = path ? std::fopen(path, "w") : nullptr;
        if (!file) return;
        std::fprintf(file, "%ld\n", counted.load());
        std::fclose(file);
    }
} const switched;

bool fails(size_t size)
{
    constexpr size_t kLarge = 4096;
    if (!ready) return false;
    const long n = ++counted;
    if (n != at && !(from > 0 && n >= from && size >= kLarge)) return false;
    errno = ENOMEM;
    return true;
}

} // namespace

extern "C" {

void* malloc(size_t size)
{
    return fails(size) ? nullptr : __libc_malloc(size);
}

void* calloc(size_t count, size_t size)
{
    return fails(count * size) ? nullptr : __libc_calloc(count, size);
}

void* realloc(void* memory, size_t size)
{
    return fails(size) ? nullptr : __libc_realloc(memory, size);
}

} // extern "C"
// NOLINTEND
