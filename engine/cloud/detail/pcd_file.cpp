#include "engine/cloud/detail/pcd_file.h"

#include <algorithm>
#include <array>
#include <ostream>
#include <utility>

#include "engine/cloud/detail/cloud_rows.h"
#include "engine/cloud/detail/lzf.h"
#include "engine/cloud/detail/row_writer.h"
#include "engine/cloud/detail/scalar_type.h"
#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

/// Most numbers of a field; the largest fields in use are descriptors of about 1344.
constexpr std::uint64_t kMostNumbersPerField = 1u << 16;

struct Field {
    std::string   name;
    ScalarType    type{};
    std::uint64_t count = 1;
    std::size_t   slot  = kSlots; ///< RowSlot that it fills; kSlots: none

    std::uint64_t bytes() const { return count * sizeOf(type); }
    bool          isPadding() const { return name == "_"; }
};

enum class Encoding { ascii, binary, compressed };

struct PcdHeader {
    CloudHeader        cloud;
    Encoding           encoding{};
    std::uint64_t      points = 0;
    std::vector<Field> fields;
};

/// Reads the header of a file line by line; the entries may come in any order, but DATA is the last.
class HeaderParser {
public:
    explicit HeaderParser(ByteReader& reader) : reader_(reader) {}

    PcdHeader parse()
    {
        while (!parseLine()) {
        }
        combine();
        return std::move(header_);
    }

private:
    using Words = std::vector<std::string>;

    /// Reads the next line of the header.
    /// \return  true if it was the last
    bool parseLine()
    {
        const std::optional<std::string_view> line = reader_.lineWithText();
        if (!line) reader_.failAtByte("the file ends inside the header: expected a line DATA");
        std::string_view rest = *line;
        if (const std::string_view text = trimmed(rest); text.starts_with('#')) {
            header_.cloud.readComment(text.substr(1), reader_);
            return false;
        }
        const std::string_view key = nextWord(rest);
        Words                  words;
        for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) words.emplace_back(word);
        if (key == "DATA") {
            parseEncoding(words);
            return true;
        }
        Words* const entry = entryOf(key);
        if (!entry)
            reader_.failAtLine("expected VERSION, FIELDS, SIZE, TYPE, COUNT, WIDTH, HEIGHT, VIEWPOINT, POINTS or DATA, "
                               "found " +
                               inQuotes(*line));
        if (words.empty()) reader_.failAtLine("expected a value after " + std::string(key));
        if (!entry->empty()) reader_.failAtLine("expected one line " + std::string(key) + ", found a second");
        *entry = std::move(words);
        return false;
    }

    Words* entryOf(std::string_view key)
    {
        const std::array<std::pair<std::string_view, Words*>, 9> entries = {{{"VERSION", &version_},
                                                                             {"FIELDS", &names_},
                                                                             {"SIZE", &sizes_},
                                                                             {"TYPE", &types_},
                                                                             {"COUNT", &counts_},
                                                                             {"WIDTH", &width_},
                                                                             {"HEIGHT", &height_},
                                                                             {"VIEWPOINT", &viewpoint_},
                                                                             {"POINTS", &points_}}};
        for (const auto& [name, words] : entries)
            if (key == name) return words;
        return nullptr;
    }

    void parseEncoding(const Words& words)
    {
        const std::string encoding = words.size() == 1 ? words.front() : "";
        if (encoding == "ascii")
            header_.encoding = Encoding::ascii;
        else if (encoding == "binary")
            header_.encoding = Encoding::binary;
        else if (encoding == "binary_compressed")
            header_.encoding = Encoding::compressed;
        else
            reader_.failAtLine("expected DATA ascii, binary or binary_compressed, found " + inQuotes(encoding));
        header_.cloud.format = "PCD, " + encoding;
    }

    void combine()
    {
        const std::array<std::string_view, 6> known = {".5", "0.5", ".6", "0.6", ".7", "0.7"};
        if (version_.size() != 1 || std::find(known.begin(), known.end(), version_.front()) == known.end())
            reader_.fail("expected VERSION 0.5, 0.6 or 0.7 in the header, found " +
                         (version_.empty() ? "none" : inQuotes(version_.front())));
        if (names_.empty()) reader_.fail("expected a line FIELDS in the header, found none");
        if (counts_.empty()) counts_.assign(names_.size(), "1");
        for (const auto& [entry, words] : {std::pair("SIZE", &sizes_), {"TYPE", &types_}, {"COUNT", &counts_}})
            if (words->size() != names_.size())
                reader_.fail("expected " + std::to_string(names_.size()) + " values of " + entry +
                             " in the header, one for each of FIELDS, found " + std::to_string(words->size()));
        for (std::size_t i = 0; i < names_.size(); ++i) addField(i);
        countPoints();
    }

    void addField(std::size_t i)
    {
        Field field;
        field.name  = names_[i];
        field.type  = scalarType(types_[i], sizes_[i], field.name);
        field.count = parseCount(counts_[i]).value_or(0);
        if (field.count < 1 || field.count > kMostNumbersPerField)
            reader_.fail("expected a COUNT from 1 to " + std::to_string(kMostNumbersPerField) + " for field " +
                         inQuotes(field.name) + ", found " + inQuotes(counts_[i]));
        if (field.count == 1 && !field.isPadding()) header_.cloud.properties.push_back(field.name);
        header_.fields.push_back(std::move(field));
    }

    ScalarType scalarType(const std::string& type, const std::string& size, const std::string& field) const
    {
        using enum ScalarType;
        struct Known {
            std::string_view type, size;
            ScalarType       scalar;
        };
        constexpr std::array<Known, 10> kKnown = {{{"I", "1", int8},
                                                   {"I", "2", int16},
                                                   {"I", "4", int32},
                                                   {"I", "8", int64},
                                                   {"U", "1", uint8},
                                                   {"U", "2", uint16},
                                                   {"U", "4", uint32},
                                                   {"U", "8", uint64},
                                                   {"F", "4", float32},
                                                   {"F", "8", float64}}};
        for (const Known& known : kKnown)
            if (type == known.type && size == known.size) return known.scalar;
        reader_.fail("expected TYPE I or U of SIZE 1, 2, 4 or 8, or F of 4 or 8, for field " + inQuotes(field) +
                     ", found TYPE " + inQuotes(type) + " of SIZE " + inQuotes(size));
    }

    std::uint64_t numberOf(const char* entry, const Words& words) const
    {
        const auto number = words.size() == 1 ? parseCount(words.front()) : std::nullopt;
        if (!number)
            reader_.fail(std::string("expected one number from 0 up after ") + entry + " in the header, found " +
                         (words.empty() ? "none" : inQuotes(words.front())));
        return *number;
    }

    void countPoints()
    {
        const std::uint64_t width  = numberOf("WIDTH", width_);
        const std::uint64_t height = numberOf("HEIGHT", height_);
        if (height > 0 && width > UINT64_MAX / height)
            reader_.fail("WIDTH " + std::to_string(width) + " times HEIGHT " + std::to_string(height) +
                         " is too large");
        header_.points = points_.empty() ? width * height : numberOf("POINTS", points_);
        if (header_.points != width * height)
            reader_.fail("expected POINTS to be WIDTH times HEIGHT, " + std::to_string(width * height) + ", found " +
                         std::to_string(header_.points));
    }

    ByteReader& reader_;
    PcdHeader   header_;
    Words       version_, names_, sizes_, types_, counts_, width_, height_, viewpoint_, points_;
};

/// Reads `points` rows that each take a line.
void parseLines(ByteReader& reader, const PcdHeader& header, CloudRows& rows)
{
    for (std::uint64_t point = 0; point < header.points; ++point) {
        const auto line = reader.lineWithText();
        if (!line)
            reader.failAtByte("the file ends too early: expected " + std::to_string(header.points) + " points, found " +
                              std::to_string(point));
        std::string_view rest = *line;
        CloudRow         values{};
        for (const Field& field : header.fields)
            for (std::uint64_t k = 0; k < field.count; ++k) {
                const std::string_view word = nextWord(rest);
                if (word.empty())
                    reader.failAtLine("expected a number for field " + inQuotes(field.name) +
                                      ", found the end of the line");
                if (field.slot == kSlots) continue;
                const std::optional<double> value = parseNumber(word);
                if (!value)
                    reader.failAtLine("expected a number for field " + inQuotes(field.name) + ", found " +
                                      inQuotes(word));
                values[field.slot] = *value;
            }
        if (!nextWord(rest).empty())
            reader.failAtLine("expected the end of the line after field " + inQuotes(header.fields.back().name) +
                              ", found more numbers: " + inQuotes(*line));
        rows.add(values, CloudRows::Place::line);
    }
}

/// Reads `points` rows that each take the same number of bytes.
void parseRecords(ByteReader& reader, const PcdHeader& header, std::uint64_t recordBytes, CloudRows& rows)
{
    for (std::uint64_t point = 0; point < header.points; ++point) {
        const std::byte* at = reader.take(recordBytes);
        CloudRow         values{};
        for (const Field& field : header.fields) {
            if (field.slot != kSlots) values[field.slot] = loadScalar(field.type, at, std::endian::little);
            at += field.bytes();
        }
        rows.add(values, CloudRows::Place::byte);
    }
}

/// Reads the two sizes before compressed data and unpacks it. Its fields follow each other as wholes, all points of one
/// and then all of the next.
/// \param recordBytes  of a point
std::vector<std::byte> unpacked(ByteReader& reader, std::uint64_t points, std::uint64_t recordBytes)
{
    const auto packedSize = loadAs<std::uint32_t>(reader.take(sizeof(std::uint32_t)), std::endian::little);
    const auto size       = loadAs<std::uint32_t>(reader.take(sizeof(std::uint32_t)), std::endian::little);
    if (packedSize > reader.remaining())
        reader.failAtByte("the compressed data claims " + std::to_string(packedSize) + " bytes, but only " +
                          std::to_string(reader.remaining()) +
                          " follow; the file may have been cut short while it was copied");
    // By division: many wide fields may claim more bytes than 64 bits count.
    if (recordBytes == 0 ? size != 0 : size % recordBytes != 0 || size / recordBytes != points)
        reader.failAtByte("expected compressed data of " + std::to_string(points) + " points of " +
                          std::to_string(recordBytes) + " bytes, found " + std::to_string(size) + " bytes");
    reader.checkUnpacked(size);
    const std::uint64_t    begin = reader.offset();
    std::vector<std::byte> data(size);
    if (const auto wrong = unpackLzf({reader.take(packedSize), packedSize}, data))
        reader.fail("compressed data from byte " + std::to_string(begin) + " on: " + *wrong);
    return data;
}

/// Reads `points` rows of compressed data.
void parseCompressed(ByteReader& reader, PcdHeader& header, CloudRows& rows)
{
    if (header.points == 0) rows.expect(0, 1, CloudRows::Place::byte);
    std::uint64_t recordBytes = 0;
    std::erase_if(header.fields, [](const Field& field) { return field.isPadding(); }); // is not stored
    for (const Field& field : header.fields) recordBytes += field.bytes();
    const std::vector<std::byte> data = unpacked(reader, header.points, recordBytes);
    rows.makeRoom(header.points);
    for (std::uint64_t point = 0; point < header.points; ++point) {
        CloudRow         values{};
        const std::byte* column = data.data();
        for (const Field& field : header.fields) {
            if (field.slot != kSlots)
                values[field.slot] = loadScalar(field.type, column + point * field.bytes(), std::endian::little);
            column += header.points * field.bytes();
        }
        rows.add(values, CloudRows::Place::unpacked);
    }
}

} // namespace

LoadedCloud parsePcd(std::istream& stream, std::uint64_t size, const std::string& name,
                     const CloudReadSettings& settings)
{
    ByteReader reader(stream, size, name);
    PcdHeader  header = HeaderParser(reader).parse();
    CloudRows  rows(reader, header.cloud, settings);
    rows.omitUnseen();

    std::size_t   single      = 0; // index in CloudHeader::properties
    std::uint64_t recordBytes = 0;
    std::uint64_t numbers     = 0;
    for (Field& field : header.fields) {
        if (field.count == 1 && !field.isPadding()) field.slot = rows.slotOf(single++);
        recordBytes += field.bytes();
        numbers += field.count;
    }
    if (header.encoding == Encoding::ascii) {
        rows.expect(header.points, 2 * numbers, CloudRows::Place::line); // a digit and a separator
        parseLines(reader, header, rows);
        if (!reader.onlyBlanksLeft())
            reader.failAtByte("expected the end of the file after the last point, found " +
                              std::to_string(reader.remaining()) + " more bytes");
    } else if (header.encoding == Encoding::binary) {
        rows.expect(header.points, recordBytes, CloudRows::Place::byte);
        parseRecords(reader, header, recordBytes, rows);
    } else {
        parseCompressed(reader, header, rows);
    }
    if (header.encoding != Encoding::ascii) rows.warnOfTail();
    return rows.finish();
}

void formatPcd(std::ostream& stream, const PointCloud& cloud, std::span<const NamedField> extraFields,
               const CloudWriteSettings& settings)
{
    if (settings.encoding == CloudEncoding::binaryBigEndian)
        throw Error("a PCD file cannot be big-endian: choose little-endian or ascii, or write a PLY file");
    const RowWriter writer(cloud, extraFields);
    const auto      forEachColumn = [&](const char* entry, const auto& valueOf) {
        stream << entry;
        for (const std::string& column : writer.columns()) stream << ' ' << valueOf(column);
        stream << '\n';
    };
    stream << "# .PCD v0.7 - Point Cloud Data file format\n";
    for (const std::string& comment : writer.comments()) stream << "# " << comment << '\n';
    stream << "VERSION 0.7\n";
    forEachColumn("FIELDS", [](const std::string& column) { return column; });
    forEachColumn("SIZE", [](const std::string&) { return sizeof(double); });
    forEachColumn("TYPE", [](const std::string&) { return 'F'; });
    forEachColumn("COUNT", [](const std::string&) { return 1; });
    stream << "WIDTH " << cloud.size() << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << cloud.size() << '\n';
    if (settings.encoding == CloudEncoding::ascii) {
        stream << "DATA ascii\n";
        writer.writeText(stream, ' ');
    } else {
        stream << "DATA binary\n";
        writer.writeBinary(stream, std::endian::little);
    }
}

} // namespace palp
