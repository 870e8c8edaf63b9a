#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/force/governor.h"
#include "engine/tools/gui/panels.h"

namespace palp {

/// What a person can make of a fault: a sentence on why, and one on what to do.
struct FaultAdvice {
    const char* reason;
    const char* remedy;
};

/// Of every fault but GovernorFault::none, whose sentences are empty.
[[nodiscard]] FaultAdvice adviceOn(GovernorFault fault) noexcept;

/// The governor's fault of a sample; see TickRecord::faults.
[[nodiscard]] GovernorFault governorFault(const TickRecord& sample) noexcept;

/// What the other bits of a sample's faults say while they are set, each a sentence with its remedy.
[[nodiscard]] std::vector<std::string> notesOn(const TickRecord& sample);

/// Whether anything in the session needs its user's attention: a fault, or whatever the window has found.
[[nodiscard]] bool needsAttention(const PanelContent& content) noexcept;

} // namespace palp
