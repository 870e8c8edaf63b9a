#include "engine/cloud/detail/text_file.h"

#include <algorithm>
#include <ostream>
#include <utility>

#include "engine/cloud/detail/cloud_rows.h"
#include "engine/cloud/detail/row_writer.h"
#include "engine/cloud/tokens.h"

namespace palp {
namespace {

constexpr std::size_t kUnnamedColumns = 4; ///< x y z stiffness

/// Splits a line at a separator, or at blanks if that is ' '.
class Fields {
public:
    Fields(std::string_view line, char separator) : rest_(line), separator_(separator) {}

    /// Takes the next field.
    /// \return  true if there was another field
    bool next(std::string_view& field)
    {
        if (separator_ == ' ') {
            field = nextWord(rest_);
            return !field.empty();
        }
        if (ended_) return false;
        const std::size_t at = rest_.find(separator_);
        field                = trimmed(rest_.substr(0, at));
        ended_               = at == std::string_view::npos;
        if (!ended_) rest_.remove_prefix(at + 1);
        return true;
    }

private:
    std::string_view rest_;
    char             separator_;
    bool             ended_ = false;
};

std::vector<std::string> split(std::string_view line, char separator)
{
    std::vector<std::string> words;
    Fields                   fields(line, separator);
    for (std::string_view field; fields.next(field);) words.emplace_back(field);
    return words;
}

char separatorOf(std::string_view line)
{
    for (const char separator : {';', ','})
        if (line.find(separator) != std::string_view::npos) return separator;
    return ' ';
}

std::string withoutQuotes(const std::string& word)
{
    const bool isQuoted = word.size() >= 2 && word.front() == '"' && word.back() == '"';
    return isQuoted ? word.substr(1, word.size() - 2) : word;
}

bool noNumberIn(const std::vector<std::string>& words)
{
    return std::none_of(words.begin(), words.end(), [](const std::string& w) { return parseNumber(w).has_value(); });
}

/// Reads the points once the columns are known.
class TextParser {
public:
    TextParser(ByteReader& reader, const CloudReadSettings& settings) : reader_(reader), settings_(settings) {}

    LoadedCloud parse()
    {
        header_.format                 = "text";
        std::optional<std::string> row = firstLine();
        if (!row) reader_.fail("the cloud is empty: expected at least one point, found none");
        const bool isHeader = chooseColumns(*row);

        CloudRows                rows(reader_, header_, settings_);
        std::vector<std::size_t> slots;
        for (std::size_t i = 0; i < header_.properties.size(); ++i) slots.push_back(rows.slotOf(i));
        if (!isHeader) addRow(*row, slots, rows);
        while (const auto line = reader_.line()) {
            const std::string_view text = trimmed(*line);
            if (text.starts_with('#'))
                refuseUnit(text.substr(1));
            else if (!text.empty())
                addRow(text, slots, rows);
        }
        return rows.finish();
    }

private:
    /// Returns the first line that is no comment; comments before it may state units.
    std::optional<std::string> firstLine()
    {
        while (const auto line = reader_.lineWithText()) {
            std::string_view text = *line;
            if (reader_.lineNumber() == 1 && text.starts_with(kByteOrderMark))
                text.remove_prefix(kByteOrderMark.size());
            text = trimmed(text);
            if (text.starts_with('#'))
                header_.readComment(text.substr(1), reader_);
            else if (!text.empty())
                return std::string(text);
        }
        return std::nullopt;
    }

    /// Finds the separator and the columns.
    /// \return  true if the line is a header and not a point
    bool chooseColumns(std::string_view line)
    {
        const bool slashes = line.starts_with("//");
        if (slashes) line.remove_prefix(2);
        separator_                              = separatorOf(line);
        const std::vector<std::string> words    = split(line, separator_);
        const bool                     named    = !settings_.columns.empty();
        const bool                     isHeader = slashes || noNumberIn(words);
        if (!named && !isHeader && words.size() > kUnnamedColumns)
            reader_.failAtLine("expected x y z or x y z stiffness, found " + std::to_string(words.size()) +
                               " values without a header line; name the columns, such as --columns x,y,z,-,stiffness");
        if (named)
            header_.properties = split(settings_.columns, ',');
        else if (isHeader)
            header_.properties = words;
        else
            header_.properties = {"x", "y", "z", "stiffness"};
        if (!named && !isHeader) header_.properties.resize(std::min(words.size(), kUnnamedColumns));
        for (std::string& property : header_.properties) property = canonical(withoutQuotes(property));
        return isHeader;
    }

    /// Returns the name by which a column is known. Coordinates may be capital letters; stiffness may be a small letter
    /// where the user wrote it, but not in a file, where d and e could be anything.
    std::string canonical(const std::string& name) const
    {
        if (name.size() != 1 || name == settings_.stiffnessProperty) return name;
        const char c = name.front();
        if (c == 'X' || c == 'Y' || c == 'Z') return {char(c - 'X' + 'x')};
        if (!settings_.columns.empty() && (c == 'd' || c == 'e')) return {char(c - 'd' + 'D')};
        return name;
    }

    void addRow(std::string_view line, const std::vector<std::size_t>& slots, CloudRows& rows) const
    {
        Fields           fields(line, separator_);
        std::string_view field;
        CloudRow         values{};
        for (std::size_t i = 0; i < slots.size(); ++i) {
            if (!fields.next(field)) wrongNumberOfValues(line);
            if (slots[i] == kSlots) continue;
            const std::optional<double> value = parseNumber(field);
            if (!value)
                reader_.failAtLine("expected a number for " + inQuotes(header_.properties[i]) + ", found " +
                                   inQuotes(field));
            values[slots[i]] = *value;
        }
        if (fields.next(field)) wrongNumberOfValues(line);
        rows.add(values, CloudRows::Place::line);
    }

    [[noreturn]] void wrongNumberOfValues(std::string_view line) const
    {
        const char* const reason  = settings_.columns.empty() ? "as on the first line" : "as the columns setting names";
        const char* const between = separator_ == ' ' ? "blanks" : separator_ == ',' ? "commas" : "semicolons";
        reader_.failAtLine("expected " + std::to_string(header_.properties.size()) + " values between " + between +
                           ", " + reason + ", found " + std::to_string(split(line, separator_).size()) + " in " +
                           inQuotes(line));
    }

    void refuseUnit(std::string_view comment) const
    {
        CloudHeader late;
        late.readComment(comment, reader_);
        if (late.lengthUnit || late.stiffnessUnit)
            reader_.failAtLine("expected comments on units before the first point, found " +
                               inQuotes(trimmed(comment)));
    }

    ByteReader&              reader_;
    const CloudReadSettings& settings_;
    CloudHeader              header_;
    char                     separator_ = ' ';
};

} // namespace

LoadedCloud parseText(std::istream& stream, std::uint64_t size, const std::string& name,
                      const CloudReadSettings& settings)
{
    ByteReader reader(stream, size, name);
    return TextParser(reader, settings).parse();
}

void formatText(std::ostream& stream, const PointCloud& cloud, std::span<const NamedField> extraFields,
                const CloudWriteSettings& settings)
{
    const RowWriter writer(cloud, extraFields);
    for (const std::string& comment : writer.comments()) stream << "# " << comment << '\n';
    for (std::size_t i = 0; i < writer.columns().size(); ++i) {
        if (i > 0) stream << settings.separator;
        stream << writer.columns()[i];
    }
    stream << '\n';
    writer.writeText(stream, settings.separator);
}

} // namespace palp
