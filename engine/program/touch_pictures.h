#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "engine/cloud/point_cloud.h"
#include "engine/pipeline/pipeline.h"

namespace palp {

/// Writes what a touch looks like into a folder: the charts of rigidity and deflection, the profile through the contact,
/// the whole object and a close-up of the dent.
/// \return the names of the files, in the order in which one looks at them
std::vector<std::string> writeTouchPictures(const std::filesystem::path& folder, const PointCloud& cloud,
                                            const Patch& patch, const PatchSettings& settings, double force);

} // namespace palp
