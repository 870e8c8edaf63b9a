#pragma once
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Reads a PCD file of version 0.5 to 0.7, ascii, binary or binary_compressed; see parseCloud. The viewpoint is not
/// used.
/// \source the Point Cloud Library's "The PCD (Point Cloud Data) file format"
[[nodiscard]] LoadedCloud parsePcd(std::istream& stream, std::uint64_t size, const std::string& name,
                                   const CloudReadSettings& settings);

/// Writes a PCD 0.7 file of doubles; see formatCloud.
/// \throws Error for the big-endian encoding, which the format does not have
void formatPcd(std::ostream& stream, const PointCloud& cloud, std::span<const NamedField> extraFields,
               const CloudWriteSettings& settings);

} // namespace palp
