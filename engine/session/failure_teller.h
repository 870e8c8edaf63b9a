#pragma once
#include <functional>
#include <string>

#include "engine/session/deformation.h"

namespace palp {

/// Returns the solver, which also says at once why a touch has no patch, or who took over solving: once for each kind
/// of reason, places and numbers apart, because a hand that slides over a bad spot fails 60 times a second.
/// \param tell  is given a whole sentence, on the solver's thread; it may print
[[nodiscard]] PatchSolver tellingFailures(PatchSolver solver, std::function<void(const std::string&)> tell);

} // namespace palp
