#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "engine/tools/paper/section.h"

namespace palp::report {

/// The parts of the report, each in a file of its own: the paper's experiments and claims, computed again.
/// \source Kumari & Chaudhuri 2016

[[nodiscard]] Section placesPart(const ReportRun& run);     ///< a: deflection at several places of the ellipsoid
[[nodiscard]] Section lobePart(const ReportRun& run);       ///< b: the dip in a thin lobe, clamped and free
[[nodiscard]] Section timePart(const ReportRun& run);       ///< c: time of a deformation
[[nodiscard]] Section stabilityPart(const ReportRun& run);  ///< d: random maps of rigidity, all edges
[[nodiscard]] Section jacobiPart(const ReportRun& run);     ///< e: undamped Jacobi and its stopping rule
[[nodiscard]] Section mapsPart(const ReportRun& run);       ///< f: the three maps on one cap
[[nodiscard]] Section wartPart(const ReportRun& run);       ///< g: felt stiffness along a line over a wart
[[nodiscard]] Section perceptionPart(const ReportRun& run); ///< h: what would be noticed, predicted
[[nodiscard]] Section flatnessPart(const ReportRun& run);   ///< i: what it costs to bend a curved object as a flat plate

/// Appends to the part of the lobe the dip in an ear of the Stanford bunny, from the user's own copy.
/// \throws Error naming the file and what is wrong with it
void addBunny(Section& lobe, const std::filesystem::path& file, const ReportRun& run);

/// Appends to the part of flatness places all over the bunny.
/// \throws Error naming the file and what is wrong with it
void addCurvedBunny(Section& flatness, const std::filesystem::path& file, const ReportRun& run);

/// Returns the bunny's maker and terms of use, to be shown to its users.
[[nodiscard]] const std::string& bunnyTerms();

} // namespace palp::report
