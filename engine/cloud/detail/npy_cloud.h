#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Reads an array of NumPy with a row for each point: n x 3 (x, y, z), n x 4 (and the stiffness) or n x 7 (x, y, z, a
/// normal, the stiffness); see parseCloud and readNpyRows.
[[nodiscard]] LoadedCloud parseNpyCloud(std::istream& stream, std::uint64_t size, const std::string& name,
                                        const CloudReadSettings& settings);

} // namespace palp
