#include "engine/picture/cloud_shading.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace palp {
namespace {

constexpr Rgb8 kClay = {196, 178, 160}; // of a surface without values

// Running mean over 2 radius + 1 entries of a line, outside counts as zero.
void boxMean(const float* from, float* to, int count, std::ptrdiff_t stride, int radius)
{
    double       sum   = 0;
    const double share = 1.0 / (2 * radius + 1);
    for (int n = -radius; n < count; ++n) {
        if (n + radius < count) sum += double(from[(n + radius) * stride]);
        if (n - radius - 1 >= 0) sum -= double(from[(n - radius - 1) * stride]);
        if (n >= 0) to[n * stride] = float(share * sum);
    }
}

// Three box means along each direction come close to a Gaussian, at a cost that does not depend on its width.
void blur(std::vector<float>& field, int width, int height, int radius)
{
    std::vector<float> other(field.size());
    for (int pass = 0; pass < 3; ++pass) {
        for (int y = 0; y < height; ++y)
            boxMean(&field[std::size_t(y) * std::size_t(width)], &other[std::size_t(y) * std::size_t(width)], width, 1,
                    radius);
        for (int x = 0; x < width; ++x) boxMean(&other[std::size_t(x)], &field[std::size_t(x)], height, width, radius);
    }
}

// How far the surface lies behind the mean of its surroundings, per width of the surroundings: hollows are positive.
// [1]
std::vector<float> hollowness(const CloudSurface& surface)
{
    constexpr double kSurroundings =
        0.012; // radius of the box mean per side of the picture: a dent of some hundredths [1]
    const int radius =
        std::max({3, int(std::lround(kSurroundings * std::max(surface.width, surface.height))), int(surface.spacing)});
    std::vector<float> depth(surface.samples.size()), weight(surface.samples.size());
    for (std::size_t n = 0; n < depth.size(); ++n) {
        weight[n] = surface.samples[n].coverage;
        depth[n]  = weight[n] * surface.samples[n].depth;
    }
    blur(depth, surface.width, surface.height, radius);
    blur(weight, surface.width, surface.height, radius);
    for (std::size_t n = 0; n < depth.size(); ++n)
        depth[n] =
            surface.samples[n].coverage > 0 ? (surface.samples[n].depth - depth[n] / weight[n]) / float(radius) : 0;
    return depth;
}

std::uint8_t mixed(std::uint8_t colour, float brightness, float coverage)
{
    return std::uint8_t(
        std::lround(std::clamp(coverage * brightness * float(colour) + (1 - coverage) * 255, 0.0F, 255.0F)));
}

} // namespace

std::vector<float> cloudShading(const CloudSurface& surface)
{
    const glm::vec3 light =
        glm::normalize(glm::vec3(-0.50F, 0.60F, 0.72F));                  // from the upper left, as in printed relief
    constexpr float kAmbient = 0.42F, kDiffuse = 0.63F;                   // of the light [1]
    constexpr float kHollow = 1.1F, kDarkest = -0.45F, kLightest = 0.12F; // gain and bounds of the depth cue [1]

    std::vector<float> brightness = hollowness(surface);
    for (std::size_t n = 0; n < brightness.size(); ++n) {
        const glm::vec3& normal = surface.samples[n].normal;
        // Facing ratio squared: at grazing slopes the depth differs for other reasons than a hollow.
        const float cue = std::clamp(-kHollow * normal.z * normal.z * brightness[n], kDarkest, kLightest);
        brightness[n]   = (kAmbient + kDiffuse * std::max(0.0F, glm::dot(normal, light))) * (1 + cue);
    }
    return brightness;
}

Image cloudImage(const CloudSurface& surface, std::optional<ColourMap> map)
{
    const std::vector<float> brightness = cloudShading(surface);
    Image                    image(surface.width, surface.height);
    for (std::size_t n = 0; n < surface.samples.size(); ++n) {
        const CloudSurface::Sample& sample = surface.samples[n];
        if (sample.coverage <= 0) continue;
        Rgb8 colour = map ? kUndefinedColour : kClay;
        if (map && sample.defined) colour = colourAt(*map, double(sample.value));
        image.pixels[n] = {mixed(colour.red, brightness[n], sample.coverage),
                           mixed(colour.green, brightness[n], sample.coverage),
                           mixed(colour.blue, brightness[n], sample.coverage)};
    }
    return image;
}

} // namespace palp
