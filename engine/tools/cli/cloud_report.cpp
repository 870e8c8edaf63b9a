#include "engine/tools/cli/cloud_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/extremes.h"
#include "engine/core/quantity.h"
#include "engine/core/shown_text.h"
#include "engine/core/spatial_law.h"
#include "engine/session/scene_below.h"
#include "engine/tools/cli/scene_source.h"
#include "engine/tools/study/hunt_scene.h"

namespace palp {
namespace {

nlohmann::json pointJson(const glm::dvec3& p)
{
    return {p.x, p.y, p.z};
}

} // namespace

void refuseSourceAsTarget(const std::string& option, const std::string& source, const std::string& target)
{
    std::error_code none; // no such file: nothing is lost
    if (!std::filesystem::equivalent(source, target, none) || none) return;
    throw Error(option + ": " + shownPath(target) + " is read as well, and would be overwritten; choose another name");
}

void refuseSameTarget(const std::string& first, const std::string& one, const std::string& second,
                      const std::string& other)
{
    const auto whole = [](const std::string& file) {
        std::error_code none; // a folder that is not there is named when the file is written
        return std::filesystem::weakly_canonical(std::filesystem::absolute(file, none), none);
    };
    if (one.empty() || other.empty() || whole(one) != whole(other)) return;
    throw Error(first + " and " + second + ": expected two files, found " + shownPath(one) +
                " twice, so that one would be lost; name another file");
}

std::string placeText(const glm::dvec3& place, double diagonal)
{
    const int   decimals = std::max(0, int(std::ceil(3 - std::log10(diagonal)))); // a thousandth of the cloud
    std::string text;
    for (int k = 0; k < 3; ++k) {
        char number[64];
        std::snprintf(number, sizeof number, "%.*f", std::min(decimals, 12), place[k]);
        text += std::string(k ? "," : "") + number;
    }
    return text;
}

namespace {

/// Says that of an object that is held only a window bends, where that is not cut from the object; empty else.
std::vector<std::string> heldBeyondWindow(const Scene& scene)
{
    if (!scene.held.isThere() || scene.patch.windowOf == WindowOf::object || asksForBody(scene.patch)) return {};
    return {"what the key held says counts only within the patch window; set --window object for all of it"};
}

} // namespace

std::vector<std::string> assumptions(const Scene& scene, const CloudFileReport& report)
{
    std::vector<std::string> said = unusedVariables();
    if (report.lengthUnitAssumed)
        said.emplace_back(
            "assumed metres: no length_unit is set and the file has no comment on its unit; set --length-unit");
    if (report.stiffnessAssumed && scene.stiffness.empty())
        said.push_back("no stiffness in the file: uniform " + formatQuantity(kDefaultModulus, "Pa") +
                       " assumed; set --uniform or --stiffness");
    said.insert(said.end(), report.warnings.begin(), report.warnings.end());
    for (std::string& line : heldBeyondWindow(scene)) said.push_back(std::move(line));
    for (std::string& line : beyondComparedTissue(scene)) said.push_back(std::move(line));
    return said;
}

std::vector<std::string> leftUnwritten(const LoadedCloud& loaded, const CloudFormatRecord& target)
{
    constexpr std::size_t    kNamed = 8;
    std::vector<std::string> said;
    if (!target.holdsFaces && !loaded.faces.empty())
        said.push_back(counted(loaded.faces.size(), "triangle", "was", "were") + " not written: only " +
                       extensionsFor(CloudUse::writingFaces) + " files hold faces; name such a file to keep them");
    const std::vector<std::string>& unused = loaded.report.unused;
    if (unused.empty()) return said;
    std::string names;
    for (std::size_t n = 0; n < std::min(kNamed, unused.size()); ++n) names += (n > 0 ? ", " : "") + unused[n];
    if (unused.size() > kNamed) names += " and " + std::to_string(unused.size() - kNamed) + " more";
    said.push_back("not written: " + names + "; nothing was read from " + (unused.size() == 1 ? "it" : "them"));
    return said;
}

std::vector<std::string> huntNote(const Scene& scene, const PointCloud& cloud)
{
    const study::HiddenNodules* const hidden = study::hiddenIn(scene);
    if (!hidden) return {};
    return {"the scene's hunt has hidden " + counted(hidden->nodules(cloud, scene).size(), "nodule") +
            " in this stiffness; palpate hunt and palpate view score a search for them"};
}

std::vector<std::string> cloudWarnings(const Scene& scene, const PointCloud& cloud, const CloudFileReport& report)
{
    std::vector<std::string> said = assumptions(scene, report);
    for (std::string& line : huntNote(scene, cloud)) said.push_back(std::move(line));
    if (scene.stiffness.empty()) return said;

    constexpr double kSame  = 1e-6; // relative: no hand feels a smaller difference [1]
    const Bounds&    bounds = cloud.bounds();
    const SpatialLaw law =
        parseSpatialLaw(scene.stiffness, bounds.low, bounds.high, SpatialLaw::Space::volume, LawFiles::left);
    const Extremes found = extremesOf(cloud.stiffness());
    if (law.from != law.to && found.most - found.least <= kSame * found.most)
        said.push_back("the law \"" + scene.stiffness +
                       "\" gives every point the same stiffness: its coordinates are metres, and the cloud's middle is "
                       "at " +
                       placeText(bounds.centre(), bounds.diagonal()) + " m");
    return said;
}

nlohmann::json cloudJson(const std::string& name, const PointCloud& cloud, std::span<const Triangle> faces,
                         const CloudFileReport& report)
{
    const Extremes found = extremesOf(cloud.stiffness());
    return {{"name", name},
            {"format", report.format},
            {"points", cloud.size()},
            {"dropped_points", report.droppedPoints},
            {"duplicate_positions", report.duplicatePositions},
            {"normals", report.normals},
            {"faces", faces.size()},
            {"degenerate_faces", report.degenerateFaces},
            {"dropped_faces", report.droppedFaces},
            {"properties", report.properties},
            {"length_unit_source", report.lengthUnitSource},
            {"stiffness_source", report.stiffnessSource},
            {"stiffness_unit", unitOf(cloud.kind())},
            {"stiffness_min", found.least},
            {"stiffness_max", found.most},
            {"stiffening", report.stiffening ? nlohmann::json{report.stiffening->smallest, report.stiffening->largest}
                                             : nlohmann::json(nullptr)},
            {"foundation", report.foundation ? nlohmann::json{report.foundation->smallest, report.foundation->largest}
                                             : nlohmann::json(nullptr)},
            {"low", pointJson(cloud.bounds().low)},
            {"high", pointJson(cloud.bounds().high)}};
}

} // namespace palp
