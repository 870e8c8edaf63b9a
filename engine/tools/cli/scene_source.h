#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "engine/session/scene.h"

namespace palp {

/// Whether a bare cloud file needs a place to be touched at.
enum class PlaceNeeded { yes, no };

/// The options by which programs are given a scene: a scene file, a cloud file or sample:NAME, and a flag for each key.
struct SceneSource {
    std::string                                     name;
    std::map<std::string, std::string, std::less<>> flags; ///< of the scene's keys, as given

    /// Adds SCENE and the flags to a command; `this` must outlive its parsing.
    void addTo(CLI::App& command);
    /// The flags alone. In a hunt --seed hides the nodules anew, as --hunt-seed; else it is that of a sample's points.
    enum class Seed { ofTheSample, ofTheHunt };
    void addFlagsTo(CLI::App& command, Seed seed = Seed::ofTheSample);

    /// A scene file; anything else is a cloud, and the scene is what suits it.
    /// \throws Error as readScene() does, and for a cloud file without a place, if one is needed
    [[nodiscard]] Scene load(PlaceNeeded place = PlaceNeeded::yes) const;

    /// "sample:skin", or the file's name without its ending.
    [[nodiscard]] std::string title() const;
};

/// What a cloud's file did not say and nobody else did, in sentences.
[[nodiscard]] std::vector<std::string> assumptions(const Scene& scene, const CloudFileReport& report);

} // namespace palp
