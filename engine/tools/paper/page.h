#pragma once
#include <span>
#include <string>
#include <vector>

#include "engine/tools/paper/section.h"

namespace palp::report {

/// What a report says about itself: how it was made, so that it can be made again.
struct Origins {
    std::string version, commit, libraries, machine, device, command;
    bool        quick = false;
};

/// One HTML file that needs no other: the claims, then a part for each section with its pictures.
[[nodiscard]] std::string reportPage(std::span<const Section> sections, const Origins& origins);

/// Every number of the sections and nothing that a clock measured: the same bytes from run to run on one device.
/// Values that are no number are null.
[[nodiscard]] std::string numbersJson(std::span<const Section> sections, const Origins& origins);

/// What a clock measured, and on which machine.
[[nodiscard]] std::string timingsJson(std::span<const Section> sections, const Origins& origins);

} // namespace palp::report
