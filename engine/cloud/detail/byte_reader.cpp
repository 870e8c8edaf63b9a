#include "engine/cloud/detail/byte_reader.h"

#include <algorithm>
#include <cstring>
#include <istream>

#include "engine/core/contract.h"

namespace palp {
namespace {

/// Block size [bytes]: large enough that the calls of the stream cost nothing, small enough for the second-level cache.
constexpr std::size_t kBlock = std::size_t(1) << 20;

/// Longest line that is read [bytes]; a thousand-sided face has about 8 KiB. Must not exceed kBlock.
constexpr std::size_t kLongestLine = std::size_t(1) << 16;

/// Longest text of a file that a message repeats [characters].

bool isBlank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

} // namespace

bool isBlankText(std::string_view text)
{
    return std::all_of(text.begin(), text.end(), isBlank);
}

std::string_view lineEndOf(std::string_view rawLine)
{
    std::string_view text = rawLine;
    for (const char end : {'\n', '\r'})
        if (!text.empty() && text.back() == end) text.remove_suffix(1);
    return rawLine.substr(text.size());
}

ByteReader::ByteReader(std::istream& stream, std::uint64_t size, std::string name)
    : stream_(stream), size_(size), name_(std::move(name)), buffer_(std::size_t(std::min<std::uint64_t>(size, kBlock)))
{
}

bool ByteReader::readMore()
{
    if (begin_ > 0) {
        std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
        bytesBefore_ += begin_;
        end_ -= begin_;
        begin_ = 0;
    }
    const std::uint64_t unread = size_ - bytesBefore_ - end_;
    const std::size_t   room   = std::size_t(std::min<std::uint64_t>(unread, buffer_.size() - end_));
    if (room == 0) return false;
    stream_.read(buffer_.data() + end_, std::streamsize(room));
    const auto found = std::size_t(stream_.gcount());
    end_ += found;
    return found > 0;
}

void ByteReader::refill(std::size_t needed)
{
    const auto truncated = [&](std::uint64_t found) {
        failAtByte("the file ends too early: expected " + std::to_string(needed) + " more bytes, found " +
                   std::to_string(found) + "; it may have been cut short while it was copied");
    };
    if (needed > remaining()) truncated(remaining());
    if (needed > buffer_.size()) buffer_.resize(needed);
    while (end_ - begin_ < needed)
        if (!readMore()) truncated(end_ - begin_);
}

std::optional<std::string_view> ByteReader::rawLine()
{
    std::size_t searched = 0; // bytes after begin_ without a line end
    for (;;) {
        const char* const from = buffer_.data() + begin_;
        const std::size_t held = end_ - begin_;
        const auto* const lineEnd =
            held > searched ? static_cast<const char*>(std::memchr(from + searched, '\n', held - searched)) : nullptr;
        if (lineEnd || !readMore()) { // a full block without a line end counts as the end
            const std::size_t length = lineEnd ? std::size_t(lineEnd - from) : end_ - begin_;
            if (!lineEnd && length == 0) return std::nullopt;
            ++lineNumber_;
            if (length > kLongestLine)
                failAtLine("expected a line of at most " + std::to_string(kLongestLine) +
                           " bytes, found a longer one; is this another kind of file, or one with CR line ends?");
            const std::string_view text(buffer_.data() + begin_, length + (lineEnd ? 1 : 0));
            begin_ += text.size();
            return text;
        }
        searched = held;
    }
}

std::optional<std::string_view> ByteReader::line()
{
    const std::optional<std::string_view> raw = rawLine();
    return raw ? std::optional(raw->substr(0, raw->size() - lineEndOf(*raw).size())) : std::nullopt;
}

std::optional<std::string_view> ByteReader::lineWithText()
{
    for (;;) {
        const std::optional<std::string_view> text = line();
        if (!text || !isBlankText(*text)) return text;
    }
}

void ByteReader::skip(std::uint64_t count)
{
    if (count > remaining()) refill(std::size_t(count));
    while (count > 0) {
        const auto step = std::size_t(std::min<std::uint64_t>(count, kBlock));
        static_cast<void>(take(step));
        count -= step;
    }
}

void ByteReader::checkUnpacked(std::uint64_t bytes) const
{
    constexpr std::uint64_t kTimes = 100, kAlways = 4u << 20; // [bytes]
    if (bytes > kAlways && bytes / kTimes > size_)
        failAtByte("what is packed or repeated claims to hold " + std::to_string(bytes) + " bytes, more than " +
                   std::to_string(kTimes) + " times the file's " + std::to_string(size_) +
                   "; expected a smaller size: is the file damaged? Its program can save it without compression");
}

bool ByteReader::onlyBlanksLeft()
{
    do {
        while (begin_ < end_)
            if (!isBlank(buffer_[begin_++])) {
                --begin_;
                return false;
            }
    } while (readMore());
    return true;
}

void ByteReader::failAtLine(const std::string& message) const
{
    fail("line " + std::to_string(lineNumber_) + ": " + message);
}

void ByteReader::failAtByte(const std::string& message) const
{
    fail("byte " + std::to_string(offset()) + ": " + message);
}

void ByteReader::fail(const std::string& message) const
{
    throw Error(name_ + ": " + message);
}

} // namespace palp
