#include "engine/cloud/detail/ply_header.h"

#include <array>
#include <string_view>
#include <utility>

#include "engine/cloud/tokens.h"

namespace palp {
namespace {

struct TypeName {
    std::string_view oldName; ///< of Turk's format
    std::string_view newName; ///< of later writers
    ScalarType       type;
};

constexpr std::array kTypeNames = {
    TypeName{"char", "int8", ScalarType::int8},        TypeName{"uchar", "uint8", ScalarType::uint8},
    TypeName{"short", "int16", ScalarType::int16},     TypeName{"ushort", "uint16", ScalarType::uint16},
    TypeName{"int", "int32", ScalarType::int32},       TypeName{"uint", "uint32", ScalarType::uint32},
    TypeName{"float", "float32", ScalarType::float32}, TypeName{"double", "float64", ScalarType::float64}};

constexpr const char* kKnownTypes = "char, uchar, short, ushort, int, uint, float, double or int8 ... float64";

/// The list that makes up a face, by its two usual names.
constexpr std::array<std::string_view, 2> kFaceLists = {"vertex_indices", "vertex_index"};

/// Reads the header of a file line by line.
class HeaderParser {
public:
    explicit HeaderParser(ByteReader& reader) : reader_(reader) {}

    PlyHeader parse()
    {
        if (reader_.line() != "ply") reader_.failAtLine("expected the first line to be \"ply\": this is no PLY file");
        for (;;) {
            const std::optional<std::string_view> line = reader_.line();
            if (!line) reader_.failAtByte("the file ends inside the header: expected a line end_header");
            std::string_view       rest = *line;
            const std::string_view key  = nextWord(rest);
            if (key == "end_header") break;
            if (key == "comment")
                header_.cloud.readComment(rest, reader_);
            else if (key != "obj_info")
                parseDeclaration(key, rest, *line);
        }
        findVertices();
        for (PlyElement& element : header_.elements)
            if (element.name == "face") findFaces(element);
        return std::move(header_);
    }

private:
    void parseDeclaration(std::string_view key, std::string_view rest, std::string_view line)
    {
        if (key == "format")
            parseFormat(rest);
        else if (key == "element")
            parseElement(rest);
        else if (key == "property")
            parseProperty(rest);
        else
            reader_.failAtLine("expected format, element, property, comment, obj_info or end_header, found " +
                               inQuotes(line));
        if (!trimmed(rest).empty()) reader_.failAtLine("unexpected words at the end of " + inQuotes(line));
    }

    void parseFormat(std::string_view& rest)
    {
        const std::string_view format  = nextWord(rest);
        const std::string_view version = nextWord(rest);
        if (!header_.cloud.format.empty()) reader_.failAtLine("expected one line format, found a second");
        if (format == "ascii") {
            header_.ascii        = true;
            header_.cloud.format = "PLY, ascii";
        } else if (format == "binary_little_endian") {
            header_.cloud.format = "PLY, binary little-endian";
        } else if (format == "binary_big_endian") {
            header_.order        = std::endian::big;
            header_.cloud.format = "PLY, binary big-endian";
        } else {
            reader_.failAtLine("expected format ascii, binary_little_endian or binary_big_endian, found " +
                               inQuotes(format));
        }
        if (version != "1.0") reader_.failAtLine("expected format version 1.0, found " + inQuotes(version));
    }

    void parseElement(std::string_view& rest)
    {
        const std::string_view name  = nextWord(rest);
        const std::string_view count = nextWord(rest);
        const auto             rows  = parseCount(count);
        if (name.empty()) reader_.failAtLine("expected element NAME COUNT, found no name");
        if (!rows)
            reader_.failAtLine("expected a number of rows from 0 up for element " + inQuotes(name) + ", found " +
                               inQuotes(count));
        header_.elements.push_back({std::string(name), *rows, {}});
    }

    void parseProperty(std::string_view& rest)
    {
        if (header_.elements.empty()) reader_.failAtLine("expected an element before the first property");
        PlyProperty      property;
        std::string_view type = nextWord(rest);
        if (type == "list") {
            property.listCount = parseType(nextWord(rest));
            if (isFloat(*property.listCount))
                reader_.failAtLine("expected a whole-number type for the length of a list, found a floating one");
            type = nextWord(rest);
        }
        property.type = parseType(type);
        property.name = std::string(nextWord(rest));
        if (property.name.empty()) reader_.failAtLine("expected property TYPE NAME, found no name");
        header_.elements.back().properties.push_back(std::move(property));
    }

    ScalarType parseType(std::string_view word) const
    {
        for (const TypeName& known : kTypeNames)
            if (word == known.oldName || word == known.newName) return known.type;
        reader_.failAtLine(std::string("expected a type ") + kKnownTypes + ", found " + inQuotes(word));
    }

    void findVertices()
    {
        if (header_.cloud.format.empty()) reader_.fail("expected a line format in the header, found none");
        const auto&       elements = header_.elements;
        const std::size_t none     = elements.size();
        header_.vertex             = none;
        for (std::size_t i = 0; i < elements.size(); ++i) {
            if (elements[i].name != "vertex") continue;
            if (header_.vertex != none) reader_.fail("expected one element vertex in the header, found several");
            header_.vertex = i;
        }
        if (header_.vertex == none) reader_.fail("expected an element vertex in the header, found none");
        for (const PlyProperty& property : elements[header_.vertex].properties)
            if (!property.listCount) header_.cloud.properties.push_back(property.name);
    }

    static void findFaces(PlyElement& element)
    {
        for (const std::string_view name : kFaceLists)
            for (PlyProperty& property : element.properties)
                if (property.listCount && property.name == name) {
                    property.holdsFaces = true;
                    return;
                }
    }

    ByteReader& reader_;
    PlyHeader   header_;
};

} // namespace

bool PlyElement::hasList() const noexcept
{
    for (const PlyProperty& property : properties)
        if (property.listCount) return true;
    return false;
}

std::uint64_t PlyHeader::leastBytes(const PlyElement& element) const noexcept
{
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : element.properties)
        bytes += ascii ? 2 : sizeOf(property.listCount.value_or(property.type));
    return bytes;
}

PlyHeader parsePlyHeader(ByteReader& reader)
{
    return HeaderParser(reader).parse();
}

void assignSlots(PlyElement& vertex, const CloudRows& rows)
{
    std::size_t single = 0; // index in CloudHeader::properties
    for (PlyProperty& property : vertex.properties)
        if (!property.listCount) property.slot = rows.slotOf(single++);
}

std::uint64_t listLength(const ByteReader& reader, const PlyProperty& list, const std::byte* bytes, std::endian order)
{
    const double        count = loadScalar(*list.listCount, bytes, order);
    const std::uint64_t room  = reader.remaining() / sizeOf(list.type);
    if (count < 0 || count > double(room)) // lengths have at most 32 bits, so the double is exact
        reader.fail("byte " + std::to_string(reader.offset() - sizeOf(*list.listCount)) + ": list " +
                    inQuotes(list.name) + " promises " + std::to_string(std::int64_t(count)) +
                    " values, expected from 0 to " + std::to_string(room) +
                    ", for which the file has bytes left; it may have been cut short while it was copied");
    return std::uint64_t(count);
}

std::uint64_t listLength(const ByteReader& reader, const PlyProperty& list, std::string_view word)
{
    const auto count = parseCount(word);
    if (!count)
        reader.failAtLine("expected a length from 0 up for list " + inQuotes(list.name) + ", found " + inQuotes(word));
    return *count;
}

} // namespace palp
