#pragma once
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// The property of the new file that holds the stiffness.
struct RepaintedPly {
    std::string property;
    bool        appended = false; ///< the original holds none, or one in no physical unit
};

/// Writes a PLY file again with another stiffness, whole or not at all. Everything else keeps its bytes: encoding,
/// comments, elements, the other properties with their names, types and order, and also the stiffness of points whose
/// value is the same. Rows that were merged to one point get its new stiffness, and keep their own if it was not
/// painted.
///
/// The stiffness keeps its name (MeshLab's "quality", CloudCompare's "scalar_stiffness") and its type, but integers,
/// and floats that could not hold a value, become doubles. It is appended as a double "stiffness" (of a rigidity
/// "flexural_rigidity", unless a property "stiffness" or "scalar_stiffness" would be taken for it; then "stiffness") if
/// the original has none, or took it through a range. A comment stiffness_unit is written if one is needed to read the
/// right kind. A property that only a setting made the stiffness is found again only by that setting.
/// \param readAs   the settings with which the original was read
/// \param painted  the original's points, in their order, with their new stiffness
/// \param target   may be the original itself
/// \throws Error naming the file if it has other points than `painted`, lost points to dropInvalid, or has a property
///         of the name that is to be appended
[[nodiscard]] RepaintedPly repaintPly(const std::filesystem::path& original, const CloudReadSettings& readAs,
                                      const PointCloud& painted, const std::filesystem::path& target);

/// Does the same between streams; the original has `size` bytes, can be sought in, and is called `name` in messages.
[[nodiscard]] RepaintedPly formatRepaintedPly(std::ostream& stream, std::istream& original, std::uint64_t size,
                                              const std::string& name, const CloudReadSettings& readAs,
                                              const PointCloud& painted);

} // namespace palp
