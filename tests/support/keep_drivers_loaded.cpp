// LeakSanitizer names leaks by their library after the program has ended. A driver must still be loaded then, or
// lsan.supp cannot recognise its leaks. The loader calls this function in place of the C library's.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PALP_ADDRESS_SANITIZER 1
#endif
#elif defined(__SANITIZE_ADDRESS__)
#define PALP_ADDRESS_SANITIZER 1
#endif

#if defined(PALP_ADDRESS_SANITIZER)
extern "C" int dlclose(void*)
{
    return 0;
}
#endif
