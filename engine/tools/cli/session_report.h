#pragma once
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/session/session_summary.h"

namespace palp {

/// What a session did, as the programs tell it.
[[nodiscard]] nlohmann::json jsonOf(const SessionSummary& summary);

/// \param device  that solved the plate  \param hand  what the hand was
void printText(const SessionSummary& summary, const std::string& device, const std::string& hand);

/// What was not as it should be, in sentences. Empty is good.
[[nodiscard]] std::vector<std::string> warningsOf(const SessionSummary& summary);

} // namespace palp
