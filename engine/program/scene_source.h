#pragma once
#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "engine/session/scene.h"

namespace palp {

/// Values of scene keys, as given on a command line.
using SceneFlags = std::map<std::string, std::string, std::less<>>;

/// Whether a bare cloud file needs a place to be touched at.
enum class PlaceNeeded { yes, no };

/// A scene file; anything else is a cloud, and the scene is what suits it.
/// \throws Error as readScene(); for a cloud file without a place, if one is needed
[[nodiscard]] Scene sceneFrom(const std::string& what, const SceneFlags& flags, PlaceNeeded place);

/// Adds every key of a scene as an option; `place` is called --at too.
void addSceneOptions(CLI::App& command, SceneFlags& flags);

} // namespace palp
