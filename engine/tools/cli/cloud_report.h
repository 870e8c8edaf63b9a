#pragma once
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/session/scene.h"

namespace palp {

/// Returns what was read, for --json: points, bounds, units, and where the stiffness came from.
/// \param name  of the cloud or scene, as the user wrote it
[[nodiscard]] nlohmann::json cloudJson(const std::string& name, const PointCloud& cloud,
                                       std::span<const Triangle> faces, const CloudFileReport& report);

/// Returns "x,y,z" [m] as --place takes it, to about a thousandth of a cloud of that diagonal [m].
[[nodiscard]] std::string placeText(const glm::dvec3& place, double diagonal);

/// Returns, in sentences, what was assumed of a cloud's file because nothing states it, what is odd in it, and
/// unusedVariables(): what every command that takes a scene tells.
[[nodiscard]] std::vector<std::string> assumptions(const Scene& scene, const CloudFileReport& report);

/// Returns the assumptions, a law that changes nothing, and what a hunt has hidden in the stiffness.
[[nodiscard]] std::vector<std::string> cloudWarnings(const Scene& scene, const PointCloud& cloud,
                                                     const CloudFileReport& report);

/// Returns in sentences what of a file is not in the one that is written of its cloud: faces that the format does not
/// hold, and properties that nothing was read from.
[[nodiscard]] std::vector<std::string> leftUnwritten(const LoadedCloud& loaded, const CloudFormatRecord& target);

/// Returns what a hunt has hidden in the scene, for commands that do not score it; empty if there is none.
[[nodiscard]] std::vector<std::string> huntNote(const Scene& scene, const PointCloud& cloud);

/// Refuses to write over a file that is read, which would be lost. Any other file of that name is replaced, by every
/// command, once the new one is whole.
/// \param option  names the target
/// \throws Error if both are the same file
void refuseSourceAsTarget(const std::string& option, const std::string& source, const std::string& target);

/// Refuses to write two things into one file.
/// \param first,second  the options that name the files, which may be empty: not written
/// \throws Error if both are the same file
void refuseSameTarget(const std::string& first, const std::string& one, const std::string& second,
                      const std::string& other);

} // namespace palp
