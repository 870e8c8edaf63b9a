#include "engine/session/detail/growing_file.h"

#include <cerrno>
#include <cstring>
#include <string>

#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/contract.h"
#include "engine/core/file.h"

namespace palp {
namespace {

std::string reasonOfErrno()
{
    return errno ? std::strerror(errno) : "unknown reason";
}

} // namespace

GrowingFile::GrowingFile(std::filesystem::path path) : path_(std::move(path)), handle_(makeFile(path_)) {}

GrowingFile::~GrowingFile()
{
    if (handle_ >= 0) ::close(handle_);
}

void GrowingFile::close()
{
    errno            = 0;
    const bool isBad = ::close(std::exchange(handle_, -1)) != 0 && errno != EINTR; // EINTR: it is closed all the same
    if (isBad) throw Error(path_.string() + ": cannot be written: " + reasonOfErrno());
}

void GrowingFile::write(std::string_view bytes, std::uint64_t at)
{
    while (!bytes.empty()) {
        errno               = 0;
        const ssize_t count = ::pwrite(handle_, bytes.data(), bytes.size(), off_t(at));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) throw Error(path_.string() + ": cannot be written: " + reasonOfErrno());
        bytes.remove_prefix(std::size_t(count));
        at += std::uint64_t(count);
    }
}

void GrowingFile::append(std::string_view bytes)
{
    cut_ = isCut(); // zeros would stand in place of what is gone
    if (cut_) throw Error(path_.string() + ": another program has cut it short");
    write(bytes, whole_ + pending_);
    pending_ += bytes.size();
}

void GrowingFile::undo() noexcept
{
    pending_ = 0;
    if (cut_) return;                                        // it would grow again, of zeros
    if (::ftruncate(handle_, off_t(whole_)) != 0) errno = 0; // then it stays, and no header counts it
}

bool GrowingFile::isThere() const noexcept
{
    struct stat own {
    }, there{};
    if (::stat(path_.c_str(), &there) != 0) return errno != ENOENT && errno != ENOTDIR;
    if (::fstat(handle_, &own) != 0) return true;
    const bool isOther = own.st_dev != there.st_dev || own.st_ino != there.st_ino;
    return !isOther || (own.st_nlink > 0 && own.st_size == there.st_size); // some servers number files anew
}

bool GrowingFile::isCut() const noexcept
{
    struct stat own {};
    return cut_ || (::fstat(handle_, &own) == 0 && std::uint64_t(own.st_size) < whole_);
}

} // namespace palp
