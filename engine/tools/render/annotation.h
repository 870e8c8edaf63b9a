#pragma once
#include <cstdint>
#include <vector>

#include "engine/tools/plot/png.h"
#include "engine/tools/render/camera.h"
#include "engine/tools/render/view_scene.h"

namespace palp {

/// Writes the meaning of a scene's colours and shapes onto its picture: title, colour bar with unit, a key of the
/// shapes and a bar of a round length. Sizes follow the picture's smaller side; what it is too small for is omitted.
/// \param scale  of a display with many pixels per inch [1]
void annotate(Image& image, const ViewScene& scene, const Camera& camera, double scale = 1);

/// Returns the size of the annotations' font in a picture of that width and height [px].
[[nodiscard]] double annotationSize(int width, int height, double scale = 1);

/// Annotations by themselves, to be laid over many pictures.
struct Overlay {
    int                        width = 0, height = 0; ///< [px]
    std::vector<std::uint32_t> pixels; ///< rows from the top; red in the lowest byte, premultiplied by alpha
    std::vector<std::uint32_t> tiles;  ///< squares of shared::kTile that are not empty: column, row << 16
};

[[nodiscard]] Overlay annotations(const ViewScene& scene, const Camera& camera, int width, int height,
                                  double scale = 1);

} // namespace palp
