#pragma once
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Reads a PLY file; see parseCloud. Every element is read to the end of the file, so that a file which was cut short
/// is refused even if its points are whole. Numbers that are not used are ignored.
/// \source Turk 1994, "The PLY Polygon File Format"
/// \differs an element's row in an ascii file must stand on one line, and blank lines are skipped
[[nodiscard]] LoadedCloud parsePly(std::istream& stream, std::uint64_t size, const std::string& name,
                                   const CloudReadSettings& settings);

/// Writes a PLY file of doubles; see formatCloud. Extra fields state their unit in `comment unit NAME UNIT`.
/// The corners of a face are ints, or uints where an int does not reach.
void formatPly(std::ostream& stream, const PointCloud& cloud, std::span<const NamedField> extraFields,
               const CloudWriteSettings& settings);

} // namespace palp
