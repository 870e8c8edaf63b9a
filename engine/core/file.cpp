#include "engine/core/file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <deque>
#include <optional>
#include <ostream>
#include <streambuf>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/contract.h"
#include "engine/core/shown_text.h"

namespace palp {
namespace {

std::string reasonOfErrno()
{
    return errno ? std::strerror(errno) : "unknown reason";
}

[[noreturn]] void refuseToWrite(const std::filesystem::path& path, const std::string& reason)
{
    throw Error(shownPath(path.string()) + ": cannot be written: " + reason);
}

/// Whether somebody else, neither root nor the folder's owner, put this into a folder where anybody may write.
bool isStrangers(const struct stat& own, const std::filesystem::path& path)
{
    struct stat       folder {};
    const std::string parent = path.has_parent_path() ? path.parent_path().string() : ".";
    if (::stat(parent.c_str(), &folder) != 0) return false;
    const bool isTrusted = own.st_uid == ::geteuid() || own.st_uid == 0 || own.st_uid == folder.st_uid;
    return (folder.st_mode & S_IWOTH) && !isTrusted;
}

/// Refuses a link of somebody else, which the kernel does not follow either (fs.protected_symlinks) but whoever
/// resolves links by himself does; and his pipe or device, in which what is written would be lost to us.
/// \param what  "a link"
void refuseStrangers(const std::filesystem::path& path, const struct stat& own, const std::filesystem::path& place,
                     const std::string& what)
{
    if (isStrangers(own, place))
        refuseToWrite(path, place.string() + " is " + what +
                                " that another user put into a folder where anybody may write; remove it, or name "
                                "another place");
}

/// Opens what is there for writing: a pipe, /dev/null, or a file that grows.
/// \param place  where the links lead that stand in the path
/// \return -1, with errno, if the system refuses
int openThere(const std::filesystem::path& path, const std::filesystem::path& place, int how = 0)
{
    const auto  isLost = [&](const struct stat& of) { return !S_ISREG(of.st_mode) && isStrangers(of, place); };
    const auto  what   = [](const struct stat& of) { return S_ISFIFO(of.st_mode) ? "a pipe" : "a device or a socket"; };
    struct stat seen {};
    if (::stat(path.c_str(), &seen) == 0 && isLost(seen)) // a pipe may block
        refuseStrangers(path, seen, place, what(seen));
    // By the path itself: where /dev/stdout leads to a pipe, the text of its last link is no name.
    const int   handle = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | how);
    struct stat opened {};
    if (handle < 0 || ::fstat(handle, &opened) != 0 || !isLost(opened)) return handle;
    ::close(handle); // it was changed meanwhile
    refuseStrangers(path, opened, place, what(opened));
    return -1;
}

/// Returns where a path leads when each link in it is followed, so that a link stays a link when its file is replaced,
/// and no stranger's link is followed wherever it stands. What is not there yet keeps its name.
std::filesystem::path behindLinks(const std::filesystem::path& path)
{
    constexpr int                     kMostLinks = 40; // as the kernel has it
    std::filesystem::path             place;
    std::deque<std::filesystem::path> ahead(path.begin(), path.end());
    for (int links = 0; !ahead.empty();) {
        const std::filesystem::path next = place / ahead.front();
        ahead.pop_front();
        struct stat own {};
        if (::lstat(next.c_str(), &own) != 0 || !S_ISLNK(own.st_mode)) {
            place = next;
            continue;
        }
        if (++links > kMostLinks) refuseToWrite(path, "too many links lead from one to the next");
        refuseStrangers(path, own, next, "a link");
        std::error_code             failure;
        const std::filesystem::path target = std::filesystem::read_symlink(next, failure);
        if (failure) refuseToWrite(path, failure.message());
        struct stat there {
        }, spelled{}; // those of /proc lead where their text does not
        if (!ahead.empty() && ::stat(next.c_str(), &there) == 0 &&
            (::stat((place / target).c_str(), &spelled) != 0 || there.st_dev != spelled.st_dev ||
             there.st_ino != spelled.st_ino))
            refuseToWrite(path, next.string() + " leads elsewhere than its text says; name that folder itself");
        ahead.insert(ahead.begin(), target.begin(), target.end()); // an absolute one begins with /, which ends `place`
    }
    return place;
}

/// An open file, written by its handle: what else gets its name is not touched.
class OpenFile : public std::streambuf {
public:
    explicit OpenFile(int handle) : handle_(handle) { setp(bytes_.data(), bytes_.data() + bytes_.size()); }
    ~OpenFile() override { close(); }
    OpenFile(const OpenFile&)            = delete;
    OpenFile& operator=(const OpenFile&) = delete;

    [[nodiscard]] bool isOpen() const noexcept { return handle_ >= 0; }

    /// \return false with errno if the system could not keep the bytes
    bool close() { return handle_ < 0 || ::close(std::exchange(handle_, -1)) == 0; }

protected:
    int_type overflow(int_type next) override
    {
        if (sync() != 0) return traits_type::eof();
        return traits_type::eq_int_type(next, traits_type::eof()) ? traits_type::not_eof(next)
                                                                  : sputc(traits_type::to_char_type(next));
    }

    int sync() override
    {
        for (const char* at = pbase(); at != pptr();) {
            const ssize_t done = ::write(handle_, at, std::size_t(pptr() - at));
            if (done < 0 && errno != EINTR) return -1;
            at += done > 0 ? done : 0;
        }
        setp(bytes_.data(), bytes_.data() + bytes_.size());
        return 0;
    }

private:
    int                     handle_;
    std::array<char, 65536> bytes_;
};

/// What is written beside a path before it replaces the file there. Where the system can, it has no name until it is
/// whole, so that nothing is left of it when the program is killed.
class Draft {
public:
    explicit Draft(std::filesystem::path path) : path_(std::move(path))
    {
        const std::string folder = path_.has_parent_path() ? path_.parent_path().string() : ".";
#ifdef O_TMPFILE
        if (::access("/proc/self/fd", X_OK) == 0)
            handle_ = ::open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
#endif
        if (handle_ < 0)
            give([&](const char* name) {
                handle_ = ::open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
                return handle_ >= 0;
            });
    }
    ~Draft()
    {
        if (!name_.empty()) ::unlink(name_.c_str());
    }
    Draft(const Draft&)            = delete;
    Draft& operator=(const Draft&) = delete;

    /// Returns the draft's handle, which whoever writes closes; -1, with errno, if there is none.
    [[nodiscard]] int handle() const noexcept
    {
        return handle_;
    }

    /// Gives the draft a name, while its handle is open.
    /// \return false with errno if the system refuses
    bool name()
    {
        const std::string own = "/proc/self/fd/" + std::to_string(handle_);
        return !name_.empty() || give([&](const char* name) {
            return ::linkat(AT_FDCWD, own.c_str(), AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0;
        });
    }

    /// Puts the draft at its path.
    /// \return false with errno if the system refuses
    bool replace()
    {
        if (::rename(name_.c_str(), path_.c_str()) != 0) return false;
        name_.clear();
        return true;
    }

private:
    /// Tries names that nothing may have: two writers get two drafts, and a link that waits there is not followed.
    template <class Make>
    bool give(Make make)
    {
        constexpr int     kMostNames = 1000;
        const std::string stem       = path_.string() + "." + std::to_string(::getpid());
        for (int n = 0; n < kMostNames; ++n) {
            name_ = n == 0 ? stem + ".part" : stem + '.' + std::to_string(n) + ".part";
            if (make(name_.c_str())) return true;
            if (errno != EEXIST) break;
        }
        name_.clear();
        return false;
    }

    std::filesystem::path path_;
    std::string           name_; ///< empty: it has none
    int                   handle_ = -1;
};

/// Gives a draft the permissions of the file that it replaces: what was for one user's eyes stays so.
void keepMode(int handle, const std::filesystem::path& older)
{
    struct stat found {};
    if (::stat(older.c_str(), &found) == 0) static_cast<void>(!::fchmod(handle, found.st_mode & 0777));
}

/// Refuses what is there and cannot be written, a folder among it.
/// \param place  where the links in the path lead
void refuseProtected(const std::filesystem::path& path, const std::filesystem::path& place)
{
    std::error_code status;
    if (std::filesystem::is_directory(place, status)) refuseToWrite(path, "it is a folder; name a file in it");
    if (std::filesystem::exists(place, status) && ::faccessat(AT_FDCWD, place.c_str(), W_OK, AT_EACCESS) != 0)
        refuseToWrite(path, reasonOfErrno());
}

/// Refuses a folder in which no file can be made.
void refuseClosed(const std::filesystem::path& path, const std::filesystem::path& folder)
{
    errno = 0;
    if (std::error_code status; !std::filesystem::is_directory(folder, status))
        refuseToWrite(path, std::filesystem::exists(folder, status) ? std::strerror(ENOTDIR) : std::strerror(ENOENT));
    if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0) refuseToWrite(path, reasonOfErrno());
}

} // namespace

InputFile::Buffer::Buffer(const std::filesystem::path& path) : path_(path)
{
    errno = 0;
    if (!open(path, std::ios::in | std::ios::binary))
        throw Error(shownPath(path.string()) + ": cannot be read: " + reasonOfErrno());
}

InputFile::Buffer::int_type InputFile::Buffer::underflow()
try {
    return std::filebuf::underflow();
} catch (const std::ios_base::failure& failure) {
    throw Error(path_.string() + ": cannot be read to its end: " + failure.code().message());
}

std::streamsize InputFile::Buffer::xsgetn(char* to, std::streamsize count)
try {
    return std::filebuf::xsgetn(to, count);
} catch (const std::ios_base::failure& failure) {
    throw Error(path_.string() + ": cannot be read to its end: " + failure.code().message());
}

InputFile::InputFile(const std::filesystem::path& path) : std::istream(nullptr), buffer_(path)
{
    rdbuf(&buffer_);
    exceptions(std::ios::badbit); // what the buffer throws goes on to the reader
}

InputFile openForReading(const std::filesystem::path& path)
{
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        throw Error(path.string() + ": cannot be read: it is a folder; name a file in it");
    return InputFile(path);
}

InputFile openRegularFile(const std::filesystem::path& path)
{
    std::error_code ignored;
    if (std::filesystem::is_fifo(path, ignored))
        throw Error(path.string() + ": expected a regular file whose size is known, found a pipe; write what comes "
                                    "through it into a file, and name that");
    return openForReading(path);
}

bool isThere(const std::filesystem::path& path)
{
    std::error_code failure;
    const bool      there = std::filesystem::exists(path, failure);
    if (failure) throw Error(shownPath(path.string()) + ": cannot be read: " + failure.message());
    return there;
}

std::string sentenceOf(const std::filesystem::filesystem_error& error)
{
    const std::string path = error.path1().string();
    return (path.empty() ? "the current folder" : path) + ": " + error.code().message();
}

std::uint64_t sizeOfFile(const std::filesystem::path& path)
{
    std::error_code     failure;
    const std::uint64_t size = std::filesystem::file_size(path, failure);
    if (failure) throw Error(path.string() + ": expected a regular file whose size is known: " + failure.message());
    return size;
}

std::string readWhole(const std::filesystem::path& path, std::size_t most, const std::string& expected, Pipes pipes)
{
    InputFile   in = pipes == Pipes::read ? openForReading(path) : openRegularFile(path);
    std::string text;
    for (char part[65536]; text.size() <= most && in; text.append(part, std::size_t(in.gcount())))
        in.read(part, sizeof part);
    if (text.size() > most)
        throw Error(path.string() + ": longer than " + std::to_string(most) + " bytes; expected " + expected);
    return text;
}

void writeFileWhole(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write)
{
    // A device file or a pipe (/dev/stdout, /dev/null) must not be replaced by a file of the same name.
    std::error_code status;
    const bool replaceable = !std::filesystem::exists(path, status) || std::filesystem::is_regular_file(path, status);
    const std::filesystem::path place = behindLinks(path);
    refuseProtected(path, place);

    errno = 0;
    std::optional<Draft> draft;
    if (replaceable) draft.emplace(place);
    OpenFile file(draft ? draft->handle() : openThere(path, place));
    if (!file.isOpen()) refuseToWrite(path, reasonOfErrno());
    if (draft) keepMode(draft->handle(), place);
    std::ostream stream(&file);
    errno = 0; // a failure below, in `write` or in the last flush, sets it
    write(stream);
    if (!stream.flush() || (draft && !draft->name()) || !file.close() || (draft && !draft->replace()))
        refuseToWrite(path, reasonOfErrno());
}

void expectWritable(const std::filesystem::path& path)
{
    const std::filesystem::path place = behindLinks(path);
    refuseProtected(path, place);
    std::error_code status;
    if (!std::filesystem::exists(place, status) || std::filesystem::is_regular_file(place, status))
        refuseClosed(path, place.has_parent_path() ? place.parent_path() : ".");
}

void expectWritableFolder(const std::filesystem::path& path)
{
    std::filesystem::path place = behindLinks(path.has_filename() ? path : path.parent_path());
    for (std::error_code status; !std::filesystem::exists(place, status); place = place.parent_path())
        if (!place.has_parent_path()) return refuseClosed(path, ".");
    refuseClosed(path, place);
}

void appendToFile(const std::filesystem::path& path, std::string_view bytes)
{
    const int handle = openThere(path, behindLinks(path), O_APPEND);
    if (handle < 0) refuseToWrite(path, reasonOfErrno());
    const off_t before = ::lseek(handle, 0, SEEK_END);
    bool        good   = before >= 0;
    for (std::string_view rest = bytes; good && !rest.empty();) {
        const ssize_t written = ::write(handle, rest.data(), rest.size());
        good                  = written > 0 || (written < 0 && errno == EINTR);
        rest.remove_prefix(std::size_t(std::max(written, ssize_t(0))));
    }
    good                           = good && ::fsync(handle) == 0;
    const int                  why = errno;
    [[maybe_unused]] const int cut = good ? 0 : ::ftruncate(handle, before);
    ::close(handle); // what is synchronized has no fault left to say
    if (!good) refuseToWrite(path, std::strerror(why));
}

int makeFile(const std::filesystem::path& path)
{
    const std::filesystem::path place  = behindLinks(path.parent_path()) / path.filename(); // a link itself is refused
    const int                   handle = ::open(place.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
    if (handle < 0) throw Error(shownPath(path.string()) + ": cannot be made: " + reasonOfErrno());
    return handle;
}

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& taken)
    : handle_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC))
{
    if (handle_ < 0) throw Error(folder.string() + ": cannot be read: " + reasonOfErrno());
    if (::flock(handle_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(handle_);
    throw Error(folder.string() + ": " + taken);
}

FolderLock::~FolderLock()
{
    ::close(handle_);
}

void makeFolder(const std::filesystem::path& path)
{
    std::error_code       failure;
    std::filesystem::path made;
    for (const std::filesystem::path& step : path) { // one by one: what a step leads to is known once it is there
        made /= step;
        const std::filesystem::path place = behindLinks(made);
        if (!std::filesystem::exists(place, failure)) std::filesystem::create_directory(place, failure);
        if (failure) break;
    }
    if (failure || !std::filesystem::is_directory(behindLinks(path), failure)) // a link may have come meanwhile
        throw Error(shownPath(path.string()) +
                    ": the folder cannot be made: " + (failure ? failure.message() : "something else has that name"));
}

} // namespace palp
