#include "engine/tools/fit/probe_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <glm/geometric.hpp>

#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"
#include "engine/core/file.h"
#include "engine/core/quantity.h"
#include "engine/core/shown_text.h"

namespace palp::fit {
namespace {

constexpr std::size_t kLargestFile = std::size_t(256) << 20; // [bytes]
constexpr std::size_t kMostProbes  = 10'000;                 // a survey has hundreds; each takes some 400 bytes
constexpr double      kDeepest     = 0.1;                    // [m] no probe goes deeper: such numbers are millimetres
constexpr double      kShallowest  = 1e-9;                   // [m] any probe goes deeper
constexpr double      kWeakest     = 1e-9;                   // [N] any probe pushes harder
constexpr double      kLongest     = 1e6;                    // [s] eleven days
constexpr double      kStrongest   = 1e3;                    // [N] no probe pushes harder: such numbers are mN

enum Column : std::size_t { kDepth, kForce, kTime, kX, kY, kZ, kNx, kNy, kNz, kColumns };

struct ColumnName {
    std::string_view name;
    Dimension        dimension;
};
constexpr std::array<ColumnName, kColumns> kNames{{{"depth", Dimension::length},
                                                   {"force", Dimension::force},
                                                   {"time", Dimension::time},
                                                   {"x", Dimension::length},
                                                   {"y", Dimension::length},
                                                   {"z", Dimension::length},
                                                   {"nx", Dimension::none},
                                                   {"ny", Dimension::none},
                                                   {"nz", Dimension::none}}};

std::vector<std::string_view> cellsOf(std::string_view line)
{
    std::vector<std::string_view> cells;
    for (;;) {
        const std::size_t comma = line.find(',');
        std::string_view  cell  = trimmed(line.substr(0, comma));
        if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
        cells.push_back(cell);
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

/// Takes the next line off the front of the text, without its end.
std::string_view nextLine(std::string_view& text)
{
    const std::size_t end  = text.find('\n');
    std::string_view  line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

bool isSaid(std::string_view line)
{
    return !trimmed(line).empty() && !trimmed(line).starts_with('#');
}

std::string_view withoutMark(std::string_view text)
{
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    return text;
}

/// The columns of a file.
class Header {
public:
    Header(std::string_view line, const std::string& where)
    {
        const auto cells = cellsOf(line);
        for (std::size_t k = 0; k < cells.size(); ++k) {
            const ColumnHead head = columnHead(cells[k]);
            if (head.name == "probe") probe_ = k;
            for (std::size_t c = 0; c < kColumns; ++c)
                if (head.name == kNames[c].name) take(c, k, head, where);
        }
        for (const Column needed : {kDepth, kForce})
            if (!at_[needed])
                throw Error(where + ": expected a column \"" + std::string(kNames[needed].name) +
                            "\", found only: " + std::string(line));
    }

    [[nodiscard]] bool                       has(Column column) const { return at_[column].has_value(); }
    [[nodiscard]] std::optional<std::size_t> probe() const { return probe_; }
    [[nodiscard]] std::size_t                width() const { return width_; }

    [[nodiscard]] bool isBlank(Column column, const std::vector<std::string_view>& cells) const
    {
        return cells[*at_[column]].empty();
    }

    /// Returns the number of a row [SI].
    [[nodiscard]] double read(Column column, const std::vector<std::string_view>& cells, const std::string& where) const
    {
        const std::string_view cell  = cells[*at_[column]];
        const auto             value = parseNumber(cell);
        if (!value || !std::isfinite(*value))
            throw Error(where + ": column " + std::string(kNames[column].name) +
                        ": expected a finite number, found \"" + std::string(cell) + "\"");
        return *value * inSi_[column];
    }

private:
    void take(std::size_t column, std::size_t cell, const ColumnHead& head, const std::string& where)
    {
        if (at_[column])
            throw Error(where + ": expected one column \"" + std::string(kNames[column].name) + "\", found two");
        at_[column]   = cell;
        width_        = std::max(width_, cell + 1);
        inSi_[column] = siPerUnitOf(head, kNames[column].dimension, where);
    }

    std::array<std::optional<std::size_t>, kColumns> at_;
    std::array<double, kColumns>                     inSi_{1, 1, 1, 1, 1, 1, 1, 1, 1};
    std::optional<std::size_t>                       probe_;
    std::size_t                                      width_ = 0; // cells that a row must have
};

/// Rows of one probe may differ so much in where it began to touch: what a robot's encoders tell twice [m].
constexpr double kSamePlace = 0.1e-3;
/// The same of its direction, unit vectors apart [1].
constexpr double kSameDirection = 0.02;

std::string placeText(const glm::dvec3& place)
{
    return "(" + formatQuantity(place.x, "m") + ", " + formatQuantity(place.y, "m") + ", " +
           formatQuantity(place.z, "m") + ")";
}

/// A probe and the line of each of its rows.
struct Draft {
    Probe                    probe;
    std::vector<std::size_t> lines;
};

std::string opening(const Draft& draft, const std::string& name, std::size_t row)
{
    return name + ", line " + std::to_string(draft.lines[row]) + ": probe " + draft.probe.name + ": ";
}

void checkForces(const Draft& draft, const std::string& name)
{
    const Probe& p = draft.probe;
    const auto   strongest =
        std::ranges::max_element(p.force, [](double a, double b) { return std::abs(a) < std::abs(b); });
    const std::size_t row = std::size_t(strongest - p.force.begin());
    if (*strongest < 0)
        throw Error(opening(draft, name, row) + "expected forces above zero where it is pressed, found " +
                    formatQuantity(*strongest, "N") + " at a depth of " + formatQuantity(p.depth[row], "m") +
                    "; if the file counts a push as negative, turn the sign of the column");
    if (*strongest > kStrongest)
        throw Error(opening(draft, name, row) + "expected a force of at most " + formatQuantity(kStrongest, "N") +
                    ", found " + formatQuantity(*strongest, "N") +
                    "; if these are millinewtons, call the column \"force [mN]\"");
    if (!(*strongest > kWeakest))
        throw Error(opening(draft, name, row) + "expected a force above " + formatQuantity(kWeakest, "N") +
                    ", found none");
}

void checkDepths(const Draft& draft, const std::string& name)
{
    const Probe& p = draft.probe;
    for (std::size_t n = 0; n < p.depth.size(); ++n) {
        if (p.depth[n] < 0)
            throw Error(opening(draft, name, n) +
                        "expected a depth of 0 or more, counted from the touch into the "
                        "object, found " +
                        formatQuantity(p.depth[n], "m"));
        if (p.depth[n] > kDeepest)
            throw Error(opening(draft, name, n) + "expected a depth of at most " + formatQuantity(kDeepest, "m") +
                        ", found " + formatQuantity(p.depth[n], "m") +
                        "; if these are millimetres, call the column \"depth [mm]\"");
        if (n == 0) continue;
        if (p.time.empty() && p.depth[n] < p.depth[n - 1])
            throw Error(opening(draft, name, n) + "expected depths that rise from row to row, found " +
                        formatQuantity(p.depth[n], "m") + " after " + formatQuantity(p.depth[n - 1], "m") +
                        "; sort the rows, or add a column \"time\" if the probe also went back");
        if (!p.time.empty() && p.time[n] - p.time[0] > kLongest)
            throw Error(opening(draft, name, n) + "expected times over " + formatQuantity(kLongest, "s") +
                        " at most, found " + formatQuantity(p.time[n] - p.time[0], "s"));
        if (!p.time.empty() && !(p.time[n] > p.time[n - 1]))
            throw Error(opening(draft, name, n) + "expected times that rise from row to row, found " +
                        formatQuantity(p.time[n], "s") + " after " + formatQuantity(p.time[n - 1], "s"));
    }
    const double least = *std::ranges::min_element(p.depth);
    if (!(p.deepest() - least > kShallowest) && !(p.deepest() > kShallowest && !p.time.empty()))
        throw Error(opening(draft, name, 0) + "expected depths that differ, found " + formatQuantity(least, "m") +
                    " in every row");
}

void check(const Draft& draft, const std::string& name)
{
    const std::size_t rows = draft.probe.depth.size();
    if (rows < kFewestRows)
        throw Error(opening(draft, name, rows - 1) + "expected at least " + std::to_string(kFewestRows) +
                    " rows, found " + std::to_string(rows) + "; fewer do not tell a law from another");
    checkForces(draft, name);
    checkDepths(draft, name);
}

} // namespace

double Probe::deepest() const noexcept
{
    return *std::ranges::max_element(depth);
}

double Probe::forceRange() const noexcept
{
    const auto [least, most] = std::ranges::minmax_element(force);
    return *most - *least;
}

bool holdsProbes(const std::filesystem::path& file)
{
    InputFile   stream = openForReading(file);
    std::string line;
    for (int n = 0; n < 100 && std::getline(stream, line); ++n) {
        if (line.size() > 4096) return false; // no line of a header
        if (line.ends_with('\r')) line.pop_back();
        const std::string_view said = n == 0 ? withoutMark(line) : std::string_view(line);
        if (!isSaid(said)) continue;
        bool depth = false, force = false;
        for (const std::string_view cell : cellsOf(said)) {
            depth |= columnHead(cell).name == "depth";
            force |= columnHead(cell).name == "force";
        }
        return depth && force;
    }
    return false;
}

std::vector<Probe> readProbes(const std::filesystem::path& file)
{
    return parseProbes(readWhole(file, kLargestFile, "a table of probes of at most 256 MiB"), file.string());
}

std::vector<Probe> parseProbes(std::string_view text, const std::string& name)
{
    std::size_t                        number = 0;
    const auto                         where  = [&] { return name + ", line " + std::to_string(number); };
    std::optional<Header>              header;
    std::vector<Draft>                 drafts;
    std::map<std::string, std::size_t> known;
    text = withoutMark(text);
    while (!text.empty()) {
        const std::string_view line = nextLine(text);
        ++number;
        if (!isSaid(line)) continue;
        if (!header) {
            header.emplace(line, where());
            continue;
        }
        const auto cells = cellsOf(line);
        if (cells.size() < header->width())
            throw Error(where() + ": expected at least " + std::to_string(header->width()) + " numbers, found " +
                        std::to_string(cells.size()));
        const std::string called =
            header->probe() && *header->probe() < cells.size() ? std::string(cells[*header->probe()]) : "1";
        const auto point = [&](Column x, Column y, Column z) -> std::optional<glm::dvec3> {
            if (!header->has(x) || !header->has(y) || !header->has(z)) return {};
            if (header->isBlank(x, cells) && header->isBlank(y, cells) && header->isBlank(z, cells)) return {};
            return glm::dvec3(header->read(x, cells, where()), header->read(y, cells, where()),
                              header->read(z, cells, where()));
        };
        const auto place       = point(kX, kY, kZ),
                   normal      = point(kNx, kNy, kNz); // a first row's, where later ones are blank
        const auto [at, fresh] = known.try_emplace(called, drafts.size());
        if (fresh) {
            if (drafts.size() == kMostProbes)
                throw Error(where() + ": expected at most " + std::to_string(kMostProbes) +
                            " probes, found more; the column \"probe\" names "
                            "them: it is the same in all rows of one touch");
            drafts.emplace_back();
            drafts.back().probe.name   = shownText(called);
            drafts.back().probe.place  = place;
            drafts.back().probe.normal = normal;
        }
        Draft& draft = drafts[at->second];
        if (place && !draft.probe.place)
            throw Error(where() + ": expected the place of probe " + draft.probe.name +
                        " in its first row, found it in a later one only");
        if (place && glm::distance(*place, *draft.probe.place) > kSamePlace)
            throw Error(where() + ": expected one place in all rows of a probe, that where it begins to touch, found " +
                        placeText(*place) + " after " + placeText(*draft.probe.place) + " of probe " +
                        draft.probe.name + ", " + formatQuantity(glm::distance(*place, *draft.probe.place), "m") +
                        " apart; " + (header->probe() ? "" : "name several probes by a column \"probe\", or ") +
                        "state the place in the first row alone");
        if (normal && draft.probe.normal &&
            glm::distance(glm::normalize(*normal), glm::normalize(*draft.probe.normal)) > kSameDirection)
            throw Error(where() + ": expected one direction nx, ny, nz in all rows of probe " + draft.probe.name +
                        ", found another one; state it in the first row alone");
        draft.lines.push_back(number);
        draft.probe.depth.push_back(header->read(kDepth, cells, where()));
        draft.probe.force.push_back(header->read(kForce, cells, where()));
        if (header->has(kTime)) draft.probe.time.push_back(header->read(kTime, cells, where()));
    }
    if (drafts.empty()) throw Error(name + ": expected rows below a header line, found none");
    std::vector<Probe> probes;
    for (Draft& draft : drafts) {
        check(draft, name);
        probes.push_back(std::move(draft.probe));
    }
    return probes;
}

} // namespace palp::fit
