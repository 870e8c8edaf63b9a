#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/core/enum_names.h"
#include "engine/tools/cli/haptic_list.h"

namespace palp {

/// How a part of the machine is.
enum class Verdict : std::uint8_t {
    ok,
    warning, ///< it works, but worse than it could
    missing  ///< what needs it does not work
};
constexpr auto namesOf(Verdict)
{
    using enum Verdict;
    return std::to_array<NamedValue<Verdict>>({{ok, "ok"}, {warning, "warning"}, {missing, "missing"}});
}

/// One finding, without names of people, files or serial numbers: it is meant to be pasted into a report.
struct Finding {
    std::string part; ///< "vulkan"
    Verdict     verdict = Verdict::ok;
    std::string found;  ///< what there is
    std::string help{}; ///< the one line that helps; empty: nothing to do
};

/// Every part of the machine that a session needs. Takes under a second. For some milliseconds a thread of its own asks
/// for real-time scheduling and locks all memory, then gives both back.
[[nodiscard]] std::vector<Finding> examine(const HapticList& haptics);

/// What the program is made of: its version, compiler, libraries, and the system below.
struct Make {
    std::string palpate, compiler, libraries, system;
};
[[nodiscard]] Make make();

} // namespace palp
