#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/session/session_summary.h"

namespace palp {

/// Returns a session's summary as all commands print it.
[[nodiscard]] nlohmann::json jsonOf(const SessionSummary& summary);

/// Prints the same on standard output.
/// \param solver  solved the plate
/// \param hand    the kind of hand
void printText(const SessionSummary& summary, const std::string& solver, const std::string& hand);

/// Returns, in sentences, what was not as it should be; empty if nothing was.
[[nodiscard]] std::vector<std::string> warningsOf(const SessionSummary& summary);

/// Returns why the force was stopped for good, in a sentence; empty if it was not.
[[nodiscard]] std::string whyStopped(const SessionSummary& summary);

} // namespace palp
