#include "engine/cloud/detail/obj_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include "engine/cloud/detail/cloud_rows.h"
#include "engine/cloud/detail/face_rows.h"
#include "engine/cloud/tokens.h"
#include "engine/core/counted.h"

namespace palp {
namespace {

/// Lines that are right in a file and mean nothing for touch.
constexpr std::array<std::string_view, 12> kUnused = {"vt",     "vn",     "vp", "g", "o",   "s",
                                                      "usemtl", "mtllib", "l",  "p", "lod", "usemap"};

/// Longest line with the lines that continue it [bytes]: as long as ByteReader lets one line be.
constexpr std::size_t kLongestLine = std::size_t(1) << 16;

class ObjParser {
public:
    ObjParser(ByteReader& reader, const CloudReadSettings& settings) : reader_(reader), settings_(settings) {}

    LoadedCloud parse()
    {
        while (const auto line = wholeLine()) takeLine(*line);
        if (!rows_) reader_.fail("expected vertices, lines such as \"v 0 0 1\", found none; is it an OBJ file?");
        if (unknown_ > 0)
            rows_->warn(counted(unknown_, "line") + " omitted, the first in line " + std::to_string(firstUnknown_) +
                        ": only v and f are read, not curves and surfaces");
        LoadedCloud loaded = rows_->finish();
        faces_.finish(loaded);
        return loaded;
    }

private:
    /// Returns the next line, with those that a backslash at its end adds to it.
    std::optional<std::string_view> wholeLine()
    {
        auto line = reader_.line();
        if (line && reader_.lineNumber() == 1 && line->starts_with(kByteOrderMark))
            line->remove_prefix(kByteOrderMark.size());
        if (!line || !line->ends_with('\\')) return line;
        std::string_view rest = *line;
        if (nextWord(rest).starts_with('#')) return line; // a comment may end in a folder's name
        joined_.clear();
        for (; line && line->ends_with('\\'); line = reader_.line()) {
            joined_.append(line->substr(0, line->size() - 1)).append(" ");
            if (joined_.size() > kLongestLine)
                reader_.failAtLine("expected a line of at most " + std::to_string(kLongestLine) +
                                   " bytes, found one that goes on for longer");
        }
        if (line) joined_.append(*line);
        return joined_;
    }

    void takeLine(std::string_view line)
    {
        std::string_view       rest = line;
        const std::string_view word = nextWord(rest);
        if (word == "v")
            takeVertex(rest);
        else if (word == "f" || word == "fo")
            takeFace(rest);
        else if (word.starts_with('#'))
            takeComment(rest);
        else if (!word.empty() && std::ranges::find(kUnused, word) == kUnused.end() && unknown_++ == 0)
            firstUnknown_ = reader_.lineNumber();
    }

    void takeComment(std::string_view comment)
    {
        if (!rows_) return header_.readComment(comment, reader_);
        CloudHeader late;
        late.readComment(comment, reader_);
        if (late.lengthUnit || late.stiffnessUnit)
            reader_.failAtLine("expected comments on units before the first vertex, found " +
                               inQuotes(trimmed(comment)));
    }

    /// Takes x y z, and what some programs put behind: a weight, or a colour.
    void takeVertex(std::string_view rest)
    {
        if (!rows_) {
            header_.format     = "OBJ";
            header_.properties = {"x", "y", "z"};
            rows_.emplace(reader_, header_, settings_);
        }
        CloudRow         row{};
        std::size_t      found = 0;
        std::string_view word;
        for (word = nextWord(rest); !word.empty() && !word.starts_with('#'); word = nextWord(rest)) {
            const std::optional<double> number = parseNumber(word);
            if (!number) reader_.failAtLine("expected a number, found " + inQuotes(word));
            if (found < kNumbers) row[found] = *number;
            ++found;
        }
        if (found < kNumbers)
            reader_.failAtLine("expected the three coordinates of a vertex, found " + std::to_string(found) +
                               " numbers");
        if (vertices_ == kMostVertices)
            reader_.failAtLine("expected at most " + std::to_string(kMostVertices) + " vertices");
        rows_->add(row, CloudRows::Place::line);
        ++vertices_;
    }

    void takeFace(std::string_view rest)
    {
        for (std::string_view word = nextWord(rest); !word.empty() && !word.starts_with('#'); word = nextWord(rest))
            faces_.addCorner(double(cornerOf(word)), CloudRows::Place::line);
        faces_.endFace();
    }

    /// Returns the number of the vertex from 0 in 7, 7/1, 7//3, 7/1/3 or the same counted from the last one, -1.
    std::uint64_t cornerOf(std::string_view word) const
    {
        const std::string_view digits = word.substr(0, word.find('/'));
        std::int64_t           number = 0;
        const char* const      end    = digits.data() + digits.size();
        const auto [stopped, status]  = std::from_chars(digits.data(), end, number);
        const auto count              = std::int64_t(vertices_);
        if (status != std::errc() || stopped != end || number == 0 || number > count || number < -count)
            reader_.failAtLine("expected the number of a vertex above this line, from 1 to " + std::to_string(count) +
                               " or counted from the last one, -1 to -" + std::to_string(count) + ", found " +
                               inQuotes(word));
        return std::uint64_t(number > 0 ? number - 1 : count + number);
    }

    static constexpr std::size_t   kNumbers      = 3;
    static constexpr std::uint64_t kMostVertices = std::numeric_limits<std::uint32_t>::max() - 1;

    ByteReader&              reader_;
    const CloudReadSettings& settings_;
    CloudHeader              header_;
    std::optional<CloudRows> rows_; ///< from the first vertex on
    FaceRows                 faces_{reader_, kMostVertices};
    std::string              joined_;
    std::uint64_t            vertices_ = 0, unknown_ = 0, firstUnknown_ = 0;
};

} // namespace

LoadedCloud parseObj(std::istream& stream, std::uint64_t size, const std::string& name,
                     const CloudReadSettings& settings)
{
    ByteReader reader(stream, size, name);
    return ObjParser(reader, settings).parse();
}

} // namespace palp
