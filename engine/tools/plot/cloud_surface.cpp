#include "engine/tools/plot/cloud_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/tools/plot/splat_spacing.h"

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
    float w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0, wyy = 0; // of the offset from the pixel
    float wd = 0, wxd = 0, wyd = 0;                         // with the depth behind the front
    float wWidth   = 0;                                     // with the width [px]
    float wDefined = 0, wv = 0;                             // of points that have a value
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

// What lies nearest at every pixel when each point covers a disc.
struct Cover {
    float depth = kNothing; // [px]
    float width = 0;        // of the splat of the point that covers [px]
};

class Front {
public:
    Front(std::span<const glm::dvec3> positions, const CloudCamera& camera, const SplatSpacing& spacing)
        : camera_(camera), covers_(std::size_t(camera.width) * std::size_t(camera.height))
    {
        for (std::size_t k = 0; k < positions.size(); ++k)
            if (const auto p = camera.project(positions[k]); p && !spacing.skips(k, *p)) {
                const Cover cover = {float(p->depth), float(spacing.width(*p))};
                forDisc(p->x, p->y, std::max(kLeastReach, kFrontReach * double(cover.width)), camera,
                        [&](std::size_t n, float, float) {
                            if (cover.depth < covers_[n].depth) covers_[n] = cover;
                        });
            }
        fillHoles();
    }

    // Depth of the surface per pixel, pulled back from every edge, so that what is behind appears, or nothing.
    [[nodiscard]] std::vector<float> closed() const
    {
        std::vector<float> front;
        for (const Cover& cover : covers_) front.push_back(cover.depth);
        for (int y = 0; y < camera_.height; ++y)
            for (int x = 0; x < camera_.width; ++x) {
                const float here = covers_[at(x, y)].depth;
                double      back = 0; // [px]
                for (auto [dx, dy] : kCross)
                    if (const Cover* beside = find(x + dx, y + dy); beside && across(*beside, here))
                        back = std::max(back, kPullBack * double(beside->width));
                if (back > 0)
                    forDisc(x + 0.5, y + 0.5, back, camera_, [&](std::size_t n, float, float) {
                        if (across(covers_[n], here)) front[n] = std::max(front[n], here);
                    });
            }
        return front;
    }

private:
    static constexpr std::pair<int, int> kCross[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    static constexpr std::pair<int, int> kStar[]  = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                                     {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};

    [[nodiscard]] std::size_t at(int x, int y) const
    {
        return std::size_t(y) * std::size_t(camera_.width) + std::size_t(x);
    }

    [[nodiscard]] const Cover* find(int x, int y) const
    {
        return x >= 0 && y >= 0 && x < camera_.width && y < camera_.height ? &covers_[at(x, y)] : nullptr;
    }

    // Whether a place is so much nearer than `deeper` that an edge lies between.
    [[nodiscard]] static bool across(const Cover& place, float deeper)
    {
        return place.depth < deeper - float(kJump) * place.width;
    }

    // A pixel that sees the same nearer surface in all but one of eight directions, a splat's reach away, is a gap
    // between points; a slit or a bay is open in two. Filled from the border inwards.
    void fillHoles()
    {
        std::vector<std::pair<int, int>> waiting;
        for (int y = 0; y < camera_.height; ++y)
            for (int x = 0; x < camera_.width; ++x) waiting.emplace_back(x, y);
        while (!waiting.empty()) {
            const auto [x, y] = waiting.back();
            waiting.pop_back();
            const std::optional<Cover> lid = lidOver(x, y);
            if (!lid) continue;
            covers_[at(x, y)] = *lid;
            for (auto [dx, dy] : kCross)
                if (find(x + dx, y + dy) != nullptr) waiting.emplace_back(x + dx, y + dy);
        }
    }

    // The deepest of the nearer places around a pixel, if there are enough of them.
    [[nodiscard]] std::optional<Cover> lidOver(int x, int y) const
    {
        const float here = covers_[at(x, y)].depth;
        Cover       side;
        for (auto [dx, dy] : kCross)
            if (const Cover* beside = find(x + dx, y + dy); beside && across(*beside, here)) side = *beside;
        if (side.depth == kNothing) return std::nullopt;
        const int reach = std::max(1, int(kFrontReach * double(side.width)));
        Cover     lid{-kNothing, 0};
        int       seen = 0;
        for (auto [dx, dy] : kStar)
            for (int step = 1; step <= reach; ++step)
                if (const Cover* place = find(x + step * dx, y + step * dy); place && across(*place, here)) {
                    ++seen;
                    if (place->depth > lid.depth) lid = *place;
                    break;
                }
        return seen >= 7 ? std::optional(lid) : std::nullopt;
    }

    const CloudCamera& camera_;
    std::vector<Cover> covers_; // row by row
};

std::vector<Moments> accumulate(std::span<const glm::dvec3> positions, std::span<const double> values,
                                const CloudCamera& camera, const SplatSpacing& spacing, const std::vector<float>& front)
{
    std::vector<Moments> moments(front.size());
    for (std::size_t k = 0; k < positions.size(); ++k) {
        const auto p = camera.project(positions[k]);
        if (!p || spacing.skips(k, *p)) continue;
        const bool   defined = !values.empty() && std::isfinite(values[k]);
        const float  value   = defined ? float(values[k]) : 0;
        const double width   = spacing.width(*p);
        const float  scale   = float(1 / width);
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
    sample.normal              = glm::normalize(glm::vec3(plane.y, -plane.z, 1));
    sample.defined             = m.wDefined > 0.5F * m.w;
    if (sample.defined) sample.value = m.wv / m.wDefined;
    return sample;
}

// Calls visit(sample) for the pixel itself and its eight neighbours on the picture.
template <class Visit>
void forSquare(const std::vector<CloudSurface::Sample>& samples, int width, int height, int x, int y, Visit visit)
{
    for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u)
            visit(samples[std::size_t(v) * std::size_t(width) + std::size_t(u)]);
}

// At a silhouette the near and the far side meet and a plane fits neither: depth and normal of the outermost pixels
// come from further inside. Their coverage is the share of surface around them, so that the outline is not jagged.
void finishOutline(CloudSurface& surface)
{
    constexpr int kRim   = 3; // how far inside both sides mix [px]
    const auto    forAll = [&](auto visit) {
        for (int y = 0; y < surface.height; ++y)
            for (int x = 0; x < surface.width; ++x) {
                CloudSurface::Sample& sample =
                    surface.samples[std::size_t(y) * std::size_t(surface.width) + std::size_t(x)];
                if (sample.coverage > 0) visit(sample, x, y);
            }
    };
    std::vector<CloudSurface::Sample> inside = surface.samples;
    for (int step = 0; step < kRim; ++step) { // strips one pixel after the other ...
        const auto before = inside;
        forAll([&](CloudSurface::Sample&, int x, int y) {
            float least = 1;
            forSquare(before, surface.width, surface.height, x, y,
                      [&](const auto& s) { least = std::min(least, s.coverage); });
            if (least <= 0) inside[std::size_t(y) * std::size_t(surface.width) + std::size_t(x)].coverage = 0;
        });
    }
    for (int step = 0; step < kRim; ++step) { // ... and grows them back
        const auto before = inside;
        forAll([&](const CloudSurface::Sample&, int x, int y) {
            auto& sample = inside[std::size_t(y) * std::size_t(surface.width) + std::size_t(x)];
            if (sample.coverage > 0) return;
            glm::vec3 normal(0);
            float     depth = 0, count = 0;
            forSquare(before, surface.width, surface.height, x, y, [&](const auto& s) {
                if (s.coverage > 0) normal += s.normal, depth += s.depth, ++count;
            });
            if (count == 0) return;
            sample.coverage = 1;
            sample.depth    = depth / count;
            sample.normal   = glm::normalize(normal);
        });
    }
    const auto sharp = surface.samples;
    forAll([&](CloudSurface::Sample& sample, int x, int y) {
        float sum = 0, count = 0;
        forSquare(sharp, surface.width, surface.height, x, y, [&](const auto& s) { sum += s.coverage, ++count; });
        const auto& steady = inside[std::size_t(y) * std::size_t(surface.width) + std::size_t(x)];
        if (steady.coverage > 0) sample = steady; // else it is too thin to have an inside
        sample.coverage = sum / count;
    });
}

} // namespace

std::optional<Pixel> CloudCamera::project(const glm::dvec3& point) const
{
    constexpr double kFar = 1e6; // beyond it nothing is drawn, and a pixel would not fit an int [px]
    const glm::dvec3 from = point - centre;
    Pixel            p;
    p.x             = 0.5 * width + pixelsPerMetre * glm::dot(from, right);
    p.y             = 0.5 * height - pixelsPerMetre * glm::dot(from, up);
    p.depth         = -pixelsPerMetre * glm::dot(from, toEye);
    const bool near = std::abs(p.x) < kFar && std::abs(p.y) < kFar && std::abs(p.depth) < kFar; // false for NaN
    return near ? std::optional(p) : std::nullopt;
}

CloudSurface cloudSurface(std::span<const glm::dvec3> positions, std::span<const double> values,
                          const CloudCamera& camera)
{
    // Edges near the border of the picture are found beyond it.
    const int   margin = int(std::ceil(kFrontReach * SplatSpacing(positions, camera).widest()));
    CloudCamera wide   = camera;
    wide.width += 2 * margin;
    wide.height += 2 * margin;
    const SplatSpacing         spacing(positions, wide);
    const std::vector<float>   front   = Front(positions, wide, spacing).closed();
    const std::vector<Moments> moments = accumulate(positions, values, wide, spacing, front);

    CloudSurface surface{camera.width, camera.height, spacing.typical(), {}};
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const std::size_t n = std::size_t(y + margin) * std::size_t(wide.width) + std::size_t(x + margin);
            surface.samples.push_back(front[n] < kNothing && moments[n].w > 0 ? sampleOf(moments[n], front[n])
                                                                              : CloudSurface::Sample());
        }
    finishOutline(surface);
    return surface;
}

} // namespace palp
