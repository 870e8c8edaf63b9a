#pragma once
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/cloud/point_cloud_io.h"
#include "engine/session/scene.h"

namespace palp {

/// What was read, for --json: points, bounds, units, where the stiffness came from.
/// \param name  of the cloud or scene, as the user wrote it
[[nodiscard]] nlohmann::json cloudJson(const std::string& name, const LoadedCloud& loaded);

/// "x,y,z" as --at takes it, to about a thousandth of a cloud of that diagonal [m].
[[nodiscard]] std::string placeText(const glm::dvec3& place, double diagonal, double metresPerUnit = 1);

/// What was assumed of a cloud's file because nobody stated it, in sentences. Empty is good.
[[nodiscard]] std::vector<std::string> assumptions(const Scene& scene, const CloudFileReport& report);

/// The assumptions, a law that changes nothing, and what a hunt has hidden in the stiffness.
[[nodiscard]] std::vector<std::string> cloudWarnings(const Scene& scene, const PointCloud& cloud,
                                                     const CloudFileReport& report);

/// What a hunt has hidden in the scene, for commands that do not score it; empty if there is none.
[[nodiscard]] std::vector<std::string> huntNote(const Scene& scene, const PointCloud& cloud);

/// A command that reads a cloud and writes another must not write over what it reads: that would be lost. Any other file
/// of that name is replaced, by every command, once the new one is whole.
/// \param option  that names the target
/// \throws Error if both are the same file
void refuseSourceAsTarget(const std::string& option, const std::string& source, const std::string& target);

} // namespace palp
