#include "engine/tools/gui/picture_texts.h"

namespace palp {
namespace {

TextContent contentOf(const ViewScene& scene, const Overlays& overlays, const Camera& camera, const glm::ivec2& size,
                      double scale)
{
    TextContent now{scene.title, scene.note, scene.colours.quantity, scene.colours.map, scene.ground};
    now.low        = scene.colours.range.low;
    now.high       = scene.colours.range.high;
    now.halfHeight = camera.halfHeight();
    now.size       = size;
    now.scale      = scale;
    now.goesOn     = scene.colours.goesOn;
    now.proxy      = scene.proxy.has_value();
    now.stylus     = scene.stylus.has_value();
    now.force      = scene.force.has_value();
    now.outline    = !scene.outline.empty();
    now.brush      = !scene.brush.empty();
    now.sphere     = !scene.sphere.empty();
    now.ghost      = overlays.ghost;
    now.projected  = overlays.projected;
    now.bulging    = !scene.bulging.empty();
    now.hollow     = !scene.hollow.empty();
    return now;
}

} // namespace

void PictureTexts::update(const ViewScene& scene, const Overlays& overlays, const Camera& camera,
                          const glm::ivec2& size, double scale)
{
    constexpr auto kSeldom = std::chrono::milliseconds(250);
    const auto     now     = std::chrono::steady_clock::now();
    TextContent    content = contentOf(scene, overlays, camera, size, scale);
    if (of(size) && (content == content_ || now - written_ < kSeldom)) return;
    texts_   = annotations(scene, camera, size.x, size.y, scale);
    content_ = std::move(content);
    written_ = now;
}

const Overlay* PictureTexts::of(const glm::ivec2& size) const
{
    return texts_.width == size.x && texts_.height == size.y ? &texts_ : nullptr;
}

} // namespace palp
