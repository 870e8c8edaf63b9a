#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Reads an STL file, ASCII or binary; see parseCloud. It is binary if it is as long as the number of triangles at byte
/// 80 says, also if it begins with "solid". Corners at exactly the same place become one point. Normals and colours are
/// not used.
[[nodiscard]] LoadedCloud parseStl(std::istream& stream, std::uint64_t size, const std::string& name,
                                   const CloudReadSettings& settings);

} // namespace palp
