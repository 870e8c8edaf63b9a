#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/force/governor.h"
#include "engine/tools/gui/panels.h"

namespace palp {

/// The explanation of a fault: a sentence on its reason and one on its remedy.
struct FaultAdvice {
    const char* reason;
    const char* remedy;
};

/// Returns the advice on a fault; the sentences of GovernorFault::none are empty.
[[nodiscard]] FaultAdvice adviceOn(GovernorFault fault) noexcept;

/// Returns the governor's fault of a record; see TickRecord::faults.
[[nodiscard]] GovernorFault governorFault(const TickRecord& record) noexcept;

/// Returns the meanings of the other bits that are set in a record's faults, each a sentence with its remedy.
/// \param words  of the device about its fault; may be empty
[[nodiscard]] std::vector<std::string> notesOn(const TickRecord& record, std::string_view words = {});

/// Returns whether anything needs the user's attention: a fault of the session, or one that the window has found.
[[nodiscard]] bool needsAttention(const PanelContent& content) noexcept;

} // namespace palp
