#pragma once
#include "engine/session/real_session.h"

namespace palp {

/// Writes one line to standard error, over the one before: what the hand feels, and how fast the engine is.
void showLine(const SessionView& view);

/// Shows the time and why no force flows, and nothing of what is touched: for a participant.
/// \param seconds  [s] the session's length
void showTime(const SessionView& view, double seconds);

/// Clears that line.
void clearLine();

} // namespace palp
