#pragma once
#include <atomic>

#include "engine/session/session_parts.h"
#include "engine/session/session_summary.h"

namespace palp {

/// A whole session on one thread and its own clock: a tick a millisecond, a patch every 1/rate seconds that is in use
/// one period after the touch it was solved for, as a thread of its own would have it. The same scene, hand and device
/// give the same samples, bit for bit, but for tickTime.
///
/// \param seconds   how long [s]
/// \param onTick  sees every sample; may be empty
/// \param stop      ends the session once it is true; may be null
/// \throws what the solver throws
SessionSummary runVirtual(const SessionParts& parts, double seconds, const OnTick& onTick = {},
                          const std::atomic<bool>* stop = nullptr);

} // namespace palp
