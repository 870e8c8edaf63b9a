#include "engine/cloud/detail/ply_file.h"

#include <limits>
#include <ostream>
#include <utility>

#include "engine/cloud/detail/block_writer.h"
#include "engine/cloud/detail/cloud_rows.h"
#include "engine/cloud/detail/face_rows.h"
#include "engine/cloud/detail/ply_header.h"
#include "engine/cloud/detail/row_writer.h"
#include "engine/cloud/detail/scalar_type.h"
#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

/// Walks the rows of an element, whichever encoding they have.
class BodyParser {
public:
    BodyParser(ByteReader& reader, const PlyHeader& header, CloudRows& rows, FaceRows& faces)
        : reader_(reader), header_(header), rows_(rows), faces_(faces)
    {
    }

    void parse(const PlyElement& element, bool isVertex)
    {
        const std::uint64_t least = header_.leastBytes(element);
        if (isVertex)
            rows_.expect(element.count, least, header_.ascii ? CloudRows::Place::line : CloudRows::Place::byte);
        if (element.properties.empty()) return; // takes no room, however many rows the header promises
        if (element.count > (reader_.remaining() + 1) / least)
            reader_.failAtByte("the header promises " + std::to_string(element.count) + " rows of element " +
                               inQuotes(element.name) + " of at least " + std::to_string(least) + " bytes, but only " +
                               std::to_string(reader_.remaining()) + " bytes follow");
        expectFaces(element);
        if (header_.ascii)
            for (std::uint64_t row = 0; row < element.count; ++row) parseLine(element, row, isVertex);
        else if (!isVertex && !element.hasList())
            reader_.skip(element.count * least);
        else
            for (std::uint64_t row = 0; row < element.count; ++row) parseBytes(element, isVertex);
    }

private:
    void expectFaces(const PlyElement& element)
    {
        for (const PlyProperty& property : element.properties)
            if (property.holdsFaces)
                faces_.expect(element.count, header_.ascii ? 2 * (1 + 3) // digits and separators
                                                           : sizeOf(*property.listCount) + 3 * sizeOf(property.type));
    }

    void parseLine(const PlyElement& element, std::uint64_t row, bool isVertex)
    {
        const auto line = reader_.lineWithText();
        if (!line)
            reader_.failAtByte("the file ends too early: expected " + std::to_string(element.count) +
                               " rows of element " + inQuotes(element.name) + ", found " + std::to_string(row));
        std::string_view rest = *line;
        CloudRow         values{};
        for (const PlyProperty& property : element.properties) {
            const std::string_view word = nextWord(rest);
            if (word.empty())
                reader_.failAtLine("expected a number for " + inQuotes(property.name) + ", found the end of the line");
            if (property.listCount)
                parseListWords(property, word, rest);
            else if (property.slot != kSlots)
                values[property.slot] = number(property, word);
        }
        if (!nextWord(rest).empty())
            reader_.failAtLine("expected the end of the line after " + inQuotes(element.properties.back().name) +
                               ", found more numbers: " + inQuotes(*line));
        if (isVertex) rows_.add(values, CloudRows::Place::line);
    }

    double number(const PlyProperty& property, std::string_view word) const
    {
        const std::optional<double> value = parseNumber(word);
        if (!value)
            reader_.failAtLine("expected a number for " + inQuotes(property.name) + ", found " + inQuotes(word));
        return *value;
    }

    void parseListWords(const PlyProperty& property, std::string_view countWord, std::string_view& rest)
    {
        const std::uint64_t count = listLength(reader_, property, countWord);
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::string_view word = nextWord(rest);
            if (word.empty())
                reader_.failAtLine("list " + inQuotes(property.name) + " promises " + std::to_string(count) +
                                   " numbers, but the line ends after " + std::to_string(i));
            if (property.holdsFaces) faces_.addCorner(number(property, word), CloudRows::Place::line);
        }
        if (property.holdsFaces) faces_.endFace();
    }

    void parseBytes(const PlyElement& element, bool isVertex)
    {
        CloudRow values{};
        for (const PlyProperty& property : element.properties) {
            if (property.listCount) {
                parseListBytes(property);
                continue;
            }
            const std::byte* const bytes = reader_.take(sizeOf(property.type));
            if (property.slot != kSlots) values[property.slot] = loadScalar(property.type, bytes, header_.order);
        }
        if (isVertex) rows_.add(values, CloudRows::Place::byte);
    }

    void parseListBytes(const PlyProperty& property)
    {
        const std::byte* const length = reader_.take(sizeOf(*property.listCount));
        const std::uint64_t    count  = listLength(reader_, property, length, header_.order);
        const std::size_t      bytes  = sizeOf(property.type);
        if (!property.holdsFaces) return reader_.skip(count * bytes);
        for (std::uint64_t i = 0; i < count; ++i)
            faces_.addCorner(loadScalar(property.type, reader_.take(bytes), header_.order), CloudRows::Place::byte);
        faces_.endFace();
    }

    ByteReader&      reader_;
    const PlyHeader& header_;
    CloudRows&       rows_;
    FaceRows&        faces_;
};

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

/// Writes the rows of element face.
void writeFaces(std::ostream& stream, std::span<const Triangle> faces, std::size_t points, CloudEncoding encoding)
{
    const std::endian order = encoding == CloudEncoding::binaryBigEndian ? std::endian::big : std::endian::little;
    BlockWriter       out(stream);
    for (const Triangle& triangle : faces) {
        out.append(encoding == CloudEncoding::ascii ? "3" : "\3");
        for (const std::uint32_t corner : triangle) {
            PALP_EXPECT(corner < points, "a face names point " + std::to_string(corner));
            if (encoding == CloudEncoding::ascii) {
                out.append(" ");
                out.append(std::to_string(corner));
            } else {
                out.appendNumber(corner, order);
            }
        }
        if (encoding == CloudEncoding::ascii) out.append("\n");
    }
    out.flush();
}

} // namespace

LoadedCloud parsePly(std::istream& stream, std::uint64_t size, const std::string& name,
                     const CloudReadSettings& settings)
{
    ByteReader  reader(stream, size, name);
    PlyHeader   header = parsePlyHeader(reader);
    PlyElement& vertex = header.elements[header.vertex];
    CloudRows   rows(reader, header.cloud, settings);
    FaceRows    faces(reader, vertex.count);
    assignSlots(vertex, rows);

    BodyParser body(reader, header, rows, faces);
    for (std::size_t i = 0; i < header.elements.size(); ++i) body.parse(header.elements[i], i == header.vertex);
    if (!header.ascii) rows.warnOfTail();
    if (header.ascii && !reader.onlyBlanksLeft())
        reader.failAtByte("expected the end of the file after the last element, found " +
                          std::to_string(reader.remaining()) + " more bytes");
    LoadedCloud loaded = rows.finish();
    faces.finish(loaded);
    return loaded;
}

void formatPly(std::ostream& stream, const PointCloud& cloud, std::span<const NamedField> extraFields,
               const CloudWriteSettings& settings)
{
    const RowWriter writer(cloud, extraFields);
    stream << "ply\nformat " << formatName(settings.encoding) << " 1.0\n";
    for (const std::string& comment : writer.comments()) stream << "comment " << comment << '\n';
    stream << "element vertex " << cloud.size() << '\n';
    for (const std::string& column : writer.columns()) stream << "property double " << column << '\n';
    if (!settings.faces.empty())
        stream << "element face " << settings.faces.size() << "\nproperty list uchar "
               << (cloud.size() <= std::size_t(std::numeric_limits<std::int32_t>::max()) ? "int" : "uint")
               << " vertex_indices\n";
    stream << "end_header\n";
    if (settings.encoding == CloudEncoding::ascii)
        writer.writeText(stream, ' ');
    else
        writer.writeBinary(stream, settings.encoding == CloudEncoding::binaryBigEndian ? std::endian::big
                                                                                       : std::endian::little);
    writeFaces(stream, settings.faces, cloud.size(), settings.encoding);
}

} // namespace palp
