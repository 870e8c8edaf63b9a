#include "tests/support/locks.h"

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>

// These functions come before the C library's of the same names; they count and call those.

#if defined(__SANITIZE_THREAD__)

std::size_t palp::locksOfThisThread() noexcept
{
    return 0;
}
bool palp::locksAreCounted() noexcept
{
    return false;
}

#else

namespace {

thread_local std::size_t locks = 0;

template <class Function>
Function* next(Function* /*of the type of*/, const char* name)
{
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

} // namespace

#define PALP_COUNTED(name, parameters, arguments)                                                                      \
    extern "C" int name parameters                                                                                     \
    {                                                                                                                  \
        static const auto real = next(&name, #name);                                                                   \
        ++locks;                                                                                                       \
        return real arguments;                                                                                         \
    }

PALP_COUNTED(pthread_mutex_lock, (pthread_mutex_t * mutex), (mutex))
PALP_COUNTED(pthread_mutex_trylock, (pthread_mutex_t * mutex), (mutex))
PALP_COUNTED(pthread_rwlock_rdlock, (pthread_rwlock_t * lock), (lock))
PALP_COUNTED(pthread_rwlock_wrlock, (pthread_rwlock_t * lock), (lock))
PALP_COUNTED(pthread_cond_wait, (pthread_cond_t * condition, pthread_mutex_t* mutex), (condition, mutex))
PALP_COUNTED(sem_wait, (sem_t * semaphore), (semaphore))

#undef PALP_COUNTED

std::size_t palp::locksOfThisThread() noexcept
{
    return locks;
}

bool palp::locksAreCounted() noexcept
{
    return true;
}

#endif
