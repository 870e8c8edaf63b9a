// Which reports of sanitizers are a driver's own: part of every program that may load one, see
// engine/compute/CMakeLists.txt.

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PALP_ADDRESS_SANITIZER 1
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define PALP_ADDRESS_SANITIZER 1
#endif

#if defined(PALP_ADDRESS_SANITIZER)

// LeakSanitizer names leaks by their library after the program has ended. A driver must still be loaded then, or its
// leaks cannot be told from ours. The loader calls this function in place of the C library's.
extern "C" int dlclose(void*)
{
    return 0;
}

// Up to GCC 13 the runtime takes a block of thread-local memory that by chance lies at a certain offset of its page for
// one of an old C library, whose length stands before it, and LeakSanitizer crashes on an invalid address.
extern "C" const char* __asan_default_options()
{
    return "intercept_tls_get_addr=0";
}

extern "C" const char* __lsan_default_options()
{
    return "print_suppressions=0";
}

// The stacks of our own leaks contain palp:: or a test, and none of these libraries.
extern "C" const char* __lsan_default_suppressions()
{
    return "leak:libvulkan_lvp.so\nleak:libLLVM\nleak:libVkLayer_khronos_validation.so\n";
}

#else

// The runtime sleeps for a second at the end of each process that still has threads, in case one of them races with the
// exit: a quarter of an hour over all tests, which sanitizers seldom have. Workers that were set free have woken up in
// this time.
extern "C" const char* __tsan_default_options()
{
    return "atexit_sleep_ms=20";
}

// Neither drivers nor the threads of CHOLMOD are instrumented, so ThreadSanitizer does not see what they wait for. X's
// library gives back a mutex that it does not hold when its display has gone.
extern "C" const char* __tsan_default_suppressions()
{
    return "race:libvulkan_lvp.so\nrace:libLLVM\nrace:libVkLayer_khronos_validation.so\n"
           "race:libcholmod.so\nrace:libgomp.so\nmutex:libX11.so\n";
}

#endif
