#pragma once
#include <nlohmann/json.hpp>

#include "engine/tools/study/hunt_score.h"

namespace palp {

/// Returns a hunt's score as all commands print it: SI units, names with their unit.
[[nodiscard]] nlohmann::json jsonOf(const study::HuntScore& score);

/// Prints the same as a table on standard output.
void printText(const study::HuntScore& score, const study::Hunt& hunt);

} // namespace palp
