#pragma once
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "engine/session/scene_keys.h"

namespace palp {

/// The options by which every command is told what to touch: a scene file, a cloud file or sample:NAME, and a flag for
/// each key of scenes that the command uses.
///
/// Plain numbers of lengths among the flags are in the unit of --length-unit (or the scene's length_unit), else metres.
struct SceneSource {
    std::string                                     name;
    std::map<std::string, std::string, std::less<>> flags; ///< of the scene's keys, as given

    /// Adds SCENE, which may be omitted if `name` has a value, and the flags up to that group. `this` must outlive the
    /// command's parsing.
    void addTo(CLI::App& command, SceneKey::Group upTo);

    /// Reads the scene: a name ending in .json is a scene file; any other is a cloud, with the scene that suits it.
    /// \throws Error as readScene() does, and for a flag that another one makes useless
    [[nodiscard]] Scene load() const;

    /// Returns the scene's cloud, as palp::loadCloud() does.
    /// \throws Error as loadCloud() does, and for a length that was taken as metres where the file states another unit
    [[nodiscard]] LoadedCloud  loadCloud(const Scene& scene) const;
    [[nodiscard]] LoadedObject loadObject(const Scene& scene) const; ///< does the same, with index and material

    /// Returns "sample:skin", or the file's name without its ending.
    [[nodiscard]] std::string title() const;
};

/// Refuses to write over what the object is made of: SCENE, its cloud, the files of its laws.
/// \param target  may be empty: nothing is written
/// \throws Error that names the option
void refuseSourcesAsTarget(const SceneSource& source, const Scene& scene, const std::string& option,
                           const std::string& target);

/// Returns the scene of a scene file, cloud file or sample, with the flags and the environment's values over it.
[[nodiscard]] Scene sceneFrom(const std::string& name, const std::map<std::string, std::string, std::less<>>& flags);

/// Returns, in sentences, the variables PALPATE_* of the environment that nothing reads: slips, keys' former names and
/// others. Variables without a value count as none.
[[nodiscard]] std::vector<std::string> unusedVariables();

/// Returns the metres that a plain number 1 means as a length on the command line.
[[nodiscard]] double metresPerPlainNumber(const SceneSource& source, const Scene& scene);

} // namespace palp
