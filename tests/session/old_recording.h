#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "engine/session/tick_record.h"

namespace palp {

/// Writes ticks as format 1 did: a .npy file per column, of doubles where they are floats today. Columns that it did
/// not have are omitted.
inline void writeOldColumns(const std::filesystem::path& folder, const std::vector<TickRecord>& records)
{
    static constexpr std::string_view kLater[] = {"answer_time", "answer_age",  "wanted",          "orientation",
                                                  "stiffness",   "tank_energy", "observer_energy", "actions",
                                                  "answers",     "grip"};
    for (const SessionColumn& column : sessionColumns()) {
        if (std::ranges::find(kLater, column.name) != std::end(kLater)) continue;
        const bool  wide   = column.recordBytes() == sizeof(double);
        std::string header = "{'descr': '" + (wide ? "<f8" : std::string(column.numpyType())) +
                             "', 'fortran_order': False, 'shape': (" + std::to_string(records.size()) +
                             (column.components > 1 ? ", " + std::to_string(column.components) : ",") + "), }";
        header.resize(117, ' ');
        header += '\n';
        std::ofstream file(folder / (std::string(column.name) + ".npy"), std::ios::binary);
        file << std::string("\x93NUMPY\x01\x00\x76\x00", 10) << header;
        for (const TickRecord& record : records)
            file.write(reinterpret_cast<const char*>(&record) + column.offset,
                       std::streamsize(column.components * column.recordBytes()));
    }
}

} // namespace palp
