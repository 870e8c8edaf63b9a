#pragma once
#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "engine/session/scene_keys.h"

namespace palp {

/// The options by which every command is given what it touches: a scene file, a cloud file or sample:NAME, and a flag for
/// each key of scenes that the command has a use for.
///
/// Plain numbers of lengths among the flags are in the unit of --length-unit (or of the scene's length_unit), else metres.
struct SceneSource {
    std::string                                     name;
    std::map<std::string, std::string, std::less<>> flags; ///< of the scene's keys, as given

    /// Adds SCENE, which may be omitted if `name` has a value, and the flags up to that group. `this` must outlive the
    /// command's parsing.
    void addTo(CLI::App& command, SceneKey::Group upTo);

    /// A scene file ends in .json; anything else is a cloud, and the scene is what suits it.
    /// \throws Error as readScene() does, and for a flag that another one makes useless
    [[nodiscard]] Scene load() const;

    /// The scene's cloud, as palp::loadCloud() gives it.
    /// \throws Error as loadCloud() does, and for a length that was taken as metres where the file states another unit
    [[nodiscard]] LoadedCloud  loadCloud(const Scene& scene) const;
    [[nodiscard]] LoadedObject loadObject(const Scene& scene) const; ///< the same with its index and material

    /// "sample:skin", or the file's name without its ending.
    [[nodiscard]] std::string title() const;
};

/// The scene of a scene file, cloud file or sample, with these values over it and all that the environment says.
[[nodiscard]] Scene sceneFrom(const std::string& name, const std::map<std::string, std::string, std::less<>>& flags);

/// Metres in one unit of a plain number of a length on the command line.
[[nodiscard]] double metresPerPlainNumber(const SceneSource& source, const Scene& scene);

} // namespace palp
