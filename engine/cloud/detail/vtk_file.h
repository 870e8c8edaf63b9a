#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Reads a VTK file of the old form (.vtk), ascii or binary: POLYDATA, UNSTRUCTURED_GRID or STRUCTURED_GRID, with cells
/// as versions up to 4.2 and from 5.0 on write them; see parseCloud. Data of points becomes properties; that of cells
/// and of the whole is checked and skipped.
/// \source VTK, "VTK File Formats", the simple legacy formats
/// \differs arrays of strings and of unknown types are refused; a "long" has 8 bytes, as on every system but Windows
[[nodiscard]] LoadedCloud parseVtk(std::istream& stream, std::uint64_t size, const std::string& name,
                                   const CloudReadSettings& settings);

} // namespace palp
