#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Reads the triangles of a binary glTF 2 file (.glb): the meshes of its scene, where its nodes put them, in metres;
/// see parseCloud. Materials, animations and cameras mean nothing here. What would change the triangles is refused by
/// name: sparse accessors, compression and other required extensions, skins and buffers outside of the file.
/// \source Khronos, "glTF 2.0 Specification"
[[nodiscard]] LoadedCloud parseGlb(std::istream& stream, std::uint64_t size, const std::string& name,
                                   const CloudReadSettings& settings);

} // namespace palp
