#include "engine/tools/plot/cloud_shading.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace palp {
namespace {

constexpr Rgb8 kClay = {196, 178, 160}; // of a surface without values

// Running mean over 2 radius + 1 entries; outside counts as zero. Works on `lanes` neighbouring lines at once, so that
// memory is read in order along both directions of a picture.
void boxMean(const float* from, float* to, int count, std::size_t stride, std::size_t lanes, int radius)
{
    std::vector<double> sums(lanes, 0.0);
    const double        share = 1.0 / (2 * radius + 1);
    for (int n = -radius; n < count; ++n) {
        const int entering = n + radius, leaving = n - radius - 1;
        if (entering < count)
            for (std::size_t k = 0; k < lanes; ++k) sums[k] += double(from[std::size_t(entering) * stride + k]);
        if (leaving >= 0)
            for (std::size_t k = 0; k < lanes; ++k) sums[k] -= double(from[std::size_t(leaving) * stride + k]);
        if (n >= 0)
            for (std::size_t k = 0; k < lanes; ++k) to[std::size_t(n) * stride + k] = float(share * sums[k]);
    }
}

// Three box means along each direction come close to a Gaussian, at a cost that does not depend on its width.
void blur(std::vector<float>& field, int width, int height, int radius)
{
    std::vector<float> other(field.size());
    const std::size_t  row = std::size_t(width);
    for (int pass = 0; pass < 3; ++pass) {
        for (std::size_t y = 0; y < std::size_t(height); ++y)
            boxMean(&field[y * row], &other[y * row], width, 1, 1, radius);
        boxMean(other.data(), field.data(), height, row, row, radius);
    }
}

// How far the surface lies behind the mean of its surroundings, per radius of the surroundings: hollows are positive.
// [1]
std::vector<float> hollowness(const CloudSurface& surface, int radius)
{
    constexpr float kSteepest = 0.2F; // facing ratio below which a slope is noise [1]
    // Mean of depth and of place; the place, because at a border the surroundings lie to one side, and a slope is no
    // hollow.
    std::vector<float> weight(surface.samples.size()), depth(weight), x(weight), y(weight);
    for (std::size_t n = 0; n < weight.size(); ++n) {
        weight[n] = surface.samples[n].coverage;
        depth[n]  = weight[n] * surface.samples[n].depth;
        x[n]      = weight[n] * float(n % std::size_t(surface.width));
        y[n]      = weight[n] * float(n / std::size_t(surface.width));
    }
    for (std::vector<float>* field : {&weight, &depth, &x, &y}) blur(*field, surface.width, surface.height, radius);
    for (std::size_t n = 0; n < depth.size(); ++n) {
        const CloudSurface::Sample& sample = surface.samples[n];
        if (sample.coverage <= 0) {
            depth[n] = 0;
            continue;
        }
        const float aside = x[n] / weight[n] - float(n % std::size_t(surface.width));
        const float below = y[n] / weight[n] - float(n / std::size_t(surface.width));
        const float slope = (sample.normal.x * aside - sample.normal.y * below) / std::max(kSteepest, sample.normal.z);
        depth[n]          = (sample.depth + slope - depth[n] / weight[n]) / float(radius);
    }
    return depth;
}

std::uint8_t mixed(std::uint8_t colour, float brightness, float coverage)
{
    return std::uint8_t(
        std::lround(std::clamp(coverage * brightness * float(colour) + (1 - coverage) * 255, 0.0F, 255.0F)));
}

} // namespace

Rgb8 surfaceColour(double position, ColourMap map)
{
    constexpr double kWhite = 0.35; // share of white: the dark end of the map would swallow the shading [1]
    const Rgb8       colour = colourAt(position, map);
    const auto lightened    = [](std::uint8_t c) { return std::uint8_t(std::lround((1 - kWhite) * c + kWhite * 255)); };
    return {lightened(colour.red), lightened(colour.green), lightened(colour.blue)};
}

std::vector<float> cloudShading(const CloudSurface& surface)
{
    const glm::vec3 light =
        glm::normalize(glm::vec3(-0.55F, 0.60F, 0.62F)); // from the upper left, as in printed relief
    constexpr float kAmbient = 0.50F, kDiffuse = 0.58F;  // of the light [1]
    constexpr float kWrap   = 0.3F; // how far light reaches around the object, so that its far side is not flat [1]
    constexpr float kHollow = 1.3F, kDarkest = -0.32F, kLightest = 0.15F; // gain and bounds of the depth cue [1]
    constexpr float kScales[] = {0.012F,
                                 0.045F}; // radii of the surroundings per side of the picture: small dents, large [1]

    std::vector<float> hollow(surface.samples.size());
    for (float scale : kScales) {
        const int radius =
            std::max({3, int(scale * float(std::max(surface.width, surface.height))), int(surface.spacing)});
        const auto part = hollowness(surface, radius);
        for (std::size_t n = 0; n < hollow.size(); ++n) hollow[n] += part[n];
    }
    std::vector<float> brightness(surface.samples.size());
    for (std::size_t n = 0; n < brightness.size(); ++n) {
        const glm::vec3& normal = surface.samples[n].normal;
        // Facing ratio squared: at grazing slopes the depth differs for other reasons than a hollow.
        const float cue = std::clamp(-kHollow * normal.z * normal.z * hollow[n], kDarkest, kLightest);
        const float lit = std::max(0.0F, (glm::dot(normal, light) + kWrap) / (1 + kWrap));
        brightness[n]   = (kAmbient + kDiffuse * lit * lit) * (1 + cue);
    }
    return brightness;
}

Image cloudImage(const CloudSurface& surface, Paint paint)
{
    const std::vector<float> brightness = cloudShading(surface);
    Image                    image(surface.width, surface.height);
    for (std::size_t n = 0; n < surface.samples.size(); ++n) {
        const CloudSurface::Sample& sample = surface.samples[n];
        if (sample.coverage <= 0) continue;
        const Rgb8 colour = paint == Paint::clay ? kClay
                            : sample.defined     ? surfaceColour(double(sample.value))
                                                 : kUndefinedColour;
        image.pixels[n]   = {mixed(colour.red, brightness[n], sample.coverage),
                             mixed(colour.green, brightness[n], sample.coverage),
                             mixed(colour.blue, brightness[n], sample.coverage)};
    }
    return image;
}

} // namespace palp
