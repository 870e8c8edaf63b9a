#pragma once
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Reads a text file of one point per line; see parseCloud.
///
/// Lines that start with '#' are comments. The separator is the semicolon if the first other line has one, else the
/// comma if it has one, else blanks; the point is the decimal mark. That line is a header if it starts with "//", as
/// CloudCompare's does, or if none of its words is a number; CloudReadSettings::columns goes before the names in it.
/// Without names, lines of three numbers are x y z and of four x y z stiffness; longer lines need names, because the
/// fourth number could be part of a normal.
[[nodiscard]] LoadedCloud parseText(std::istream& stream, std::uint64_t size, const std::string& name,
                                    const CloudReadSettings& settings);

/// Writes a text file with a header line; see formatCloud.
void formatText(std::ostream& stream, const PointCloud& cloud, std::span<const NamedField> extraFields,
                const CloudWriteSettings& settings);

} // namespace palp
