#include "engine/cloud/detail/vtk_file.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "engine/cloud/detail/vtk_pieces.h"
#include "engine/cloud/tokens.h"

namespace palp {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

/// Most numbers of a tuple; the largest in use are descriptors.
constexpr std::uint64_t kMostComponents = 1u << 16;

struct TypeName {
    std::string_view          name; ///< in capital letters
    std::optional<ScalarType> type; ///< empty: bits, eight in a byte
};

constexpr std::array kTypeNames = {
    TypeName{"BIT", std::nullopt},
    TypeName{"CHAR", ScalarType::int8},
    TypeName{"SIGNED_CHAR", ScalarType::int8},
    TypeName{"UNSIGNED_CHAR", ScalarType::uint8},
    TypeName{"SHORT", ScalarType::int16},
    TypeName{"UNSIGNED_SHORT", ScalarType::uint16},
    TypeName{"INT", ScalarType::int32},
    TypeName{"UNSIGNED_INT", ScalarType::uint32},
    TypeName{"LONG", ScalarType::int64},
    TypeName{"UNSIGNED_LONG", ScalarType::uint64},
    TypeName{"FLOAT", ScalarType::float32},
    TypeName{"DOUBLE", ScalarType::float64},
    TypeName{"VTKIDTYPE", ScalarType::int32}, // whatever it is in memory
    TypeName{"VTKTYPEINT64", ScalarType::int64},
    TypeName{"VTKTYPEUINT64", ScalarType::uint64},
};

std::string capitals(std::string_view word)
{
    std::string text(word);
    for (char& c : text)
        if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
    return text;
}

/// Returns a name with its %-escapes replaced: blanks and control characters are written so.
std::string unescaped(std::string_view word)
{
    const auto digit = [](char c) { return c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1; };
    std::string text;
    for (std::size_t i = 0; i < word.size(); ++i) {
        const bool escape = word[i] == '%' && i + 2 < word.size() && digit(word[i + 1]) >= 0 && digit(word[i + 2]) >= 0;
        text += escape ? char(16 * digit(word[i + 1]) + digit(word[i + 2])) : word[i];
        if (escape) i += 2;
    }
    return text;
}

/// Reads the keywords of a file and where its arrays lie; the arrays themselves are read when they are used.
class VtkParser {
public:
    explicit VtkParser(const WholeFile& file) : file_(file), rest_(file.text) {}

    VtkPiece parse()
    {
        parseHeader();
        while (const auto line = textLine()) parseEntry(*line);
        if (!hasPoints_) fail("expected POINTS");
        const auto& grid = piece_.dimensions;
        if (dataset_ == "STRUCTURED_GRID" && grid.empty()) fail("expected DIMENSIONS");
        if (!grid.empty() && grid[0] * grid[1] * grid[2] != piece_.points)
            file_.reader.fail("expected POINTS to be the product of DIMENSIONS, " +
                              std::to_string(grid[0] * grid[1] * grid[2]) + ", found " + std::to_string(piece_.points));
        for (VtkCells& cells : piece_.cells)
            if (cells.kind == VtkCells::Kind::mixed) {
                if (!types_ || typeCount_ != cells.count)
                    file_.reader.fail("expected CELL_TYPES for the " + std::to_string(cells.count) +
                                      " of CELLS, found " + (types_ ? std::to_string(typeCount_) : "none"));
                cells.types = types_;
            }
        return std::move(piece_);
    }

    [[nodiscard]] std::string format() const { return std::string("VTK, ") + (ascii_ ? "ascii" : "binary"); }

private:
    using Words = std::vector<std::string_view>;

    [[noreturn]] void fail(const std::string& message) const
    {
        const std::string_view found = trimmed(rest_.substr(0, rest_.find('\n')));
        const std::string      said  = message + ", found " + (rest_.empty() ? "the end of the file" : inQuotes(found));
        if (ascii_) file_.failAtLine(rest_.data(), said);
        file_.failAtByte(rest_.data(), said);
    }

    [[noreturn]] void failBefore(std::string_view line, const std::string& message) const
    {
        const std::string said = message + ", found " + inQuotes(line);
        if (ascii_) file_.failAtLine(line.data(), said);
        file_.failAtByte(line.data(), said);
    }

    std::string_view line()
    {
        const std::size_t      end  = std::min(rest_.find('\n'), rest_.size());
        const std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        return text.substr(0, text.size() - (text.ends_with('\r') ? 1 : 0));
    }

    /// Passes over blanks and returns the next line; nothing at the end of the file.
    std::optional<std::string_view> textLine()
    {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
        if (rest_.empty()) return std::nullopt;
        return line();
    }

    Words wordsOf(std::string_view text, std::size_t least, const char* form) const
    {
        Words            words;
        std::string_view rest = text;
        for (std::string_view word = nextWord(rest); !word.empty() && words.size() < 8; word = nextWord(rest))
            words.push_back(word);
        if (words.size() < least) failBefore(text, std::string("expected ") + form);
        return words;
    }

    std::uint64_t countIn(std::string_view word) const
    {
        const auto count = parseCount(word);
        if (!count) failBefore(word, "expected a number from 0 up");
        return *count;
    }

    void parseHeader()
    {
        if (!rest_.starts_with("# vtk DataFile Version"))
            fail("expected a first line \"# vtk DataFile Version\": this is no VTK file");
        static_cast<void>(line());
        static_cast<void>(line()); // the title
        const std::string encoding = capitals(trimmed(textLine().value_or(rest_)));
        if (encoding != "ASCII" && encoding != "BINARY") fail("expected a third line ASCII or BINARY");
        ascii_            = encoding == "ASCII";
        const auto words  = wordsOf(textLine().value_or(rest_), 2, "DATASET and its type");
        dataset_          = capitals(words[1]);
        const bool isRead = dataset_ == "POLYDATA" || dataset_ == "UNSTRUCTURED_GRID" || dataset_ == "STRUCTURED_GRID";
        if (capitals(words[0]) != "DATASET" || !isRead)
            failBefore(words[1], "expected DATASET POLYDATA, UNSTRUCTURED_GRID or STRUCTURED_GRID; ParaView's Extract "
                                 "Surface makes a POLYDATA of others");
    }

    void parseEntry(std::string_view text)
    {
        const Words       words = wordsOf(text, 1, "a keyword");
        const std::string key   = capitals(words[0]);
        if (key == "POINTS")
            parsePoints(wordsOf(text, 3, "POINTS, their number and type"));
        else if (key == "DIMENSIONS" && dataset_ == "STRUCTURED_GRID")
            parseDimensions(wordsOf(text, 4, "DIMENSIONS and three numbers"));
        else if (key == "VERTICES" || key == "LINES" || key == "POLYGONS" || key == "TRIANGLE_STRIPS" || key == "CELLS")
            parseCells(key, wordsOf(text, 3, "two numbers after the kind of cells"));
        else if (key == "CELL_TYPES")
            parseTypes(wordsOf(text, 2, "CELL_TYPES and their number"));
        else if (key == "METADATA")
            skipMetadata();
        else if (key == "POINT_DATA" || key == "CELL_DATA")
            beginData(key, wordsOf(text, 2, "POINT_DATA or CELL_DATA and a number"));
        else if (key == "FIELD")
            parseField(countIn(wordsOf(text, 3, "FIELD, its name and the number of arrays")[2]));
        else if (tuples_)
            parseAttribute(key, text);
        else
            failBefore(words[0], "expected POINTS, POLYGONS, CELLS, CELL_TYPES, POINT_DATA, CELL_DATA, FIELD or "
                                 "another keyword of VTK");
    }

    void parsePoints(const Words& words)
    {
        if (hasPoints_) failBefore(words[0], "expected POINTS once");
        piece_.points      = countIn(words[1]);
        piece_.coordinates = array("POINTS", words[2], piece_.points, 3);
        hasPoints_         = true;
    }

    void parseDimensions(const Words& words)
    {
        constexpr std::uint64_t kMost = 1u << 21; // whose cube a number of 64 bits holds
        piece_.dimensions.clear();
        for (std::size_t k = 1; k <= 3; ++k) {
            piece_.dimensions.push_back(countIn(words[k]));
            if (piece_.dimensions.back() < 1 || piece_.dimensions.back() > kMost)
                failBefore(words[k], "expected a dimension from 1 to " + std::to_string(kMost));
        }
    }

    void parseCells(const std::string& key, const Words& words)
    {
        VtkCells            cells;
        const std::uint64_t first = countIn(words[1]), second = countIn(words[2]);
        const auto          peek = rest_.substr(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
        if (capitals(peek.substr(0, 7)) == "OFFSETS") {
            cells.offsets      = keyedArray("OFFSETS", first);
            cells.lists        = keyedArray("CONNECTIVITY", second);
            cells.beginsAtZero = true;
            cells.count        = first > 0 ? first - 1 : 0;
        } else {
            cells.lists = array(key, "int", second, 1);
            cells.count = first;
        }
        if (key == "VERTICES" || key == "LINES") return;
        cells.kind = key == "CELLS"      ? VtkCells::Kind::mixed
                     : key == "POLYGONS" ? VtkCells::Kind::polygons
                                         : VtkCells::Kind::strips;
        if (std::ranges::find(piece_.cells, cells.kind, &VtkCells::kind) != piece_.cells.end())
            failBefore(words[0], "expected " + key + " once");
        piece_.cells.push_back(std::move(cells));
    }

    VtkArray keyedArray(const std::string& key, std::uint64_t count)
    {
        const auto words = wordsOf(textLine().value_or(rest_), 2, "OFFSETS and CONNECTIVITY, each with its type");
        if (capitals(words[0]) != key) failBefore(words[0], "expected " + key);
        return array(key, words[1], count, 1);
    }

    void parseTypes(const Words& words)
    {
        typeCount_ = countIn(words[1]);
        types_     = array("CELL_TYPES", "int", typeCount_, 1);
    }

    /// Passes over what is said of the array before: an empty line ends it, but a component's name may be empty.
    void skipMetadata()
    {
        for (std::string_view text = trimmed(line()); !text.empty(); text = trimmed(line()))
            for (std::uint64_t k = 0; capitals(text) == "COMPONENT_NAMES" && k < lastComponents_ && !rest_.empty(); ++k)
                static_cast<void>(line());
    }

    void beginData(const std::string& key, const Words& words)
    {
        ofPoints_ = key == "POINT_DATA";
        tuples_   = countIn(words[1]);
        if (!hasPoints_) failBefore(words[0], "expected POINTS before data");
        if (ofPoints_ && *tuples_ != piece_.points)
            failBefore(words[1], "expected data for " + std::to_string(piece_.points) + " points");
    }

    void parseField(std::uint64_t arrays)
    {
        for (std::uint64_t k = 0; k < arrays; ++k) {
            auto text = textLine();
            while (text && capitals(trimmed(*text)) == "METADATA") {
                skipMetadata();
                text = textLine();
            }
            if (!text) fail("expected " + std::to_string(arrays) + " arrays of FIELD");
            const Words         words      = wordsOf(*text, 4, "an array's name, components, tuples and type");
            const std::uint64_t components = countIn(words[1]), tuples = countIn(words[2]);
            if (tuples_ && tuples != *tuples_) failBefore(words[2], "expected " + std::to_string(*tuples_) + " tuples");
            addData(arrayOrBits(unescaped(words[0]), words[3], tuples, components));
        }
    }

    void parseAttribute(const std::string& key, std::string_view text)
    {
        struct Kind {
            std::string_view key;
            std::uint64_t    components; ///< 0: stated
        };
        constexpr std::array<Kind, 9> kKinds = {{{"SCALARS", 0},
                                                 {"VECTORS", 3},
                                                 {"NORMALS", 3},
                                                 {"TENSORS", 9},
                                                 {"TENSORS6", 6},
                                                 {"GLOBAL_IDS", 1},
                                                 {"PEDIGREE_IDS", 1},
                                                 {"EDGE_FLAGS", 1},
                                                 {"TEXTURE_COORDINATES", 0}}};
        if (key == "COLOR_SCALARS" || key == "LOOKUP_TABLE") return skipColours(key, text);
        const auto kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.key == key; });
        if (kind == kKinds.end()) failBefore(text, "expected SCALARS, NORMALS, FIELD or another keyword of data");
        const bool    isTexture  = key == "TEXTURE_COORDINATES";
        const Words   words      = wordsOf(text, isTexture ? 4 : 3, "the data's name and type");
        std::uint64_t components = kind->components;
        if (isTexture) components = countIn(words[2]);
        if (key == "SCALARS") {
            components      = words.size() > 3 ? countIn(words[3]) : 1;
            const auto peek = rest_.substr(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
            if (capitals(peek.substr(0, 12)) == "LOOKUP_TABLE") static_cast<void>(textLine()); // only its name
        }
        auto data = arrayOrBits(unescaped(words[1]), words[isTexture ? 3 : 2], *tuples_, components);
        if (data && key == "NORMALS") data->isNormals = true;
        addData(std::move(data));
    }

    /// Colours are numbers from 0 to 1 in a text, and bytes otherwise.
    void skipColours(const std::string& key, std::string_view text)
    {
        const Words         words  = wordsOf(text, 3, "a name and a number");
        const std::uint64_t number = countIn(words[2]);
        const bool          table  = key == "LOOKUP_TABLE";
        static_cast<void>(array(key, "unsigned_char", table ? number : *tuples_, table ? 4 : number));
    }

    void addData(std::optional<VtkArray> data)
    {
        if (tuples_ && ofPoints_ && data) piece_.pointData.push_back(std::move(*data));
    }

    /// Passes over the numbers of an array, which must be no bits.
    VtkArray array(const std::string& name, std::string_view typeName, std::uint64_t tuples, std::uint64_t components)
    {
        auto result = arrayOrBits(name, typeName, tuples, components);
        if (!result) failBefore(typeName, "array " + inQuotes(name) + ": expected a type of numbers such as float");
        return std::move(*result);
    }

    /// Passes over an array; of bits nothing is returned.
    std::optional<VtkArray> arrayOrBits(const std::string& name, std::string_view typeName, std::uint64_t tuples,
                                        std::uint64_t components)
    {
        const std::string word = capitals(typeName);
        const auto        known =
            std::find_if(kTypeNames.begin(), kTypeNames.end(), [&](const TypeName& t) { return t.name == word; });
        if (known == kTypeNames.end())
            failBefore(typeName,
                       "array " + inQuotes(name) + ": expected a type of numbers such as float, double or int");
        if (components > kMostComponents || tuples > file_.text.size() * 8)
            fail("array " + inQuotes(name) + ": expected up to " + std::to_string(kMostComponents) +
                 " components of no more values than the file has bits, claimed are " + std::to_string(components) +
                 " of " + std::to_string(tuples));
        lastComponents_             = components;
        const std::uint64_t numbers = tuples * components;
        VtkArray            result{name, components, {}, capitals(name) == "NORMALS"};
        const std::string   what = "array " + inQuotes(name);
        if (ascii_) {
            const std::string_view words = skippedWords(what, numbers);
            result.open                  = [&file = file_, what, words] { return Numbers(file, what, words); };
            return known->type ? std::optional(std::move(result)) : std::nullopt;
        }
        const std::uint64_t bytes = known->type ? numbers * sizeOf(*known->type) : (numbers + 7) / 8;
        if (bytes > rest_.size())
            file_.failAtByte(rest_.data(), what + ": expected " + std::to_string(bytes) + " bytes, found " +
                                               std::to_string(rest_.size()) + "; was the file cut short?");
        const std::span<const std::byte> data(reinterpret_cast<const std::byte*>(rest_.data()), bytes);
        rest_.remove_prefix(bytes);
        if (!known->type) return std::nullopt;
        result.open = [&file = file_, what, data, type = *known->type] {
            return Numbers(file, what, type, std::endian::big, data);
        };
        return result;
    }

    std::string_view skippedWords(const std::string& what, std::uint64_t count)
    {
        const char* const begin = rest_.data();
        for (std::uint64_t k = 0; k < count; ++k) {
            rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
            if (rest_.empty())
                fail(what + ": expected " + std::to_string(count) + " numbers, only " + std::to_string(k) +
                     " are there");
            rest_.remove_prefix(std::min(rest_.find_first_of(kBlanks), rest_.size()));
        }
        return {begin, std::size_t(rest_.data() - begin)};
    }

    const WholeFile&             file_;
    std::string_view             rest_; ///< what is left
    bool                         ascii_ = true;
    std::string                  dataset_;
    VtkPiece                     piece_;
    bool                         hasPoints_ = false;
    std::optional<VtkArray>      types_;
    std::uint64_t                typeCount_ = 0;
    std::optional<std::uint64_t> tuples_; ///< of the data that follows; empty before POINT_DATA and CELL_DATA
    bool                         ofPoints_       = false;
    std::uint64_t                lastComponents_ = 0; ///< of the array before
};

} // namespace

LoadedCloud parseVtk(std::istream& stream, std::uint64_t size, const std::string& name,
                     const CloudReadSettings& settings)
{
    ByteReader      reader(stream, size, name);
    const WholeFile file{reader, {reinterpret_cast<const char*>(reader.take(size)), size}};
    VtkParser       parser(file);
    const VtkPiece  piece = parser.parse();
    return cloudOf(file, {&piece, 1}, parser.format(), settings);
}

} // namespace palp
