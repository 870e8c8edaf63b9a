#include "engine/cloud/detail/stl_file.h"

#include <array>
#include <bit>
#include <istream>
#include <limits>
#include <optional>

#include "engine/cloud/detail/cloud_rows.h"
#include "engine/cloud/detail/face_rows.h"
#include "engine/cloud/detail/scalar_type.h"
#include "engine/cloud/tokens.h"

namespace palp {
namespace {

constexpr std::uint64_t kHeader   = 80; ///< bytes that mean nothing
constexpr std::uint64_t kBefore   = kHeader + sizeof(std::uint32_t);
constexpr std::uint64_t kTriangle = 50; ///< bytes: normal and corners as 12 floats, and two bytes of attributes

/// Triangles that three corners each can number.
constexpr std::uint64_t kMostTriangles = (std::numeric_limits<std::uint32_t>::max() - 1) / 3;

CloudHeader headerOf(const char* format)
{
    CloudHeader header;
    header.format     = format;
    header.properties = {"x", "y", "z"};
    return header;
}

/// Points and faces of a file of triangles: each brings its own three corners.
class Soup {
public:
    Soup(const ByteReader& reader, const char* format, const CloudReadSettings& settings)
        : rows_(reader, headerOf(format), settings), faces_(reader, std::numeric_limits<std::uint32_t>::max())
    {
        rows_.expectRepeats(); // every corner is in the file once for each of its triangles
    }

    CloudRows& rows() noexcept { return rows_; }
    FaceRows&  faces() noexcept { return faces_; }

    void addCorner(double x, double y, double z, CloudRows::Place place)
    {
        CloudRow row{};
        row[kSlotX] = x, row[kSlotY] = y, row[kSlotZ] = z;
        rows_.add(row, place);
        faces_.addCorner(double(corners_++), place);
    }

    void endFace() { faces_.endFace(); }

    [[nodiscard]] std::uint64_t triangles() const noexcept { return corners_ / 3; }

    LoadedCloud finish()
    {
        LoadedCloud loaded = rows_.finish();
        faces_.finish(loaded);
        return loaded;
    }

private:
    CloudRows     rows_;
    FaceRows      faces_;
    std::uint32_t corners_ = 0;
};

LoadedCloud parseBinary(ByteReader& reader, const CloudReadSettings& settings)
{
    reader.skip(kHeader);
    const auto triangles = loadAs<std::uint32_t>(reader.take(sizeof(std::uint32_t)), std::endian::little);
    if (triangles > kMostTriangles)
        reader.fail("expected at most " + std::to_string(kMostTriangles) + " triangles, found " +
                    std::to_string(triangles));
    Soup soup(reader, "STL, binary", settings);
    soup.rows().expect(3 * std::uint64_t(triangles), kTriangle / 3, CloudRows::Place::byte);
    soup.faces().expect(triangles, kTriangle);
    for (std::uint32_t n = 0; n < triangles; ++n) {
        const std::byte* const bytes = reader.take(kTriangle);
        const auto             at    = [&](std::size_t number) {
            return double(loadAs<float>(bytes + number * sizeof(float), std::endian::little));
        };
        for (std::size_t corner = 1; corner <= 3; ++corner)
            soup.addCorner(at(3 * corner), at(3 * corner + 1), at(3 * corner + 2), CloudRows::Place::byte);
        soup.endFace();
    }
    soup.rows().warnOfTail();
    return soup.finish();
}

/// Reads the words of an ASCII file, which may stand on lines as they like except for the name of a solid.
class AsciiParser {
public:
    AsciiParser(ByteReader& reader, const CloudReadSettings& settings)
        : reader_(reader), soup_(reader, "STL, ascii", settings)
    {
    }

    LoadedCloud parse()
    {
        for (auto word = next(); word; word = next()) {
            if (*word != "solid") refuse("solid", *word);
            rest_ = {}; // the name
            takeSolid();
        }
        return soup_.finish();
    }

private:
    void takeSolid()
    {
        for (;;) {
            const std::string_view word = need("facet or endsolid");
            if (word == "endsolid") break;
            if (word != "facet") refuse("facet or endsolid", word);
            takeFacet();
        }
        rest_ = {}; // the name once more
    }

    void takeFacet()
    {
        if (soup_.triangles() == kMostTriangles)
            reader_.failAtLine("expected at most " + std::to_string(kMostTriangles) + " triangles, found more");
        expect("normal");
        for (int k = 0; k < 3; ++k) static_cast<void>(number(Normal::unused));
        expect("outer");
        expect("loop");
        for (int corner = 0; corner < 3; ++corner) {
            expect("vertex");
            const double x = number(), y = number(), z = number();
            soup_.addCorner(x, y, z, CloudRows::Place::line);
        }
        expect("endloop");
        expect("endfacet");
        soup_.endFace();
    }

    enum class Normal { unused, no };

    /// Returns a number; that of a normal, of which programs write what they like, may be any word.
    double number(Normal of = Normal::no)
    {
        const std::string_view      word  = need("a number");
        const std::optional<double> value = parseNumber(word);
        if (!value && of == Normal::no) refuse("a number", word);
        return value.value_or(0);
    }

    void expect(std::string_view wanted)
    {
        const std::string_view word = need(wanted);
        if (word != wanted) refuse(wanted, word);
    }

    std::string_view need(std::string_view wanted)
    {
        const auto word = next();
        if (!word)
            reader_.failAtByte("the file ends too early: expected " + std::string(wanted) +
                               "; it may have been cut short while it was copied");
        return *word;
    }

    /// Returns the next word in small letters; nothing at the end of the file.
    std::optional<std::string_view> next()
    {
        std::string_view word = nextWord(rest_);
        while (word.empty()) {
            const auto line = reader_.lineWithText();
            if (!line) return std::nullopt;
            rest_ = *line;
            word  = nextWord(rest_);
        }
        word_.assign(word);
        for (char& c : word_)
            if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
        return word_;
    }

    [[noreturn]] void refuse(std::string_view wanted, std::string_view found) const
    {
        reader_.failAtLine("expected " + std::string(wanted) + ", found " + inQuotes(found));
    }

    ByteReader&      reader_;
    Soup             soup_;
    std::string_view rest_; ///< of the line
    std::string      word_;
};

/// Returns the number of triangles that a binary file would state; nothing if it is too short for one.
std::optional<std::uint32_t> statedTriangles(std::istream& stream, std::uint64_t size)
{
    if (size < kBefore) return std::nullopt;
    std::array<char, kBefore> head{};
    stream.read(head.data(), std::streamsize(head.size()));
    const bool whole = stream.gcount() == std::streamsize(head.size());
    stream.clear();
    stream.seekg(0);
    if (!whole) return std::nullopt;
    return loadAs<std::uint32_t>(reinterpret_cast<const std::byte*>(head.data()) + kHeader, std::endian::little);
}

/// Returns whether a file begins as text: some programs begin the header of a binary one with "solid" too, but have
/// zeros behind it, in the number of triangles at the latest.
bool isText(std::istream& stream)
{
    std::array<char, kBefore> head{};
    stream.read(head.data(), std::streamsize(head.size()));
    const std::string_view start(head.data(), std::size_t(stream.gcount()));
    stream.clear();
    stream.seekg(0);
    return start.starts_with("solid") && start.find('\0') == std::string_view::npos;
}

} // namespace

LoadedCloud parseStl(std::istream& stream, std::uint64_t size, const std::string& name,
                     const CloudReadSettings& settings)
{
    const auto triangles = statedTriangles(stream, size);
    // Some programs pad. The four bytes of text that an ASCII file has in place of the number promise more than it
    // holds.
    const bool isWhole  = triangles && size == kBefore + kTriangle * *triangles;
    const bool isPadded = triangles && *triangles > 0 && size > kBefore + kTriangle * *triangles;
    const bool isBinary = isWhole || isPadded;
    const bool isAscii  = !isBinary && isText(stream);
    ByteReader reader(stream, size, name);
    if (isBinary) return parseBinary(reader, settings);
    if (isAscii) return AsciiParser(reader, settings).parse();
    reader.fail(triangles ? "byte " + std::to_string(kHeader) + ": expected an STL file of " +
                                std::to_string(kBefore + kTriangle * *triangles) + " bytes for " +
                                std::to_string(*triangles) + " triangles, found " + std::to_string(size) +
                                " bytes; it may have been cut short while it was copied"
                          : "byte 0: expected an STL file, which begins with \"solid\" or has at least " +
                                std::to_string(kBefore) + " bytes, found " + std::to_string(size) + " other bytes");
}

} // namespace palp
