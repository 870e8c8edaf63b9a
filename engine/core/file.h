#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <istream>
#include <string>
#include <string_view>
#include <utility>

namespace palp {

/// A file that is read, in binary. A read that fails, as on a disk with an error, is no end of the file: it throws an
/// Error that names the path.
/// \thread one
class InputFile : public std::istream {
public:
    /// \throws Error "PATH: cannot be read: REASON"
    explicit InputFile(const std::filesystem::path& path);
    InputFile(InputFile&& from) noexcept(false) : std::istream(std::move(from)), buffer_(std::move(from.buffer_))
    {
        set_rdbuf(&buffer_);
    }

private:
    class Buffer : public std::filebuf {
    public:
        explicit Buffer(const std::filesystem::path& path);

    protected:
        int_type        underflow() override;
        std::streamsize xsgetn(char* to, std::streamsize count) override;

    private:
        std::filesystem::path path_;
    };
    Buffer buffer_;
};

/// Opens a file for binary reading.
/// \throws Error "PATH: cannot be read: REASON" (missing, a folder, no permission)
[[nodiscard]] InputFile openForReading(const std::filesystem::path& path);

/// Opens a file for binary reading whose size has to be known before.
/// \throws Error as openForReading() does, and for a named pipe, which would wait for a writer
[[nodiscard]] InputFile openRegularFile(const std::filesystem::path& path);

/// Returns the size of a file [bytes].
/// \throws Error naming the path if it is no regular file
[[nodiscard]] std::uint64_t sizeOfFile(const std::filesystem::path& path);

/// Returns whether there is a file or a folder of that name.
/// \throws Error naming the path where the system cannot say, as on a server that does not answer: none is no answer
///         then
[[nodiscard]] bool isThere(const std::filesystem::path& path);

/// Returns the sentence of an error of the file system that nobody expected: the path and the reason.
[[nodiscard]] std::string sentenceOf(const std::filesystem::filesystem_error& error);

/// What a pipe is where a file is expected: read to its end, or refused where nobody means one, as in the folder of a
/// recording, because a pipe that nobody writes into is waited for without an end.
enum class Pipes { read, refused };

/// Returns the whole content of a small file.
/// \param most      largest size that is accepted [bytes]
/// \param expected  description of such a file, for the error about one that is longer
/// \throws Error naming the path and the reason
[[nodiscard]] std::string readWhole(const std::filesystem::path& path, std::size_t most, const std::string& expected,
                                    Pipes pipes = Pipes::read);

/// Writes a file whole or not at all: `write` fills a temporary file beside `path`, which is then renamed over it.
/// After a failure (an exception in `write`, a full disk) an older file at `path` is as it was and no partly written
/// file remains. The file keeps the permissions of the older one, which is refused if it is write-protected. A link
/// stays a link, and its file is replaced. A link that another user, neither root nor the folder's owner, put into a
/// folder where anybody may write, such as /tmp, is refused wherever it stands in the path, here and by each function
/// below that writes.
/// \throws Error naming the path and the reason
void writeFileWhole(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// Refuses what could not be written, as far as that can be told before: so that nobody works for minutes first.
/// \throws Error as writeFileWhole() does: a folder of that name, no folder for it, no permission; a stranger's link
void expectWritable(const std::filesystem::path& path);

/// Does the same for a folder that makeFolder() is to make, or that is there.
/// \throws Error naming the path and the reason
void expectWritableFolder(const std::filesystem::path& path);

/// Appends bytes to a file that is there, and waits until the disk has them. After a failure the file has its former
/// length again, or ends in a part of the bytes where the system refuses that, too.
/// \throws Error naming the path and the reason
void appendToFile(const std::filesystem::path& path, std::string_view bytes);

/// Makes a new file, and opens it for writing.
/// \return its handle, which the caller closes
/// \throws Error naming the path and the reason; also if there is something of that name
[[nodiscard]] int makeFile(const std::filesystem::path& path);

/// The right to write into a folder, for one process at a time. The system ends it with the process, however that ends.
class FolderLock {
public:
    /// \param taken  what to say where another process has it, "FOLDER: " stands before it
    /// \throws Error if another process has it, or there is no such folder; where the file system knows no locks it is
    ///         given
    FolderLock(const std::filesystem::path& folder, const std::string& taken);
    ~FolderLock();
    FolderLock(const FolderLock&)            = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int handle_;
};

/// Creates a folder and its parents.
/// \throws Error naming the path and the reason
void makeFolder(const std::filesystem::path& path);

} // namespace palp
