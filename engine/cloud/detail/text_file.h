#pragma once
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Reads a text file of one point per line; see parseCloud.
///
/// The separator is the semicolon if the first line of numbers has one, else the comma if it has one, else blanks; the
/// point is the decimal mark. Lines that start with '#' are comments. The first line is a header if
/// CloudReadSettings::columns names the columns or one of its words is no number; CloudCompare's header line, which
/// starts with "//", counts as one. Without names, lines of three numbers are x y z and of four x y z stiffness; longer
/// lines need names, because the fourth number could be part of a normal.
[[nodiscard]] LoadedCloud parseText(std::istream& stream, std::uint64_t size, const std::string& name,
                                    const CloudReadSettings& settings);

/// Writes a text file with a header line; see formatCloud.
void formatText(std::ostream& stream, const PointCloud& cloud, std::span<const NamedField> extraFields,
                const CloudWriteSettings& settings);

} // namespace palp
