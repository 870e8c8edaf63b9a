#include "engine/cloud/detail/npy_cloud.h"

#include <optional>
#include <utility>

#include "engine/cloud/detail/cloud_rows.h"
#include "engine/core/npy.h"

namespace palp {
namespace {

/// Returns the meanings of the columns.
CloudHeader headerFor(std::size_t columns, const ByteReader& reader)
{
    CloudHeader header;
    header.format     = "NumPy, " + std::to_string(columns) + " columns";
    header.properties = {"x", "y", "z"};
    if (columns == 7) header.properties.insert(header.properties.end(), {"nx", "ny", "nz"});
    if (columns == 4 || columns == 7) header.properties.push_back("stiffness");
    if (columns != header.properties.size())
        reader.fail("expected 3 columns (x, y, z), 4 (and the stiffness) or 7 (x, y, z, a normal, the stiffness), "
                    "found " +
                    std::to_string(columns) + "; save those columns, such as array[:, :4]");
    return header;
}

} // namespace

LoadedCloud parseNpyCloud(std::istream& stream, std::uint64_t size, const std::string& name,
                          const CloudReadSettings& settings)
{
    const ByteReader         reader(stream, size, name); // reads nothing here: it names the file
    std::optional<CloudRows> rows;
    std::vector<std::size_t> slots;
    readNpyRows(stream, size, name,
                {[&](std::size_t points, std::size_t columns) {
                     rows.emplace(reader, headerFor(columns, reader), settings);
                     rows->makeRoom(points);
                     for (std::size_t i = 0; i < columns; ++i) slots.push_back(rows->slotOf(i));
                 },
                 [&](std::span<const double> row) {
                     CloudRow values{};
                     for (std::size_t i = 0; i < row.size(); ++i)
                         if (slots[i] != kSlots) values[slots[i]] = row[i];
                     rows->add(values, CloudRows::Place::unpacked);
                 },
                 [&](std::uint64_t from, std::uint64_t bytes) { rows->warnOfTail(from, bytes); }});
    return rows->finish();
}

} // namespace palp
