#include "engine/cloud/detail/numbers.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"

namespace palp {

void WholeFile::failAtLine(const char* at, const std::string& message) const
{
    const auto line = 1 + std::count(text.data(), at, '\n');
    reader.fail("line " + std::to_string(line) + ": " + message);
}

void WholeFile::failAtByte(const char* at, const std::string& message) const
{
    reader.fail("byte " + std::to_string(at - text.data()) + ": " + message);
}

Numbers::Numbers(const WholeFile& file, std::string what, std::string_view text)
    : file_(file), what_(std::move(what)), isText_(true), text_(text)
{
}

Numbers::Numbers(const WholeFile& file, std::string what, ScalarType type, std::endian order,
                 std::vector<std::byte> bytes)
    : file_(file), what_(std::move(what)), isText_(false), own_(std::move(bytes)), bytes_(own_), type_(type),
      order_(order)
{
}

Numbers::Numbers(const WholeFile& file, std::string what, ScalarType type, std::endian order,
                 std::span<const std::byte> bytes)
    : file_(file), what_(std::move(what)), isText_(false), bytes_(bytes), type_(type), order_(order)
{
}

void Numbers::fail(const std::string& message) const
{
    const std::string said = what_ + ": " + message;
    if (isText_) file_.failAtLine(text_.data(), said);
    file_.reader.fail(said);
}

void Numbers::skipBlanks() noexcept
{
    text_.remove_prefix(std::min(text_.find_first_not_of(" \t\r\n"), text_.size()));
}

double Numbers::next()
{
    if (!isText_) {
        const std::size_t size = sizeOf(type_);
        if (bytes_.size() < size) fail("expected more numbers, found only " + std::to_string(read_));
        const double value = loadScalar(type_, bytes_.data(), order_);
        bytes_             = bytes_.subspan(size);
        ++read_;
        return value;
    }
    skipBlanks();
    if (text_.empty()) fail("expected more numbers, found only " + std::to_string(read_));
    const std::string_view word  = text_.substr(0, text_.find_first_of(" \t\r\n"));
    const auto             value = parseNumber(word);
    if (!value) fail("expected a number, found " + inQuotes(word));
    text_.remove_prefix(word.size());
    ++read_;
    return *value;
}

std::uint64_t Numbers::nextIndex(std::uint64_t end)
{
    const double value = next();
    if (!(value >= 0 && value < double(end)) || value != std::floor(value)) // NaN fails every comparison
        fail("number " + std::to_string(read_ - 1) + ": expected a whole number from 0 to below " +
             std::to_string(end) + ", found " + shown(value));
    return std::uint64_t(value);
}

void Numbers::expectAtLeast(std::uint64_t tuples, std::uint64_t numbersPerTuple) const
{
    const std::uint64_t room = isText_ ? (text_.size() + 1) / 2 : bytes_.size() / sizeOf(type_); // a digit and a blank
    if (tuples > room / numbersPerTuple)
        fail("expected " + std::to_string(tuples) + " times " + std::to_string(numbersPerTuple) +
             " numbers, found room for " + std::to_string(room) + "; was the file cut short?");
}

void Numbers::expectEnd()
{
    if (isText_) skipBlanks();
    if (isText_ ? !text_.empty() : !bytes_.empty()) fail("expected " + std::to_string(read_) + " numbers, found more");
}

} // namespace palp
