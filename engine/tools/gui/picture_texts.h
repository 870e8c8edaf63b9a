#pragma once
#include <chrono>
#include <string>

#include "engine/tools/render/annotation.h"
#include "engine/tools/render/touch_view.h"

namespace palp {

/// Everything that the texts over a picture depend on.
struct TextContent {
    std::string title, note, quantity;
    ColourMap   map    = ColourMap::viridis;
    Ground      ground = Ground::light;
    double      low = 0, high = 0; ///< ends of the colours [unit of the quantity]
    double      halfHeight = 0;    ///< of what the camera shows [m]
    glm::ivec2  size{};            ///< of the picture [px]
    double      scale = 1;         ///< of the display [1]
    bool        proxy = false, stylus = false, force = false, outline = false, sphere = false; ///< are in the picture
    bool        goesOn = false; ///< values lie above the colours
    bool        brush = false, ghost = false, projected = false, bulging = false, hollow = false; ///< the same

    bool operator==(const TextContent&) const = default;
};

/// Keeps the texts over the window's pictures, because writing them takes longer than a frame may.
/// Invariant: a picture of another size never gets these texts.
/// \thread the window's
class PictureTexts {
public:
    /// Writes the texts anew if they have changed, but not with every frame.
    void update(const ViewScene& scene, const Overlays& overlays, const Camera& camera, const glm::ivec2& size,
                double scale);
    /// Returns null if there are no texts for a picture of this size.
    [[nodiscard]] const Overlay* of(const glm::ivec2& size) const;

private:
    Overlay                               texts_;
    TextContent                           content_;
    std::chrono::steady_clock::time_point written_{};
};

} // namespace palp
