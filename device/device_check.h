#pragma once
#include <cstdint>
#include <string>

#include "engine/core/enum_names.h"

namespace palp {

/// The condition of a part of the machine.
enum class Verdict : std::uint8_t {
    ok,
    warning, ///< it works, but worse than it could
    missing  ///< whatever needs it does not work
};
constexpr auto namesOf(Verdict)
{
    using enum Verdict;
    return std::to_array<NamedValue<Verdict>>({{ok, "ok"}, {warning, "warning"}, {missing, "missing"}});
}

/// One finding about the machine. It names no people, files or serial numbers, because reports quote it.
struct Finding {
    std::string part; ///< "vulkan"
    Verdict     verdict = Verdict::ok;
    std::string found;  ///< what was found
    std::string help{}; ///< one line that helps; empty if nothing is to be done
};

/// Tries whether the guardian process, without which no device is driven that pushes, can be started.
[[nodiscard]] Finding checkGuardian();

} // namespace palp
