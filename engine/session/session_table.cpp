#include "engine/session/session_table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <ostream>
#include <string>
#include <vector>

namespace palp {
namespace {

constexpr std::uint64_t kPart = 4096; // ticks that are in memory [1]

/// Appends a component of a record, and a comma.
void appendNumber(std::string& line, const SessionColumn& column, const char* from)
{
    std::array<char, 32> digits;
    const auto           append = [&](auto number) {
        line.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr);
        line += ',';
    };
    const auto read = [&](auto number) {
        std::memcpy(&number, from, sizeof number);
        return number;
    };
    switch (column.type) {
    case SessionColumn::Type::float64:
        return append(read(double()));
    case SessionColumn::Type::float32:
        return append(static_cast<float>(read(double())));
    case SessionColumn::Type::int32:
        return append(read(std::int32_t()));
    case SessionColumn::Type::uint32:
        return append(read(std::uint32_t()));
    }
}

} // namespace

SessionTable writeTable(const RecordedSession& session, std::ostream& out)
{
    const auto                        ticks = openTicks(session);
    std::vector<const SessionColumn*> columns;
    std::string                       lines;
    for (std::size_t k = 0; k < sessionColumns().size(); ++k)
        if ((ticks->columns() & std::uint64_t(1) << k) != 0) columns.push_back(&sessionColumns()[k]);
    for (const SessionColumn* const column : columns)
        for (std::size_t k = 0; k < column->components; ++k) lines += column->componentName(k) + ",";
    lines.back() = '\n';

    std::vector<TickRecord> part;
    for (std::uint64_t done = 0; done < ticks->rows(); done += part.size()) {
        part.resize(std::size_t(std::min(kPart, ticks->rows() - done)));
        ticks->read(part);
        for (const TickRecord& record : part) {
            const char* const bytes = reinterpret_cast<const char*>(&record);
            for (const SessionColumn* const column : columns)
                for (std::size_t k = 0; k < column->components; ++k)
                    appendNumber(lines, *column, bytes + column->offset + k * column->recordBytes());
            lines.back() = '\n';
        }
        out << lines;
        lines.clear();
    }
    out << lines;
    return {ticks->rows(), ticks->doubts()};
}

} // namespace palp
