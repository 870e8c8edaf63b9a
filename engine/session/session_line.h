#pragma once
#include "engine/session/real_session.h"

namespace palp {

/// Writes one line to standard error, over the one before: what the hand feels, and how fast the engine is.
void showLine(const SessionView& view);

/// Clears that line.
void clearLine();

} // namespace palp
