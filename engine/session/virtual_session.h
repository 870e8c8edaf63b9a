#pragma once
#include <atomic>

#include "engine/session/session_parts.h"
#include "engine/session/session_summary.h"

namespace palp {

/// Runs a whole session on one thread and its own clock, with a tick each millisecond. A patch is solved every 1/rate
/// seconds and used one period after its touch, as if the deformation had a thread of its own. The same scene, hand and
/// device give the same records, bit for bit, but for tickTime.
///
/// \param seconds  how long [s]
/// \param onTick   sees every tick; may be empty
/// \param stop     ends the session once it is true; may be null
/// \throws anything that the solver throws
SessionSummary runVirtual(const SessionParts& parts, double seconds, const OnTick& onTick = {},
                          const std::atomic<bool>* stop = nullptr);

} // namespace palp
