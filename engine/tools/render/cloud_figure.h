#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/tools/plot/axis.h"
#include "engine/tools/plot/patch_pictures.h"
#include "engine/tools/render/surface_renderer.h"

namespace palp {

/// The part of the world that a figure shows.
struct FigureWindow {
    glm::dvec3 centre{};      ///< in the middle of the figure [m]
    double     halfWidth = 1; ///< from the middle to the left edge [m], > 0
};

/// Share of even light in a picture that is about its values [1]: slopes are 0.85 to 1.07 times as bright as the colour
/// in the legend. In the light of a touch they are 0.46 to 1.26 times, and a value in shade looks like a lower one.
inline constexpr double kLightOfValues = 0.72;

/// The content and direction of a figure of a cloud.
struct CloudFigure {
    std::string                 title;
    std::string                 quantity = "deflection";    ///< of the values
    std::string                 unit     = "m";             ///< SI unit of the values; the legend chooses the prefix
    std::optional<ValueRange>   range{};                    ///< ends of the colours [unit]; empty: those of the values
    glm::dvec3                  direction{-0.5, 0.6, -1};   ///< in which the eye looks, of any length
    glm::dvec3                  up{0, 1, 0};                ///< upwards in the figure, not parallel to the direction
    std::optional<FigureWindow> window{};                   ///< empty: the whole cloud
    std::vector<glm::dvec3>     marks{};                    ///< places with a dot on them [m]
    double                      evenLight = kLightOfValues; ///< see ViewScene; 0 where the shape is what matters
};

/// The renderer of figures: opened for the first one and kept for the next ones, because opening a device takes longer
/// than drawing a figure.
class FigureRenderer {
public:
    /// \throws compute::ProcessorError if no device can draw
    [[nodiscard]] SurfaceRenderer& opened() { return renderer_ ? *renderer_ : renderer_.emplace(); }

    /// Notes why a figure is a sentence in place of a picture; each reason once.
    void couldNotDraw(const std::string& why);
    /// Returns warnings for who asked for the figures.
    [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

private:
    std::optional<SurfaceRenderer> renderer_;
    std::vector<std::string>       warnings_;
};

/// Draws a cloud as a lit, closed surface in the colours of a value per point, by parallel projection: a self-contained
/// SVG file around a picture of SurfaceRenderer, with title, colour bar and scale bar.
///
/// Points without a value (NaN) are grey and counted. Without a Vulkan processor that can draw, and for a cloud that
/// has no surface (see CloudSkin), the figure is a sentence that says so, because a command's other output is still
/// useful; the renderer keeps a warning.
/// \param rest    positions at rest, from which neighbours are found [m]
/// \param now     as many positions, which are drawn [m]
/// \param values  as many [figure.unit]
[[nodiscard]] std::string cloudFigureSvg(std::span<const glm::dvec3> rest, std::span<const glm::dvec3> now,
                                         std::span<const double> values, const CloudFigure& figure,
                                         FigureRenderer& renderer);

/// One of several views of a cloud, side by side.
struct CloudPanel {
    std::span<const double> values;  ///< one for each point [colours.unit]
    ViewColours             colours; ///< what they mean
    std::string             title;
    std::string             note; ///< a second, smaller line; may be empty
};

/// Draws an object at rest once for each panel, seen alike, with title, colour bar and a bar of length in each.
/// \throws Error if the object has no surface, compute::ProcessorError if no processor can draw
[[nodiscard]] Image cloudPanels(const SoftObject& object, std::span<const CloudPanel> panels, FigureRenderer& renderer);

/// The view of a figure of pressed patches.
struct SurfaceView {
    std::string title;
    double      exaggeration = 1;   ///< factor on every displacement [1]
    glm::dvec3  direction{0, 0, 0}; ///< in which the eye looks; zero: obliquely onto the first contact
    bool        closeUp = false;    ///< only the first contact's neighbourhood
};

/// Draws the object, dented by each of the patches at once (they are solved one by one: where they overlap,
/// displacements add), coloured by deflection.
[[nodiscard]] std::string surfaceSvg(const PointCloud& cloud, std::span<const PressedPatch> patches,
                                     const SurfaceView& view, FigureRenderer& renderer);

/// Returns a round factor that makes the deepest displacement about a thirtieth of the object, at least 1.
[[nodiscard]] double roundExaggeration(double deepest, double size);

} // namespace palp
