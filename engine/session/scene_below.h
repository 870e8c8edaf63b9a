#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/cloud/tissue_below.h"

namespace palp {

struct Scene;

/// What a scene says of the tissue below the sheet.
struct SceneBelow {
    TissueBelow tissue; ///< without its volume
    std::string volume; ///< law of a grid, see parseSpatialLaw; empty: the tissue is even

    std::string foundation;    ///< law of the foundation over the cloud [Pa/m], see parseSpatialLaw; empty: none
    bool        isOwn = false; ///< the foundation is the file's property of that name

    [[nodiscard]] bool isTissue() const noexcept { return tissue.depth > 0; }
    [[nodiscard]] bool isThere() const noexcept { return isTissue() || isOwn || !foundation.empty(); }
};

inline constexpr std::string_view kBelowForm =
    R"(an object such as {"depth":0.015,"modulus":2e4,"nodules":[{"at":[0,0,0],"depth":0.01,"radius":5e-3,"modulus":1e6}]})";

/// Reads the value of the key "below": "depth" of the tissue and its "modulus", perhaps "nodules" and a "volume"; or a
/// law of the "foundation"; or "own", the file's property foundation.
/// \param what  opens complaints
/// \throws Error naming the key, what was expected and found
[[nodiscard]] SceneBelow parseBelow(std::string_view text, const std::string& what);

/// Writes what parseBelow() reads; empty if there is nothing.
[[nodiscard]] std::string belowJson(const SceneBelow& below);

/// Returns the JSON Schema of the value.
[[nodiscard]] std::string_view belowSchema();

/// Returns the text with the volume's file in a folder, unless its path is absolute; any other text as it is.
[[nodiscard]] std::string belowWithFileIn(const std::string& text, const std::filesystem::path& folder);

/// Returns the object on the foundation that the scene's tissue, law or file, and its overlay make; without any, the
/// object as it is.
/// \param ofFile  the foundation below each point, of the file [Pa/m]; may be empty
/// \throws Error as foundationShape() does, if the volume cannot be read, if the scene has no foundation to vary, and
///         if the overlay lays nodules below a sheet under which there is no tissue
[[nodiscard]] SoftObject onTissue(const SoftObject& object, const Scene& scene, std::span<const double> ofFile = {});

/// Returns, a sentence each, where the scene's tissue leaves the range of the solids that foundationShape() was
/// compared with, so that the contrast of its nodules or volume is a guess.
[[nodiscard]] std::vector<std::string> beyondComparedTissue(const Scene& scene);

} // namespace palp
