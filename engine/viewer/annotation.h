#pragma once
#include "engine/picture/png.h"
#include "engine/viewer/camera.h"
#include "engine/viewer/view_scene.h"

namespace palp {

/// Writes what a scene's colours and shapes mean onto its picture: title, colour bar with unit, a key of the shapes and
/// a bar of a round length. Sizes follow the picture's height; a picture too small for them gets none.
void annotate(Image& image, const ViewScene& scene, const Camera& camera);

} // namespace palp
