#include "engine/core/file.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <unistd.h>

#include "engine/core/contract.h"

namespace palp {
namespace {

std::string reasonOfErrno()
{
    return errno ? std::strerror(errno) : "unknown reason";
}

/// Returns a name beside `path` that no other process uses, so that two writers cannot overwrite each other's draft.
std::filesystem::path draftOf(const std::filesystem::path& path)
{
    return path.string() + "." + std::to_string(::getpid()) + ".part";
}

} // namespace

std::ifstream openForReading(const std::filesystem::path& path)
{
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw Error(path.string() + ": cannot be read: it is a folder; name a file in it");
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    if (!file) throw Error(path.string() + ": cannot be read: " + reasonOfErrno());
    return file;
}

std::ifstream openRegularFile(const std::filesystem::path& path)
{
    std::error_code ignored;
    if (std::filesystem::is_fifo(path, ignored))
        throw Error(path.string() + ": expected a regular file whose size is known, found a pipe; write what comes "
                                    "through it into a file, and name that");
    return openForReading(path);
}

std::uint64_t sizeOfFile(const std::filesystem::path& path)
{
    std::error_code     failure;
    const std::uint64_t size = std::filesystem::file_size(path, failure);
    if (failure) throw Error(path.string() + ": expected a regular file whose size is known: " + failure.message());
    return size;
}

std::string readWhole(const std::filesystem::path& path, std::size_t most, const std::string& expected)
{
    std::ifstream in = openForReading(path);
    std::string   text;
    for (char part[65536]; text.size() <= most && in; text.append(part, std::size_t(in.gcount())))
        in.read(part, sizeof part);
    if (text.size() > most)
        throw Error(path.string() + ": longer than " + std::to_string(most) + " bytes; expected " + expected);
    return text;
}

void writeFileWhole(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write)
{
    std::error_code status;
    if (std::filesystem::is_directory(path, status))
        throw Error(path.string() + ": cannot be written: it is a folder; name a file in it");
    // A device file or a pipe (/dev/stdout, /dev/null) must not be replaced by a file of the same name.
    const bool replaceable = !std::filesystem::exists(path, status) || std::filesystem::is_regular_file(path, status);
    // A link stays a link: the file that it points to is replaced.
    const std::filesystem::path place =
        std::filesystem::is_symlink(path, status) ? std::filesystem::weakly_canonical(path, status) : path;
    const std::filesystem::path target = replaceable ? draftOf(place) : place;

    errno = 0;
    std::ofstream file(target, std::ios::binary | std::ios::trunc);
    if (!file) throw Error(path.string() + ": cannot be written: " + reasonOfErrno());
    try {
        errno = 0; // a failure below, in `write` or in the last flush, sets it
        write(file);
        file.close();
        if (!file) throw Error(path.string() + ": cannot be written: " + reasonOfErrno());
        if (replaceable) std::filesystem::rename(target, place);
    } catch (const std::filesystem::filesystem_error& failure) {
        if (replaceable) std::filesystem::remove(target, status);
        throw Error(path.string() + ": cannot be written: " + failure.code().message());
    } catch (...) {
        if (replaceable) std::filesystem::remove(target, status);
        throw;
    }
}

void makeFolder(const std::filesystem::path& path)
{
    std::error_code failure;
    std::filesystem::create_directories(path, failure);
    if (failure || !std::filesystem::is_directory(path))
        throw Error(path.string() +
                    ": the folder cannot be made: " + (failure ? failure.message() : "something else has that name"));
}

} // namespace palp
