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
    constexpr std::size_t kMost = 60; // [bytes] of a file's own text in an error
    std::string           plain;
    for (const char c : text.substr(0, kMost)) plain += c >= ' ' && c <= '~' ? c : '?';
    return text.size() <= kMost ? plain : plain + "...";
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

std::array<int, 2> shapeOf(const Header& header, const std::string& name)
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
    if (good && sizes.size() == 2 && std::max(sizes[0], sizes[1]) > kMost)
        throw Error(name + ": the array is too large: expected at most " + std::to_string(kMost) +
                    " rows and columns, found shape " + shortened(header.shape));
    if (!good || sizes.size() != 2 || sizes[0] < 1 || sizes[1] < 1)
        throw Error(name + ": expected an array of two dimensions, shape (m, n) with m, n >= 1, found shape " +
                    shortened(header.shape));
    return {int(sizes[0]), int(sizes[1])};
}

template <class Number>
void readRows(Bytes& bytes, const std::array<int, 2>& shape, const NpyRows& to)
{
    const std::size_t   columns = std::size_t(shape[1]);
    std::vector<Number> stored(columns);
    std::vector<double> row(columns);
    for (int i = 0; i < shape[0]; ++i) {
        bytes.read(reinterpret_cast<char*>(stored.data()), columns * sizeof(Number), "its numbers");
        std::copy(stored.begin(), stored.end(), row.begin());
        to.row(row);
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

} // namespace

void readNpyRows(std::istream& in, std::uint64_t size, const std::string& name, const NpyRows& to)
{
    Bytes       bytes(in, size, name);
    std::string magic(std::min<std::uint64_t>(size, kMagic.size()), '\0');
    bytes.read(magic.data(), magic.size(), "its first bytes");
    if (magic != kMagic)
        throw Error(name + ": not a .npy file: it does not begin with \\x93NUMPY; save it with numpy.save");

    std::string text(headerLength(bytes, name), '\0');
    bytes.read(text.data(), text.size(), "its header");
    const Header      header    = parseHeader(text, name);
    const std::size_t eachBytes = numberSize(header, name);
    if (header.fortran != "False")
        throw Error(name + ": expected C order ('fortran_order': False), found " + shortened(header.fortran) +
                    "; save numpy.ascontiguousarray(array)");

    // Two dimensions below 2^31 and 8 bytes each stay below 2^65: divide instead of multiplying, then compare.
    const std::array<int, 2> shape   = shapeOf(header, name);
    const std::uint64_t      numbers = std::uint64_t(shape[0]) * std::uint64_t(shape[1]);
    if (bytes.left() % eachBytes != 0 || numbers != bytes.left() / eachBytes)
        throw Error(name + ": a shape of " + std::to_string(shape[0]) + " x " + std::to_string(shape[1]) +
                    " asks for " + std::to_string(numbers) + " numbers of " + std::to_string(eachBytes) +
                    " bytes, found " + std::to_string(bytes.left()) + " bytes");
    to.begin(std::size_t(shape[0]), std::size_t(shape[1]));
    if (eachBytes == sizeof(double))
        readRows<double>(bytes, shape, to);
    else
        readRows<float>(bytes, shape, to);
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
    std::ifstream   in = openForReading(path);
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
