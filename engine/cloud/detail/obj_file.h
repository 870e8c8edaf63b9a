#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Reads a Wavefront OBJ file: `v` and `f` in any of its forms, also counted from the end; see parseCloud. Faces name
/// vertices above them. Texture coordinates, normals, groups and materials mean nothing here; other lines are omitted
/// with a warning. A comment may state the length unit.
[[nodiscard]] LoadedCloud parseObj(std::istream& stream, std::uint64_t size, const std::string& name,
                                   const CloudReadSettings& settings);

} // namespace palp
