#include "engine/cloud/ply_file.h"

#include <array>
#include <limits>
#include <ostream>
#include <utility>

#include "engine/cloud/cloud_rows.h"
#include "engine/cloud/row_writer.h"
#include "engine/cloud/scalar_type.h"
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

struct Property {
    std::string               name;
    ScalarType                type{};
    std::optional<ScalarType> listCount;     ///< type of a list's length; empty: a single number
    std::size_t               slot = kSlots; ///< RowSlot that it fills; kSlots: none
};

struct Element {
    std::string           name;
    std::uint64_t         count = 0;
    std::vector<Property> properties;
};

struct PlyHeader {
    CloudHeader          cloud;
    bool                 ascii = false;
    std::endian          order = std::endian::little;
    std::vector<Element> elements;
    std::size_t          vertex = 0; ///< index of the element that holds the points
};

/// Reads the head of a file line by line.
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
        Property         property;
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
        for (const Property& property : elements[header_.vertex].properties)
            if (!property.listCount) header_.cloud.properties.push_back(property.name);
    }

    ByteReader& reader_;
    PlyHeader   header_;
};

/// Walks the rows of an element, whichever encoding they have.
class BodyParser {
public:
    BodyParser(ByteReader& reader, const PlyHeader& header, CloudRows& rows)
        : reader_(reader), header_(header), rows_(rows)
    {
    }

    void parse(const Element& element, bool isVertex)
    {
        const std::uint64_t least = leastBytes(element);
        if (isVertex)
            rows_.expect(element.count, least, header_.ascii ? CloudRows::Place::line : CloudRows::Place::byte);
        if (element.properties.empty()) return; // takes no room, however many rows the header promises
        if (element.count > (reader_.remaining() + 1) / least)
            reader_.failAtByte("the header promises " + std::to_string(element.count) + " rows of element " +
                               inQuotes(element.name) + " of at least " + std::to_string(least) + " bytes, but only " +
                               std::to_string(reader_.remaining()) + " bytes follow");
        if (header_.ascii)
            for (std::uint64_t row = 0; row < element.count; ++row) parseLine(element, row, isVertex);
        else if (!isVertex && !hasList(element))
            reader_.skip(element.count * least);
        else
            for (std::uint64_t row = 0; row < element.count; ++row) parseBytes(element, isVertex);
    }

private:
    static bool hasList(const Element& element)
    {
        for (const Property& property : element.properties)
            if (property.listCount) return true;
        return false;
    }

    /// The fewest bytes that a row can take; in a text a number takes a digit and a separator.
    std::uint64_t leastBytes(const Element& element) const
    {
        std::uint64_t bytes = 0;
        for (const Property& property : element.properties)
            bytes += header_.ascii ? 2 : sizeOf(property.listCount.value_or(property.type));
        return bytes;
    }

    void parseLine(const Element& element, std::uint64_t row, bool isVertex)
    {
        const auto line = reader_.lineWithText();
        if (!line)
            reader_.failAtByte("the file ends too early: expected " + std::to_string(element.count) +
                               " rows of element " + inQuotes(element.name) + ", found " + std::to_string(row));
        std::string_view rest = *line;
        CloudRow         values{};
        for (const Property& property : element.properties) {
            const std::string_view word = nextWord(rest);
            if (word.empty())
                reader_.failAtLine("expected a number for " + inQuotes(property.name) + ", found the end of the line");
            if (property.listCount)
                skipListWords(property, word, rest);
            else if (property.slot != kSlots)
                values[property.slot] = number(property, word);
        }
        if (!nextWord(rest).empty())
            reader_.failAtLine("expected the end of the line after " + inQuotes(element.properties.back().name) +
                               ", found more numbers: " + inQuotes(*line));
        if (isVertex) rows_.add(values, CloudRows::Place::line);
    }

    double number(const Property& property, std::string_view word) const
    {
        const std::optional<double> value = parseNumber(word);
        if (!value)
            reader_.failAtLine("expected a number for " + inQuotes(property.name) + ", found " + inQuotes(word));
        return *value;
    }

    void skipListWords(const Property& property, std::string_view countWord, std::string_view& rest) const
    {
        const auto count = parseCount(countWord);
        if (!count)
            reader_.failAtLine("expected a length from 0 up for list " + inQuotes(property.name) + ", found " +
                               inQuotes(countWord));
        for (std::uint64_t i = 0; i < *count; ++i)
            if (nextWord(rest).empty())
                reader_.failAtLine("list " + inQuotes(property.name) + " promises " + std::to_string(*count) +
                                   " numbers, but the line ends after " + std::to_string(i));
    }

    void parseBytes(const Element& element, bool isVertex)
    {
        CloudRow values{};
        for (const Property& property : element.properties) {
            if (property.listCount) {
                skipListBytes(property);
                continue;
            }
            const std::byte* const bytes = reader_.take(sizeOf(property.type));
            if (property.slot != kSlots) values[property.slot] = loadScalar(property.type, bytes, header_.order);
        }
        if (isVertex) rows_.add(values, CloudRows::Place::byte);
    }

    void skipListBytes(const Property& property)
    {
        const std::size_t   itemBytes = sizeOf(property.type);
        const std::uint64_t at        = reader_.offset();
        const double count = loadScalar(*property.listCount, reader_.take(sizeOf(*property.listCount)), header_.order);
        const std::uint64_t room = reader_.remaining() / itemBytes;
        if (count < 0 || count > double(room)) // lengths have at most 32 bits, so the double is exact
            reader_.fail("byte " + std::to_string(at) + ": expected a length from 0 to " + std::to_string(room) +
                         " for list " + inQuotes(property.name) + ", found " + std::to_string(std::int64_t(count)));
        reader_.skip(std::uint64_t(count) * itemBytes);
    }

    ByteReader&      reader_;
    const PlyHeader& header_;
    CloudRows&       rows_;
};

/// Marks the properties that a cloud is made of.
void assignSlots(Element& vertex, const CloudRows& rows)
{
    std::size_t single = 0; // index in CloudHeader::properties
    for (Property& property : vertex.properties)
        if (!property.listCount) property.slot = rows.slotOf(single++);
}

const char* formatName(CloudEncoding encoding)
{
    switch (encoding) {
    case CloudEncoding::ascii:
        return "ascii";
    case CloudEncoding::binaryBigEndian:
        return "binary_big_endian";
    case CloudEncoding::binaryLittleEndian:
        return "binary_little_endian";
    }
    return "";
}

} // namespace

LoadedCloud parsePly(std::istream& stream, std::uint64_t size, const std::string& name,
                     const CloudReadSettings& settings)
{
    ByteReader reader(stream, size, name);
    PlyHeader  header = HeaderParser(reader).parse();
    CloudRows  rows(reader, header.cloud, settings);
    assignSlots(header.elements[header.vertex], rows);

    BodyParser body(reader, header, rows);
    for (std::size_t i = 0; i < header.elements.size(); ++i) body.parse(header.elements[i], i == header.vertex);
    if (header.ascii ? !reader.onlyBlanksLeft() : reader.remaining() > 0)
        reader.failAtByte("expected the end of the file after the last element, found " +
                          std::to_string(reader.remaining()) + " more bytes");
    return rows.finish();
}

void formatPly(std::ostream& stream, const PointCloud& cloud, std::span<const NamedField> extraFields,
               CloudEncoding encoding)
{
    const RowWriter writer(cloud, extraFields);
    stream << "ply\nformat " << formatName(encoding) << " 1.0\n";
    for (const std::string& comment : writer.comments()) stream << "comment " << comment << '\n';
    stream << "element vertex " << cloud.size() << '\n';
    for (const std::string& column : writer.columns()) stream << "property double " << column << '\n';
    stream << "end_header\n";
    if (encoding == CloudEncoding::ascii)
        writer.writeText(stream, ' ');
    else
        writer.writeBinary(stream, encoding == CloudEncoding::binaryBigEndian ? std::endian::big : std::endian::little);
}

} // namespace palp
