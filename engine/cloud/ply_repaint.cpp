#include "engine/cloud/ply_repaint.h"

#include <algorithm>
#include <cmath>
#include <istream>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "engine/cloud/detail/block_writer.h"
#include "engine/cloud/detail/ply_file.h"
#include "engine/cloud/detail/ply_header.h"
#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/progress.h"

namespace palp {
namespace {

constexpr std::uint64_t kRowsPerProgress = 1u << 14; ///< between two looks at the clock: about a millisecond

constexpr std::size_t kNone = std::size_t(-1); ///< no property

/// The differences between the new file and the original.
struct Changes {
    RepaintedPly               result;
    std::size_t                column = kNone; ///< of the points' properties: the one whose values are replaced
    ScalarType                 type   = ScalarType::float64; ///< that it has in the new file
    std::optional<std::string> unit;      ///< of a comment stiffness_unit that is added, or stands in place of another
    std::vector<double>        stiffness; ///< of each row in the new file [Pa] or [N m]; NaN: the number it has
};

/// Returns the stiffness of each row.
/// \param now  the file's points as they were before
std::vector<double> stiffnessOfRows(const LoadedCloud& now, const PointCloud& painted, bool rowsHaveOwn)
{
    const std::span<const double> stiffness = painted.stiffness();
    if (now.pointOfRow.empty()) return {stiffness.begin(), stiffness.end()};
    std::vector<double> ofRows;
    ofRows.reserve(now.pointOfRow.size());
    for (const std::uint32_t point : now.pointOfRow) {
        const bool kept = rowsHaveOwn && stiffness[point] == now.cloud.stiffness()[point];
        ofRows.push_back(kept ? std::numeric_limits<double>::quiet_NaN() : stiffness[point]);
    }
    return ofRows;
}

/// Returns true if a float can hold the value: smaller ones are rounded more coarsely, or to zero.
bool fitsFloat(double value)
{
    return value >= double(std::numeric_limits<float>::min()) && value <= double(std::numeric_limits<float>::max());
}

/// Refuses an original that is no longer what was painted.
void refuseOtherPoints(const std::string& name, const LoadedCloud& now, const PointCloud& painted)
{
    if (now.report.droppedPoints > 0)
        throw Error(name + ": " + std::to_string(now.report.droppedPoints) +
                    " points were dropped because of NaN or infinity, so the file's other points cannot be kept as "
                    "they are; write a file without them (palpate convert --drop-invalid) and paint that one");
    if (now.cloud.size() != painted.size())
        throw Error(name + ": expected the " + std::to_string(painted.size()) + " points that were painted, found " +
                    std::to_string(now.cloud.size()) + "; the file has changed since it was read");
    const auto [was, is] = std::mismatch(painted.positions().begin(), painted.positions().end(),
                                         now.cloud.positions().begin(), now.cloud.positions().end());
    if (was != painted.positions().end())
        throw Error(name + ": point " + std::to_string(was - painted.positions().begin()) +
                    " lies elsewhere than the one that was painted; the file has changed since it was read");
}

bool hasProperty(const PlyElement& vertex, std::string_view name)
{
    return std::any_of(vertex.properties.begin(), vertex.properties.end(),
                       [&](const PlyProperty& p) { return p.name == name; });
}

Changes changesOf(const std::string& name, const PlyHeader& header, const CloudReadSettings& readAs,
                  const PointCloud& painted)
{
    const PlyElement& vertex = header.elements[header.vertex];
    Changes           changes;
    for (std::size_t k = 0; k < vertex.properties.size(); ++k)
        if (vertex.properties[k].slot == kSlotStiffness) changes.column = k;

    const bool        hidden = hasProperty(vertex, "stiffness") || hasProperty(vertex, "scalar_stiffness");
    const char* const own    = hidden ? "stiffness" : propertyOf(painted.kind());
    // Without a unit the property stays what it is, beside the stiffness; unless both have the same name.
    if (readAs.range && changes.column != kNone && vertex.properties[changes.column].name != own)
        changes.column = kNone;
    if (changes.column == kNone) {
        if (hasProperty(vertex, own))
            throw Error(name + ": expected no property \"" + own +
                        "\" beside the one that the stiffness was made of, "
                        "found one; rename it, or read it as the stiffness");
        changes.result = {own, true};
    } else {
        const PlyProperty& property = vertex.properties[changes.column];
        changes.result.property     = property.name;
        if (property.type == ScalarType::float32 &&
            std::all_of(painted.stiffness().begin(), painted.stiffness().end(), fitsFloat))
            changes.type = ScalarType::float32;
    }
    const char* const unit   = unitOf(painted.kind());
    const auto&       stated = header.cloud.stiffnessUnit;
    const bool        understood =
        stated ? *stated == unit : !changes.result.appended && kindByName(changes.result.property) == painted.kind();
    if (!understood) changes.unit = unit;
    return changes;
}

/// Copies a file, but for the changes. The file has been read before, so an error now means that it changed since.
class Copier {
public:
    Copier(ByteReader& reader, BlockWriter& out, const PlyHeader& header, const Changes& changes)
        : reader_(reader), out_(out), header_(header), changes_(changes),
          progress_("writing a copy of " + reader.name())
    {
    }

    void copy()
    {
        copyHeader();
        for (std::size_t i = 0; i <= header_.vertex; ++i) {
            const bool isVertex = i == header_.vertex;
            if (header_.elements[i].properties.empty()) continue; // takes no room, however many rows are promised
            for (std::uint64_t row = 0; row < header_.elements[i].count; ++row) {
                if (row % kRowsPerProgress == 0) progress_.at(reader_.offset(), reader_.size());
                copyRow(header_.elements[i], isVertex ? std::optional(changes_.stiffness[row]) : std::nullopt);
            }
        }
        copyBytes(reader_.remaining());
        out_.flush();
    }

private:
    void copyHeader()
    {
        std::size_t elements = 0, properties = 0;
        for (;;) {
            const std::string      raw(reader_.rawLine().value_or("end_header"));
            const std::string_view end  = lineEndOf(raw);
            std::string_view       rest = std::string_view(raw).substr(0, raw.size() - end.size());
            const std::string_view key  = nextWord(rest);
            if (key == "element") ++elements;
            const bool ofPoint = key == "property" && elements == header_.vertex + 1;
            if (key == "comment" && changes_.unit && nextWord(rest) == "stiffness_unit")
                addLine("comment stiffness_unit " + *changes_.unit, end);
            else if (ofPoint && properties == changes_.column && changes_.type == ScalarType::float64)
                addLine("property double " + changes_.result.property, end);
            else
                out_.append(raw);
            if (key == "format" && changes_.unit && !header_.cloud.stiffnessUnit)
                addLine("comment stiffness_unit " + *changes_.unit, end);
            if (ofPoint && ++properties == header_.elements[header_.vertex].properties.size() &&
                changes_.result.appended)
                addLine("property double " + changes_.result.property, end);
            if (key == "end_header") return;
        }
    }

    void addLine(const std::string& text, std::string_view end)
    {
        out_.append(text);
        out_.append(end);
    }

    /// Copies one row.
    /// \param stiffness  of the row's point; empty if the row is no point
    void copyRow(const PlyElement& element, std::optional<double> stiffness)
    {
        if (header_.ascii)
            copyLine(element, stiffness);
        else
            for (std::size_t k = 0; k < element.properties.size(); ++k)
                copyProperty(element.properties[k], k == changes_.column ? stiffness : std::nullopt);
        if (!header_.ascii && stiffness && changes_.result.appended) out_.appendNumber(*stiffness, header_.order);
    }

    void copyProperty(const PlyProperty& property, std::optional<double> value)
    {
        const std::size_t      size  = sizeOf(property.listCount.value_or(property.type));
        const std::byte* const bytes = reader_.take(size);
        if (value && std::isnan(*value)) value = loadScalar(property.type, bytes, header_.order);
        if (value && changes_.type == ScalarType::float32)
            out_.appendNumber(float(*value), header_.order);
        else if (value)
            out_.appendNumber(*value, header_.order);
        else
            out_.append({reinterpret_cast<const char*>(bytes), size});
        if (property.listCount) copyBytes(listLength(reader_, property, bytes, header_.order) * sizeOf(property.type));
    }

    void copyBytes(std::uint64_t count)
    {
        constexpr std::uint64_t kPiece = 1u << 20; // [bytes]
        while (count > 0) {
            const auto size = std::size_t(std::min(count, kPiece));
            out_.append({reinterpret_cast<const char*>(reader_.take(size)), size});
            count -= size;
        }
    }

    void copyLine(const PlyElement& element, std::optional<double> stiffness)
    {
        std::optional<std::string_view> raw = reader_.rawLine();
        for (; raw && isBlankText(*raw); raw = reader_.rawLine()) out_.append(*raw);
        if (!raw) reader_.failAtByte("the file ends too early; it has changed since it was read");
        const std::string_view end  = lineEndOf(*raw);
        const std::string_view line = raw->substr(0, raw->size() - end.size());
        if (!stiffness) return out_.append(*raw);
        if (changes_.result.appended) {
            out_.append(line);
            out_.append(" ");
            out_.append(shown(*stiffness));
            return out_.append(end);
        }
        const std::string_view word  = wordOf(element, line, changes_.column);
        const auto             begin = std::size_t(word.data() - line.data());
        out_.append(line.substr(0, begin));
        if (std::isnan(*stiffness) || parseNumber(word) == *stiffness)
            out_.append(word);
        else
            out_.append(changes_.type == ScalarType::float32 ? shown(float(*stiffness)) : shown(*stiffness));
        out_.append(raw->substr(begin + word.size()));
    }

    /// Returns the word that is the number of a property.
    std::string_view wordOf(const PlyElement& element, std::string_view line, std::size_t column) const
    {
        std::string_view rest = line;
        for (std::size_t k = 0;; ++k) {
            const std::string_view word = nextWord(rest);
            if (word.empty()) reader_.failAtLine("the line ends too early; the file has changed since it was read");
            if (k == column) return word;
            const PlyProperty& property = element.properties[k];
            if (property.listCount)
                for (std::uint64_t n = listLength(reader_, property, word); n > 0 && !nextWord(rest).empty();) --n;
        }
    }

    ByteReader&      reader_;
    BlockWriter&     out_;
    const PlyHeader& header_;
    const Changes&   changes_;
    Progress         progress_;
};

void rewind(std::istream& stream)
{
    stream.clear();
    stream.seekg(0);
}

} // namespace

RepaintedPly formatRepaintedPly(std::ostream& stream, std::istream& original, std::uint64_t size,
                                const std::string& name, const CloudReadSettings& readAs, const PointCloud& painted)
{
    rewind(original);
    const LoadedCloud now = parsePly(original, size, name, readAs);
    refuseOtherPoints(name, now, painted);

    rewind(original);
    ByteReader first(original, size, name);
    PlyHeader  header = parsePlyHeader(first);
    assignSlots(header.elements[header.vertex], CloudRows(first, header.cloud, readAs));
    Changes changes   = changesOf(name, header, readAs, painted);
    changes.stiffness = stiffnessOfRows(now, painted, !readAs.range && !changes.result.appended);

    rewind(original);
    ByteReader  reader(original, size, name);
    BlockWriter out(stream);
    Copier(reader, out, header, changes).copy();
    return std::move(changes.result);
}

RepaintedPly repaintPly(const std::filesystem::path& original, const CloudReadSettings& readAs,
                        const PointCloud& painted, const std::filesystem::path& target)
{
    InputFile           file = openRegularFile(original);
    const std::uint64_t size = sizeOfFile(original);
    RepaintedPly        result;
    writeFileWhole(target, [&](std::ostream& stream) {
        result = formatRepaintedPly(stream, file, size, original.string(), readAs, painted);
    });
    return result;
}

} // namespace palp
