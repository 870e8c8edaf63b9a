// Calls on files that fail, for whole programs: loaded before the C library (LD_PRELOAD), it counts what changes files
// and folders (new ones, writes to regular files, syncs, lengths, names, the closing of what was open for writing; not
// what is removed, which a full disk lets go) and fails
//
//     FAILING_FILES_AT=n        the n-th such call, counted from 1, and all later ones: a disk that is full
//     FAILING_FILES_ONCE=n      the n-th alone: a disk that has an error
//     FAILING_FILES_COUNT=FILE  how many there were so far
//     FAILING_FILES_READ=FOLDER with this, what is counted and fails are reads of files below a folder, in place of
//     changes
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

std::atomic<long> counted{0};

long setting(const char* name)
{
    const char* const text = std::getenv(name);
    return text ? std::atol(text) : 0;
}

template <class Function>
Function* next(const char* name)
{
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

/// Writes how many calls there were, after each: a program may end without its destructors.
void report(long calls)
{
    static const auto        real = next<ssize_t(int, const void*, size_t, off_t)>("pwrite");
    static const char* const path = std::getenv("FAILING_FILES_COUNT");
    static const auto        make = next<int(const char*, int, ...)>("open");
    static const int         file = path ? make(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644) : -1;
    char                     text[24];
    const int                size = std::snprintf(text, sizeof text, "%ld\n", calls);
    if (file >= 0) static_cast<void>(real(file, text, size_t(size), 0) == size);
}

/// Returns the folder below which reads fail in place of changes; null: there is none.
const char* folderOfReads()
{
    static const char* const folder = std::getenv("FAILING_FILES_READ");
    return folder;
}

/// Counts a call, and returns whether it fails; errno says why.
bool fails(bool reads = false)
{
    if (reads != (folderOfReads() != nullptr)) return false;
    static const long at = setting("FAILING_FILES_AT"), once = setting("FAILING_FILES_ONCE");
    const long        n = ++counted;
    report(n);
    if (at > 0 && n >= at) errno = ENOSPC;
    if (once > 0 && n == once) errno = EIO;
    return (at > 0 && n >= at) || (once > 0 && n == once);
}

bool makesFile(int flags)
{
    return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
}

/// Returns whether a handle is of a file below that folder.
bool isRead(int handle)
{
    if (!folderOfReads() || handle <= 2) return false;
    char          name[64], path[4096];
    const ssize_t size =
        (std::snprintf(name, sizeof name, "/proc/self/fd/%d", handle), ::readlink(name, path, sizeof path - 1));
    if (size <= 0) return false;
    path[size] = 0;
    return std::strncmp(path, folderOfReads(), std::strlen(folderOfReads())) == 0;
}

/// What a program says to a terminal or a pipe is not meant, nor what it is started with writes to.
bool isFile(int handle)
{
    struct stat found {};
    return handle > 2 && ::fstat(handle, &found) == 0 && S_ISREG(found.st_mode);
}

} // namespace

// NOLINTBEGIN: names and forms are the C library's
extern "C" {

ssize_t write(int handle, const void* bytes, size_t count)
{
    static const auto real = next<ssize_t(int, const void*, size_t)>("write");
    return isFile(handle) && fails() ? -1 : real(handle, bytes, count);
}

ssize_t pwrite(int handle, const void* bytes, size_t count, off_t at)
{
    static const auto real = next<ssize_t(int, const void*, size_t, off_t)>("pwrite");
    return isFile(handle) && fails() ? -1 : real(handle, bytes, count, at);
}

ssize_t pwrite64(int handle, const void* bytes, size_t count, off64_t at)
{
    static const auto real = next<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
    return isFile(handle) && fails() ? -1 : real(handle, bytes, count, at);
}

int close(int handle)
{
    static const auto real  = next<int(int)>("close");
    const bool        isBad = isFile(handle) && (::fcntl(handle, F_GETFL) & O_ACCMODE) != O_RDONLY && fails();
    const int         why   = errno;
    const int         code  = real(handle); // it is closed all the same
    if (!isBad) return code;
    errno = why;
    return -1;
}

ssize_t read(int handle, void* bytes, size_t count)
{
    static const auto real = next<ssize_t(int, void*, size_t)>("read");
    if (!isRead(handle)) return real(handle, bytes, count);
    constexpr size_t kMost = 512; // a system may give less than was asked for: small files take many calls too
    return fails(true) ? -1 : real(handle, bytes, count < kMost ? count : kMost);
}

int fsync(int handle)
{
    static const auto real = next<int(int)>("fsync");
    return isFile(handle) && fails() ? -1 : real(handle);
}

int fdatasync(int handle)
{
    static const auto real = next<int(int)>("fdatasync");
    return isFile(handle) && fails() ? -1 : real(handle);
}

int ftruncate(int handle, off_t length) noexcept
{
    static const auto real = next<int(int, off_t)>("ftruncate");
    return isFile(handle) && fails() ? -1 : real(handle, length);
}

int ftruncate64(int handle, off64_t length) noexcept
{
    static const auto real = next<int(int, off64_t)>("ftruncate64");
    return isFile(handle) && fails() ? -1 : real(handle, length);
}

int open(const char* path, int flags, ...)
{
    static const auto real = next<int(const char*, int, ...)>("open");
    va_list           more;
    va_start(more, flags);
    const auto mode = makesFile(flags) ? va_arg(more, mode_t) : 0;
    va_end(more);
    return makesFile(flags) && fails() ? -1 : real(path, flags, mode);
}

int open64(const char* path, int flags, ...)
{
    static const auto real = next<int(const char*, int, ...)>("open64");
    va_list           more;
    va_start(more, flags);
    const auto mode = makesFile(flags) ? va_arg(more, mode_t) : 0;
    va_end(more);
    return makesFile(flags) && fails() ? -1 : real(path, flags, mode);
}

int rename(const char* from, const char* to) noexcept
{
    static const auto real = next<int(const char*, const char*)>("rename");
    return fails() ? -1 : real(from, to);
}

int linkat(int a, const char* from, int b, const char* to, int flags) noexcept
{
    static const auto real = next<int(int, const char*, int, const char*, int)>("linkat");
    return fails() ? -1 : real(a, from, b, to, flags);
}

int mkdir(const char* path, mode_t mode) noexcept
{
    static const auto real = next<int(const char*, mode_t)>("mkdir");
    return fails() ? -1 : real(path, mode);
}

} // extern "C"
// NOLINTEND
