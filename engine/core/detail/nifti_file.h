#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>

#include "engine/core/volume_grid.h"

namespace palp {

/// Reads a NIfTI-1 file, as it is or compressed by gzip; see readVolume.
[[nodiscard]] VolumeGrid parseNifti(std::istream& in, std::uint64_t size, const std::string& name,
                                    const VolumeSettings& settings);

} // namespace palp
