#pragma once
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>

namespace palp {

/// A new file that grows, and whose beginning may be written again.
class GrowingFile {
public:
    /// Makes the file.
    /// \throws Error if there is one of that name, or none can be made
    explicit GrowingFile(std::filesystem::path path);
    ~GrowingFile();
    GrowingFile(const GrowingFile&)            = delete;
    GrowingFile& operator=(const GrowingFile&) = delete;

    /// Writes bytes at a place.
    /// \throws Error naming the file and the reason; then some of the bytes may stand in it
    void write(std::string_view bytes, std::uint64_t at);

    /// Writes at the end of the complete part; accept() counts the bytes as complete, undo() drops them.
    /// \throws Error as write()
    void append(std::string_view bytes);
    void accept() noexcept { whole_ += std::exchange(pending_, 0); }
    void undo() noexcept;

    /// Closes the file: some file systems say only then that there was no room. Nothing is called after it.
    /// \throws Error naming the file and the reason
    void close();

    /// Returns false if another program has moved or removed the file; true where the system does not say.
    [[nodiscard]] bool isThere() const noexcept;
    /// Returns whether another program has cut the complete part.
    [[nodiscard]] bool isCut() const noexcept;

private:
    std::filesystem::path path_;
    int                   handle_;
    std::uint64_t         whole_   = 0; ///< [bytes]
    std::uint64_t         pending_ = 0; ///< [bytes]
    bool                  cut_     = false;
};

} // namespace palp
