#pragma once
#include <filesystem>

#include "engine/cloud/point_cloud.h"

namespace palp::report {

/// The Stanford bunny in the original's size, and the factor of its scaling.
struct Bunny {
    PointCloud cloud;
    double     factor = 1;
};

/// Reads a user's own copy, in any unit.
/// \throws Error naming the file and what is wrong with it
[[nodiscard]] Bunny readBunny(const std::filesystem::path& file);

} // namespace palp::report
