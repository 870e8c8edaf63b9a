#include "engine/core/npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/core/file.h"
#include "engine/core/shown_text.h"

// The format: "\x93NUMPY", version (2 bytes), length of the header (2 bytes in version 1, else 4, little endian), the
// header (a Python dictionary such as {'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }), the numbers.
// Source: NumPy Enhancement Proposal 1, "A simple file format for NumPy arrays".

namespace palp {
namespace {

static_assert(std::endian::native == std::endian::little, ".npy numbers are copied as they lie in the file");

constexpr std::string_view kMagic{"\x93NUMPY", 6};

/// The longest header that is read [bytes]: real ones have some 80.
constexpr std::uint64_t kLongestHeader = 65536;

std::string shortened(std::string_view text)
{
    return shownText(text, kMostOfWord);
}

/// A reader of a stream that has `left` bytes; it reports where the stream ends too early.
class Bytes {
public:
    Bytes(std::istream& in, std::uint64_t size, const std::string& name)
        : in_(in), size_(size), left_(size), name_(name)
    {
    }

    void read(char* to, std::uint64_t count, const char* what)
    {
        if (count <= left_) in_.read(to, std::streamsize(count));
        if (count > left_ || std::uint64_t(in_.gcount()) != count)
            throw Error(name_ + ": the file ends within " + what + ": expected " + std::to_string(count) +
                        " bytes from byte " + std::to_string(size_ - left_) + " on, found " + std::to_string(left_));
        left_ -= count;
    }

    [[nodiscard]] std::uint64_t left() const noexcept { return left_; }

private:
    std::istream&      in_;
    std::uint64_t      size_;
    std::uint64_t      left_;
    const std::string& name_;
};

/// The header's dictionary; a value keeps its Python spelling.
struct Header {
    std::string_view type;    ///< '<f8'
    std::string_view fortran; ///< False
    std::string_view shape;   ///< (3, 4)
};

/// Returns the text of `key`'s value, up to the comma or brace that ends it outside brackets and quotes; nullopt if the
/// key is absent.
std::optional<std::string_view> valueOf(std::string_view dictionary, std::string_view key)
{
    for (const char quote : {'\'', '"'}) {
        const std::string spelling = quote + std::string(key) + quote;
        const std::size_t at       = dictionary.find(spelling);
        if (at == std::string_view::npos) continue;
        std::string_view rest = dictionary.substr(at + spelling.size());
        rest.remove_prefix(std::min(rest.size(), rest.find_first_not_of(" :")));
        int         depth = 0;
        std::size_t end   = 0;
        for (; end < rest.size(); ++end) {
            if (depth == 0 && (rest[end] == ',' || rest[end] == '}')) break;
            if (rest[end] == '(' || rest[end] == '[') ++depth;
            if (rest[end] == ')' || rest[end] == ']') --depth;
        }
        return rest.substr(0, end);
    }
    return std::nullopt;
}

Header parseHeader(std::string_view text, const std::string& name)
{
    const auto need = [&](std::string_view key) {
        const auto value = valueOf(text, key);
        if (!value) throw Error(name + ": the .npy header has no '" + std::string(key) + "': " + shortened(text));
        return *value;
    };
    return {need("descr"), need("fortran_order"), need("shape")};
}

/// Returns the bytes of one number: 8 or 4.
std::size_t numberSize(const Header& header, const std::string& name)
{
    if (header.type == "'<f8'" || header.type == "\"<f8\"") return sizeof(double);
    if (header.type == "'<f4'" || header.type == "\"<f4\"") return sizeof(float);
    throw Error(name + ": expected numbers of type '<f8' or '<f4' (little-endian float64 or float32), found " +
                shortened(header.type) + "; save array.astype('<f8')");
}

/// Returns the sizes of an array of two or three dimensions, each from 1 to below 2^31.
std::vector<std::uint64_t> shapeOf(const Header& header, std::size_t dimensions, const std::string& name)
{
    std::vector<std::uint64_t> sizes;
    std::string_view           rest  = header.shape;
    bool                       good  = rest.starts_with('(') && rest.ends_with(')');
    constexpr std::uint64_t    kMost = std::numeric_limits<int>::max();
    while (good) {
        rest.remove_prefix(std::min(rest.find_first_not_of("(, "), rest.size()));
        if (rest.empty() || rest == ")") break;
        std::uint64_t size  = 0;
        const auto [end, e] = std::from_chars(rest.data(), rest.data() + rest.size(), size);
        if (e == std::errc::result_out_of_range) size = kMost + 1;
        good = e != std::errc::invalid_argument;
        rest.remove_prefix(std::size_t(end - rest.data()));
        sizes.push_back(size);
    }
    const bool plane = dimensions == 2;
    good             = good && sizes.size() == dimensions && std::ranges::min(sizes) >= 1;
    if (good && std::ranges::max(sizes) > kMost)
        throw Error(name + ": the array is too large: expected at most " + std::to_string(kMost) +
                    (plane ? " rows and columns" : " values along each axis") + ", found shape " +
                    shortened(header.shape));
    if (!good)
        throw Error(name + ": expected an array of " +
                    (plane ? "two dimensions, shape (m, n) with m, n >= 1" : "three dimensions, shape (l, m, n)") +
                    ", found shape " + shortened(header.shape));
    return sizes;
}

/// Calls to(row) for `rows` rows of `columns` numbers each.
template <class Number>
void readRows(Bytes& bytes, std::uint64_t rows, std::size_t columns,
              const std::function<void(std::span<const double>)>& to)
{
    std::vector<Number> stored(columns);
    std::vector<double> row(columns);
    for (std::uint64_t i = 0; i < rows; ++i) {
        bytes.read(reinterpret_cast<char*>(stored.data()), columns * sizeof(Number), "its numbers");
        std::copy(stored.begin(), stored.end(), row.begin());
        to(row);
    }
}

std::uint64_t headerLength(Bytes& bytes, const std::string& name)
{
    std::array<unsigned char, 2> version{};
    bytes.read(reinterpret_cast<char*>(version.data()), version.size(), "its version");
    if (version[0] < 1 || version[0] > 3)
        throw Error(name + ": expected .npy version 1, 2 or 3, found " + std::to_string(version[0]));
    std::array<unsigned char, 4> raw{};
    bytes.read(reinterpret_cast<char*>(raw.data()), version[0] == 1 ? 2 : 4, "the length of its header");
    const std::uint64_t length =
        raw[0] | std::uint64_t(raw[1]) << 8 | std::uint64_t(raw[2]) << 16 | std::uint64_t(raw[3]) << 24;
    if (length > std::min(bytes.left(), kLongestHeader))
        throw Error(name + ": the .npy header claims " + std::to_string(length) + " bytes, but " +
                    std::to_string(bytes.left()) + " are left and at most " + std::to_string(kLongestHeader) +
                    " are read");
    return length;
}

/// An array whose header has been read.
struct OpenArray {
    std::vector<std::uint64_t> shape;
    std::size_t                eachBytes = 0; ///< of a number
    bool                       fortran   = false;
};

OpenArray openArray(Bytes& bytes, std::uint64_t size, std::size_t dimensions, bool mayHaveTail, const std::string& name)
{
    std::string magic(std::min<std::uint64_t>(size, kMagic.size()), '\0');
    bytes.read(magic.data(), magic.size(), "its first bytes");
    if (magic != kMagic)
        throw Error(name + ": not a .npy file: it does not begin with \\x93NUMPY; save it with numpy.save");

    std::string text(headerLength(bytes, name), '\0');
    bytes.read(text.data(), text.size(), "its header");
    const Header header = parseHeader(text, name);
    OpenArray    array;
    array.eachBytes = numberSize(header, name);
    array.fortran   = header.fortran == "True";
    if (header.fortran != "False" && !(array.fortran && dimensions == 3))
        throw Error(name + ": expected C order ('fortran_order': False), found " + shortened(header.fortran) +
                    "; save numpy.ascontiguousarray(array)");

    array.shape                 = shapeOf(header, dimensions, name);
    const std::uint64_t all     = bytes.left() / array.eachBytes;
    std::uint64_t       numbers = 1;
    std::string         shape;
    for (const std::uint64_t each : array.shape) {
        numbers = each > 0 && numbers > std::numeric_limits<std::uint64_t>::max() / each
                      ? std::numeric_limits<std::uint64_t>::max()
                      : numbers * each;
        shape += (shape.empty() ? "" : " x ") + std::to_string(each);
    }
    const bool whole = bytes.left() % array.eachBytes == 0 && numbers == all;
    if (!whole && !(mayHaveTail && numbers <= all))
        throw Error(name + ": a shape of " + shape + " asks for " + std::to_string(numbers) + " numbers of " +
                    std::to_string(array.eachBytes) + " bytes, found " + std::to_string(bytes.left()) + " bytes");
    return array;
}

void readAll(Bytes& bytes, const OpenArray& array, const std::function<void(std::span<const double>)>& to)
{
    const std::uint64_t columns = array.shape.back();
    std::uint64_t       rows    = 1;
    for (std::size_t k = 0; k + 1 < array.shape.size(); ++k) rows *= array.shape[k];
    if (array.eachBytes == sizeof(double))
        readRows<double>(bytes, rows, std::size_t(columns), to);
    else
        readRows<float>(bytes, rows, std::size_t(columns), to);
}

} // namespace

void readNpyRows(std::istream& in, std::uint64_t size, const std::string& name, const NpyRows& to)
{
    Bytes           bytes(in, size, name);
    const OpenArray array = openArray(bytes, size, 2, bool(to.tail), name);
    to.begin(std::size_t(array.shape[0]), std::size_t(array.shape[1]));
    readAll(bytes, array, to.row);
    if (to.tail && bytes.left() > 0) to.tail(size - bytes.left(), bytes.left());
}

void readNpyVolume(std::istream& in, std::uint64_t size, const std::string& name, const NpyVolume& to)
{
    Bytes           bytes(in, size, name);
    const OpenArray array = openArray(bytes, size, 3, false, name);
    to.begin({int(array.shape[0]), int(array.shape[1]), int(array.shape[2])}, array.fortran);
    readAll(bytes, array, to.values);
}

NodeField parseNpy(std::istream& in, std::uint64_t size, const std::string& name)
{
    std::optional<NodeField> field;
    int                      i = 0;
    readNpyRows(in, size, name,
                {[&](std::size_t rows, std::size_t columns) { field.emplace(int(rows), int(columns)); },
                 [&](std::span<const double> row) {
                     for (int j = 0; j < field->nodesZ(); ++j) {
                         const double value = row[std::size_t(j)];
                         if (!std::isfinite(value))
                             throw Error(name + ": the value at [" + std::to_string(i) + ", " + std::to_string(j) +
                                         "] is " + (std::isnan(value) ? "NaN" : "infinite") +
                                         "; expected finite numbers");
                         (*field)(i, j) = value;
                     }
                     ++i;
                 }});
    return std::move(*field);
}

NodeField readNpy(const std::filesystem::path& path)
{
    InputFile       in = openRegularFile(path);
    std::error_code failure;
    const auto      size = std::filesystem::file_size(path, failure);
    if (failure) throw Error(path.string() + ": cannot be read: " + failure.message());
    return parseNpy(in, size, path.string());
}

void writeNpy(const std::filesystem::path& path, const NodeField& field)
{
    constexpr std::size_t kAlignment = 64; // [bytes] of everything before the numbers, as the format asks
    constexpr std::size_t kBefore    = 10; // [bytes] before the header: magic, version, length
    std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(field.nodesX()) + ", " +
                         std::to_string(field.nodesZ()) + "), }";
    header.append(kAlignment - 1 - (kBefore + header.size()) % kAlignment, ' ');
    header += '\n';
    writeFileWhole(path, [&](std::ostream& out) {
        out.write(kMagic.data(), std::streamsize(kMagic.size()));
        const std::array<char, 4> versionAndLength = {1, 0, char(header.size() & 0xff), char(header.size() >> 8)};
        out.write(versionAndLength.data(), versionAndLength.size());
        out.write(header.data(), std::streamsize(header.size()));
        out.write(reinterpret_cast<const char*>(field.values().data()),
                  std::streamsize(field.values().size() * sizeof(double)));
    });
}

} // namespace palp
