#pragma once
#include <iosfwd>

#include "engine/session/recorded_session.h"

namespace palp {

/// What a table holds.
struct SessionTable {
    std::uint64_t            ticks = 0;
    std::vector<std::string> doubts{}; ///< TickSource::doubts()
};

/// Writes the ticks of a session as a table: a line of names, then a line for each tick, commas between the numbers.
/// Each number is the shortest text that brings the stored one back; only columns that were recorded are there. The
/// memory that is used does not grow with the session.
/// \throws Error naming a file of the recording
SessionTable writeTable(const RecordedSession& session, std::ostream& out);

} // namespace palp
