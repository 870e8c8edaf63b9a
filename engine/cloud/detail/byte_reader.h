#pragma once
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/shown_text.h"

namespace palp {

/// Returns true if the text holds nothing but blanks, tabs and line ends.
[[nodiscard]] bool isBlankText(std::string_view text);

/// Returns the end of a raw line: LF, CR LF, or at the end of a file CR or nothing.
[[nodiscard]] std::string_view lineEndOf(std::string_view rawLine);

/// Reads a hostile stream in large blocks and always knows the line and the byte it is at.
/// \thread one
class ByteReader {
public:
    /// \param size  of the stream [bytes]; nothing beyond it is read
    /// \param name  of the file, for messages
    ByteReader(std::istream& stream, std::uint64_t size, std::string name);

    /// Returns the next line without its end (LF or CR LF), nothing at the end of the file; valid until the next call.
    /// \throws Error if the line is longer than 64 KiB
    [[nodiscard]] std::optional<std::string_view> line();

    /// Returns the same with its end, as the bytes stand in the file.
    [[nodiscard]] std::optional<std::string_view> rawLine();

    /// Returns the next line that holds more than blanks; nothing at the end of the file.
    [[nodiscard]] std::optional<std::string_view> lineWithText();

    /// Returns the next bytes, valid until the next call.
    /// \throws Error if the file ends before
    [[nodiscard]] const std::byte* take(std::size_t count)
    {
        if (end_ - begin_ < count) refill(count);
        const char* const taken = buffer_.data() + begin_;
        begin_ += count;
        return reinterpret_cast<const std::byte*>(taken);
    }

    /// Passes over bytes.
    /// \throws Error if the file ends before
    void skip(std::uint64_t count);

    /// Checks the stated size of unpacked data before anything takes memory for it: up to 4 MiB, or a hundred times the
    /// file, because an array of equal numbers packs well and stands beside points that do not.
    /// \throws Error naming both sizes if it is larger
    void checkUnpacked(std::uint64_t bytes) const;

    /// Reads blanks, tabs and line ends; returns true if nothing else was left.
    [[nodiscard]] bool onlyBlanksLeft();

    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::uint64_t      size() const noexcept { return size_; }                   ///< [bytes]
    [[nodiscard]] std::uint64_t      offset() const noexcept { return bytesBefore_ + begin_; } ///< of the next byte
    [[nodiscard]] std::uint64_t      remaining() const noexcept { return size_ - offset(); }   ///< [bytes]
    [[nodiscard]] std::uint64_t      lineNumber() const noexcept { return lineNumber_; } ///< of the last line, from 1

    /// Refuses the line read last.
    /// \throws Error "NAME: line N: MESSAGE" about the line read last
    [[noreturn]] void failAtLine(const std::string& message) const;
    /// Refuses the next byte.
    /// \throws Error "NAME: byte N: MESSAGE" about the next byte
    [[noreturn]] void failAtByte(const std::string& message) const;
    /// Refuses the file.
    /// \throws Error "NAME: MESSAGE"
    [[noreturn]] void fail(const std::string& message) const;

private:
    void refill(std::size_t needed);
    bool readMore();

    std::istream&     stream_;
    std::uint64_t     size_;
    std::string       name_;
    std::vector<char> buffer_; ///< bytes begin_ to end_ are read and not yet given out
    std::size_t       begin_       = 0;
    std::size_t       end_         = 0;
    std::uint64_t     bytesBefore_ = 0; ///< the file's offset of buffer_[0]
    std::uint64_t     lineNumber_  = 0;
};

} // namespace palp
