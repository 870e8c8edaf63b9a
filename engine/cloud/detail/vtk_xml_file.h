#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Reads a file of VTK's XML form (.vtp, .vtu): PolyData or UnstructuredGrid of any number of pieces; arrays as text,
/// in base 64 or appended, raw or in base 64, compressed by zlib or not, in either byte order; see parseCloud. Arrays
/// that are not used are not looked at.
/// \source VTK, "VTK XML formats"
[[nodiscard]] LoadedCloud parseVtkXml(std::istream& stream, std::uint64_t size, const std::string& name,
                                      const CloudReadSettings& settings);

} // namespace palp
