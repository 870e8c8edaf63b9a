#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/cloud/cloud_quality.h"
#include "engine/pipeline/dent_length.h"
#include "engine/session/scene.h"

namespace palp {

/// The reasons why the outward side of points is known, as shares of all points [1].
struct SideSources {
    double file   = 0; ///< normals in the file
    double faces  = 0;
    double layers = 0; ///< the other side of a thin body is near
};

/// \param normals  of the file, as LoadedCloud has them
[[nodiscard]] SideSources sideSources(const SoftObject& object, std::span<const glm::vec3> normals);

/// The quality of a scan and what is needed to judge it.
struct QualityReport {
    CloudQuality quality;
    SideSources  sides;
    double       rounding  = 0; ///< step of the file's coordinates [m]
    double       fingertip = 0; ///< radius [m]
    double       window    = 0; ///< edge of what bends: the patch window, or an object that it spans [m]
    double       size      = 0; ///< diagonal of the object's bounds [m]
    double       closed = 0; ///< width up to which gaps of an object that the window spans are closed [m]; 0: no such
    std::string  refusal{};  ///< why nothing of it is touched; empty if it is
    /// Over which dents die away by themselves; empty: they do not, or the theory is not a shell's.
    std::optional<DentLengths> dents{};
    std::string                whyWindow{}; ///< whyDentWindow()
    BeyondShell                beyond{};    ///< in patch windows; of shells whose window is not all of the object
    std::string                sparse{};    ///< sparseForCurvature(), of shells
    bool                       cut = false; ///< windows are cut from the object as a whole, see isCutFromBody()
};

[[nodiscard]] QualityReport qualityReport(const SoftObject& object, const LoadedCloud& loaded, const Scene& scene);

/// Returns what the quality means for a touch, a sentence each; empty for a cloud without a surface.
[[nodiscard]] std::vector<std::string> meaningForTouch(const QualityReport& report);

/// Returns the same numbers and sentences, in SI units.
[[nodiscard]] nlohmann::json jsonOf(const QualityReport& report);

/// Prints the lines on spacing, noise, sides and borders.
void printText(const QualityReport& report, std::size_t duplicates);

/// Returns "3.1 %", "<0.1 %" or "0 %".
[[nodiscard]] std::string percentText(double share);

/// Draws the object in the colours of spacing and of noise, side by side.
/// \param file   ends in .png or .svg
/// \param title  of the picture
/// \throws Error if the file cannot be written, compute::ProcessorError if no processor can draw
void writeQualityPicture(const std::filesystem::path& file, const std::string& title, const SoftObject& object,
                         const CloudQuality& quality);

/// Refuses a name that writeQualityPicture() cannot take.
/// \throws Error naming the option
void demandPictureName(const std::string& option, const std::string& file);

} // namespace palp
