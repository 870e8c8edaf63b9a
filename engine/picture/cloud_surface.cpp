#include "engine/picture/cloud_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "engine/picture/splat_spacing.h"

namespace palp {
namespace {

using Pixel = CloudCamera::Pixel;

// Lengths are in widths of a splat. The front is closed as in morphology: every point covers a disc wide enough to
// leave no gaps, then everything is pulled back from the edges of what the discs cover by nearly as much.
constexpr float  kNothing    = std::numeric_limits<float>::infinity();
constexpr double kFrontReach = 1.8; // of a disc; a wider gap between points is a gap [1]
constexpr double kPullBack   = 1.5; // from an edge; the rest keeps lone points visible [1]
constexpr double kJump       = 3;   // of depth from pixel to pixel that makes an edge rather than a slope [1]
constexpr double kLayer = 8; // how far in depth from the front the points of a surface lie: slopes to 70 degrees [1]
constexpr double kLeastReach = 0.75; // of a disc, so that every point covers a pixel [px]

// Weighted sums over the splats that reach a pixel; offsets and depths in widths.
struct Moments {
    float     w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0, wyy = 0; // of the offset from the pixel
    float     wd = 0, wxd = 0, wyd = 0;                         // with the depth behind the front
    float     wWidth   = 0;                                     // with the width [px]
    float     wDefined = 0, wv = 0;                             // of points that have a value
    glm::vec3 wn{0};                                            // with the supplied normal
};

// Calls visit(index of pixel, offset x, offset y) for the pixels of a disc; the offset leads from the pixel's centre to
// the disc's.
template <class Visit>
void forDisc(double centreX, double centreY, double radius, const CloudCamera& camera, Visit visit)
{
    const int top    = std::max(0, int(std::floor(centreY - radius)));
    const int bottom = std::min(camera.height - 1, int(std::ceil(centreY + radius)));
    const int left   = std::max(0, int(std::floor(centreX - radius)));
    const int right  = std::min(camera.width - 1, int(std::ceil(centreX + radius)));
    for (int y = top; y <= bottom; ++y) {
        const float offsetY = float(centreY - (y + 0.5));
        for (int x = left; x <= right; ++x) {
            const float offsetX = float(centreX - (x + 0.5));
            if (offsetX * offsetX + offsetY * offsetY <= float(radius * radius))
                visit(std::size_t(y) * std::size_t(camera.width) + std::size_t(x), offsetX, offsetY);
        }
    }
}

double widthAt(const Pixel& p, const CloudCamera& camera, const SplatSpacing& spacing)
{
    return spacing.width(std::clamp(p.x, 0.0, double(camera.width)), std::clamp(p.y, 0.0, double(camera.height)));
}

std::vector<float> coveredFront(std::span<const glm::dvec3> positions, const CloudCamera& camera,
                                const SplatSpacing& spacing)
{
    std::vector<float> front(std::size_t(camera.width) * std::size_t(camera.height), kNothing);
    for (const glm::dvec3& position : positions)
        if (const auto p = camera.project(position)) {
            const double reach = std::max(kLeastReach, kFrontReach * widthAt(*p, camera, spacing));
            forDisc(p->x, p->y, reach, camera,
                    [&](std::size_t n, float, float) { front[n] = std::min(front[n], float(p->depth)); });
        }
    return front;
}

// Pulls what is in front back from every edge, so that what is behind appears, or nothing.
std::vector<float> closedFront(const std::vector<float>& covered, const CloudCamera& camera,
                               const SplatSpacing& spacing)
{
    std::vector<float> front = covered;
    const auto pixel = [&](int x, int y) { return std::size_t(y) * std::size_t(camera.width) + std::size_t(x); };
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const double width = spacing.width(x + 0.5, y + 0.5);
            const float  here  = covered[pixel(x, y)];
            const float  near  = here - float(kJump * width); // what is nearer than this is across an edge
            const bool   edge  = (x > 0 && covered[pixel(x - 1, y)] < near) ||
                              (y > 0 && covered[pixel(x, y - 1)] < near) ||
                              (x + 1 < camera.width && covered[pixel(x + 1, y)] < near) ||
                              (y + 1 < camera.height && covered[pixel(x, y + 1)] < near);
            if (!edge) continue;
            forDisc(x + 0.5, y + 0.5, kPullBack * width, camera, [&](std::size_t n, float, float) {
                if (covered[n] < near) front[n] = std::max(front[n], here);
            });
        }
    return front;
}

// The normal in axes of the camera, towards the eye; zero if there is none.
glm::vec3 seenNormal(const glm::dvec3& normal, const CloudCamera& camera)
{
    const glm::dvec3 seen(glm::dot(normal, camera.right), glm::dot(normal, camera.up), glm::dot(normal, camera.toEye));
    const double     length = glm::length(seen);
    if (!(length > 0) || !std::isfinite(length)) return glm::vec3(0);
    return glm::vec3(seen * ((seen.z < 0 ? -1 : 1) / length));
}

std::vector<Moments> accumulate(std::span<const glm::dvec3> positions, std::span<const double> values,
                                std::span<const glm::dvec3> normals, const CloudCamera& camera,
                                const SplatSpacing& spacing, const std::vector<float>& front)
{
    std::vector<Moments> moments(front.size());
    for (std::size_t k = 0; k < positions.size(); ++k) {
        const auto p = camera.project(positions[k]);
        if (!p) continue;
        const bool      defined = !values.empty() && std::isfinite(values[k]);
        const float     value   = defined ? float(values[k]) : 0;
        const glm::vec3 normal  = normals.empty() ? glm::vec3(0) : seenNormal(normals[k], camera);
        const double    width   = widthAt(*p, camera, spacing);
        const float     scale   = float(1 / width);
        forDisc(p->x, p->y, std::max(kLeastReach, kSplatReach * width), camera,
                [&](std::size_t n, float offsetX, float offsetY) {
                    // Both factors fall to zero at their ends: a jump would show as an edge.
                    const float d = scale * (float(p->depth) - front[n]), x = scale * offsetX, y = scale * offsetY;
                    const float near   = 1 - std::abs(d) / float(kLayer);
                    const float inside = 1 - (x * x + y * y) / float(kSplatReach * kSplatReach);
                    if (!(near > 0 && inside > 0)) return;
                    const float w = inside * inside * inside * near * near;
                    Moments&    m = moments[n];
                    m.w += w, m.wx += w * x, m.wy += w * y;
                    m.wxx += w * x * x, m.wxy += w * x * y, m.wyy += w * y * y;
                    m.wd += w * d, m.wxd += w * x * d, m.wyd += w * y * d;
                    m.wWidth += w * float(width);
                    if (defined) m.wDefined += w, m.wv += w * value;
                    m.wn += w * normal;
                });
    }
    return moments;
}

// Plane depth = a + bx x + by y of least weighted squares; a small ridge keeps it level where points are too few.
glm::vec3 fittedPlane(const Moments& m)
{
    constexpr double kRidge = 0.02; // of the weight [1]
    const double     mx = m.wx / m.w, my = m.wy / m.w, md = m.wd / m.w;
    const double xx = m.wxx / m.w - mx * mx + kRidge, xy = m.wxy / m.w - mx * my, yy = m.wyy / m.w - my * my + kRidge;
    const double xd = m.wxd / m.w - mx * md, yd = m.wyd / m.w - my * md;
    const double determinant = xx * yy - xy * xy;
    const double bx = (yy * xd - xy * yd) / determinant, by = (xx * yd - xy * xd) / determinant;
    return {float(md - bx * mx - by * my), float(bx), float(by)};
}

CloudSurface::Sample sampleOf(const Moments& m, float front)
{
    CloudSurface::Sample sample;
    const glm::vec3      plane = fittedPlane(m);
    sample.coverage            = 1;
    sample.depth               = front + m.wWidth / m.w * plane.x;
    sample.normal  = glm::length(m.wn) > 0 ? glm::normalize(m.wn) : glm::normalize(glm::vec3(plane.y, -plane.z, 1));
    sample.defined = m.wDefined > 0.5F * m.w;
    if (sample.defined) sample.value = m.wv / m.wDefined;
    return sample;
}

// Coverage of a pixel at a silhouette is the share of surface around it, so that the outline is not jagged.
void softenOutline(CloudSurface& surface)
{
    const std::vector<CloudSurface::Sample> sharp = surface.samples;
    for (int y = 0; y < surface.height; ++y)
        for (int x = 0; x < surface.width; ++x) {
            float sum = 0, count = 0;
            for (int v = std::max(0, y - 1); v <= std::min(surface.height - 1, y + 1); ++v)
                for (int u = std::max(0, x - 1); u <= std::min(surface.width - 1, x + 1); ++u) {
                    sum += sharp[std::size_t(v) * std::size_t(surface.width) + std::size_t(u)].coverage;
                    ++count;
                }
            float& here = surface.samples[std::size_t(y) * std::size_t(surface.width) + std::size_t(x)].coverage;
            here *= sum / count;
        }
}

} // namespace

std::optional<Pixel> CloudCamera::project(const glm::dvec3& point) const
{
    constexpr double kNearest = 0.05; // distance from the eye relative to that of the centre [1]
    constexpr double kFar     = 1e6;  // beyond it nothing is drawn, and a pixel would not fit an int [px]
    const glm::dvec3 from     = point - centre;
    const double     away     = -glm::dot(from, toEye);
    Pixel            p;
    if (eyeDistance > 0) {
        if (!(eyeDistance + away > kNearest * eyeDistance)) return std::nullopt;
        p.magnified = eyeDistance / (eyeDistance + away);
    }
    p.x             = 0.5 * width + pixelsPerMetre * p.magnified * glm::dot(from, right);
    p.y             = 0.5 * height - pixelsPerMetre * p.magnified * glm::dot(from, up);
    p.depth         = pixelsPerMetre * away;
    const bool near = std::abs(p.x) < kFar && std::abs(p.y) < kFar && std::abs(p.depth) < kFar; // false for NaN
    return near ? std::optional(p) : std::nullopt;
}

CloudSurface cloudSurface(std::span<const glm::dvec3> positions, std::span<const double> values,
                          std::span<const glm::dvec3> normals, const CloudCamera& camera)
{
    const SplatSpacing         spacing(positions, camera);
    const std::vector<float>   front   = closedFront(coveredFront(positions, camera, spacing), camera, spacing);
    const std::vector<Moments> moments = accumulate(positions, values, normals, camera, spacing, front);
    CloudSurface               surface{camera.width, camera.height, spacing.typical(),
                         std::vector<CloudSurface::Sample>(front.size())};
    for (std::size_t n = 0; n < front.size(); ++n)
        if (front[n] < kNothing && moments[n].w > 0) surface.samples[n] = sampleOf(moments[n], front[n]);
    softenOutline(surface);
    return surface;
}

} // namespace palp
