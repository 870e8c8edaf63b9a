#pragma once
#include <span>
#include <string>
#include <vector>

#include "engine/tools/paper/section.h"

namespace palp::report {

/// The origins of a report: how it was made, so that it can be made again.
struct Origins {
    std::string version, commit, libraries, machine, solver, command;
    bool        quick = false;
};

/// Writes one self-contained HTML file: the claims, then a part for each section with its pictures.
[[nodiscard]] std::string reportPage(std::span<const Section> sections, const Origins& origins);

/// Writes one self-contained HTML file of sections alone, below a title and paragraphs.
[[nodiscard]] std::string plainPage(const std::string& title, std::span<const std::string> text,
                                    std::span<const Section> sections);

/// Writes every number of the sections except those that a clock measured: the bytes are the same from run to run on
/// one processor. NaN and infinity are null.
[[nodiscard]] std::string numbersJson(std::span<const Section> sections, const Origins& origins);

/// Writes the numbers that a clock measured, and the machine.
[[nodiscard]] std::string timingsJson(std::span<const Section> sections, const Origins& origins);

} // namespace palp::report
