#include "engine/tools/study/trial_table.h"

#include <algorithm>
#include <functional>

#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/shown_text.h"
#include "engine/tools/study/study_plan.h"

namespace palp::study {
namespace {

constexpr std::size_t kLargestFile = std::size_t(64) << 20; ///< [bytes] of a table
constexpr std::size_t kMostTrials  = 100'000;               ///< of a table; each takes 430 bytes of memory
const std::string     kMostInWords = std::to_string(kMostTrials) + " trials";

struct Column {
    const char* name;
    std::string (*write)(const TrialRow&);
    /// Reads the column's value; false if the text is no such value.
    bool (*read)(TrialRow&, const std::string&);
};

template <std::string TrialRow::*member>
constexpr Column textColumn(const char* name)
{
    return {name, [](const TrialRow& r) { return r.*member; },
            [](TrialRow& r, const std::string& text) {
                r.*member = text;
                return true;
            }};
}
template <std::uint64_t TrialRow::*member>
constexpr Column countColumn(const char* name)
{
    return {name, [](const TrialRow& r) { return std::to_string(r.*member); },
            [](TrialRow& r, const std::string& text) {
                const auto value = parseCount(text);
                r.*member        = value.value_or(0);
                return value.has_value();
            }};
}
template <double TrialRow::*member>
constexpr Column numberColumn(const char* name)
{
    return {name, [](const TrialRow& r) { return shown(r.*member); },
            [](TrialRow& r, const std::string& text) {
                const auto value = parseNumber(text);
                r.*member        = value.value_or(0);
                return value.has_value();
            }};
}

template <std::optional<bool> TrialRow::*member>
constexpr Column flagColumn(const char* name)
{
    return {name, [](const TrialRow& r) { return std::string(!(r.*member)   ? ""
                                                             : *(r.*member) ? "1"
                                                                            : "0"); },
            [](TrialRow& r, const std::string& text) {
                if (text == "0" || text == "1") r.*member = text == "1";
                return text.empty() || r.*member;
            }};
}

/// The only list of columns: the header, the rows and the reader follow it.
constexpr Column kColumns[] = {
    textColumn<&TrialRow::participant>("participant"),
    countColumn<&TrialRow::trial>("trial"),
    countColumn<&TrialRow::block>("block"),
    textColumn<&TrialRow::task>("task"),
    textColumn<&TrialRow::kind>("kind"),
    textColumn<&TrialRow::first>("condition"),
    textColumn<&TrialRow::second>("condition_second"),
    textColumn<&TrialRow::question>("question"),
    textColumn<&TrialRow::answer>("answer"),
    flagColumn<&TrialRow::correct>("correct"),
    numberColumn<&TrialRow::reactionTime>("reaction_time_s"),
    countColumn<&TrialRow::seed>("seed"),
    textColumn<&TrialRow::firstSession>("session"),
    textColumn<&TrialRow::secondSession>("session_second"),
    numberColumn<&TrialRow::meanForce>("force_mean_N"),
    numberColumn<&TrialRow::peakForce>("force_peak_N"),
    textColumn<&TrialRow::version>("version"),
    flagColumn<&TrialRow::felt>("felt"),
};

std::string quoted(const std::string& text)
{
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) result.append(c == '"' ? 2 : 1, c);
    return result + "\"";
}

std::string line(const std::function<std::string(const Column&)>& cell)
{
    std::string text;
    for (const Column& column : kColumns) {
        if (!text.empty() || &column != kColumns) text += ',';
        text += quoted(cell(column));
    }
    return text + "\n";
}

std::string header()
{
    return line([](const Column& column) { return std::string(column.name); });
}

/// Returns the cells of a line; no cell contains the end of a line.
std::vector<std::string> cellsOf(std::string_view text)
{
    std::vector<std::string> cells(1);
    bool                     within = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"' && within && i + 1 < text.size() && text[i + 1] == '"')
            cells.back() += text[++i];
        else if (c == '"')
            within = !within;
        else if (c == ',' && !within)
            cells.emplace_back();
        else
            cells.back() += c;
    }
    return cells;
}

TrialRow rowOf(std::string_view text, const std::string& where)
{
    const auto cells = cellsOf(text);
    if (cells.size() != std::size(kColumns))
        throw Error(where + ": expected " + std::to_string(std::size(kColumns)) + " columns, found " +
                    std::to_string(cells.size()) + "; was the table changed by another program?");
    TrialRow row;
    for (std::size_t k = 0; k < cells.size(); ++k)
        if (!kColumns[k].read(row, cells[k]))
            throw Error(where + ": column " + kColumns[k].name + ": expected a number, found " + inQuotes(cells[k]));
    return row;
}

/// Refuses a row that no participant can have given: whoever counts answers has to be sure of them.
void demandSense(const TrialRow& row, std::size_t trial, const std::string& where)
{
    struct Known {
        std::vector<std::string_view> answers;
        const char*                   words;
    };
    const auto known = [&]() -> Known {
        if (row.kind == name(TaskKind::rating)) return {{"1", "2", "3", "4", "5"}, "1 to 5"};
        if (row.kind == name(TaskKind::yesNo)) return {{"yes", "no"}, "yes or no"};
        if (row.kind == name(TaskKind::twoAlternative)) return {{"first", "second"}, "first or second"};
        throw Error(where + ": column kind: expected rating, yes-no or two-alternative, found " + inQuotes(row.kind));
    }();
    if (row.trial != trial)
        throw Error(where + ": column trial: expected " + std::to_string(trial) + ", found " +
                    std::to_string(row.trial) + "; was the table changed by another program?");
    if (std::ranges::find(known.answers, row.answer) == known.answers.end())
        throw Error(where + ": column answer: expected " + known.words + ", found " + inQuotes(row.answer));
}

/// Returns all whole lines of a table.
std::string wholeLines(const std::filesystem::path& file)
{
    std::string text = readWhole(file, kLargestFile, "a table of trials of at most 64 MiB", Pipes::refused);
    text.resize(text.rfind('\n') + 1); // npos + 1 is 0
    return text;
}

/// Returns a table of this version: with an empty last column where an earlier one had none.
std::string asToday(std::string text)
{
    const std::string today = header(), before = today.substr(0, today.rfind(',')) + "\n";
    if (!text.starts_with(before)) return text;
    std::string wider = today;
    wider.reserve(text.size() + std::size_t(std::ranges::count(text, '\n')) + today.size());
    for (std::size_t begin = before.size(); begin < text.size();) {
        const std::size_t end = text.find('\n', begin);
        wider.append(text, begin, end - begin).append(",\n");
        begin = end + 1;
    }
    return wider;
}

std::vector<TrialRow> rowsOf(const std::string& text, const std::filesystem::path& file)
{
    const std::string head = header();
    if (!text.starts_with(head))
        throw Error(file.string() + ": line 1: expected the columns " + head.substr(0, head.size() - 1) + ", found " +
                    inQuotes(std::string_view(text).substr(0, text.find('\n'))) +
                    "; was the table changed by another program?");
    std::vector<TrialRow> rows;
    constexpr std::size_t kShortest = 38; // [bytes] of a row, but for the first ones
    rows.reserve(std::min({std::size_t(std::ranges::count(text, '\n')), text.size() / kShortest, kMostTrials}));
    std::size_t number = 2;
    for (std::size_t begin = head.size(); begin < text.size(); ++number) {
        const std::size_t end   = text.find('\n', begin);
        const std::string where = file.string() + ": line " + std::to_string(number);
        if (rows.size() == kMostTrials) throw Error(where + ": expected at most " + kMostInWords + ", found more");
        rows.push_back(rowOf(std::string_view(text).substr(begin, end - begin), where));
        demandSense(rows.back(), rows.size(), where);
        begin = end + 1;
    }
    return rows;
}

} // namespace

std::vector<TrialRow> readTrials(const std::filesystem::path& file)
{
    std::string text = wholeLines(file);
    // Spreadsheets write a mark before a table, and more at the ends of its lines.
    if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
    std::erase(text, '\r'); // no cell has the end of a line
    return rowsOf(asToday(std::move(text)), file);
}

TrialTable::TrialTable(std::filesystem::path file) : file_(std::move(file))
{
    const bool  there = isThere(file_); // an empty table is never written over one that a server hides for a moment
    std::string text  = there ? asToday(wholeLines(file_)) : "";
    if (text.empty()) text = header();
    rows_ = rowsOf(text, file_);
    if (!there || sizeOfFile(file_) != text.size()) writeFileWhole(file_, [&](std::ostream& out) { out << text; });
}

void TrialTable::append(const TrialRow& row)
{
    if (rows_.size() == kMostTrials)
        throw Error(file_.string() + ": it has " + kMostInWords + ", which is the most; begin another study");
    appendToFile(file_, line([&](const Column& column) { return column.write(row); }));
    rows_.push_back(row);
}

} // namespace palp::study
