#include "engine/picture/cloud_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace palp {
namespace {

using Pixel = CloudCamera::Pixel;

constexpr float  kNothing         = std::numeric_limits<float>::infinity();
constexpr double kWidthPerSpacing = 1.1; // standard deviation of a splat: randomly spread points close with it [1]
constexpr double kReach           = 2.3; // of a splat, in standard deviations; the rest weighs under 7 % [1]
constexpr double kFrontReach      = 1.3; // of the disc that decides what is in front, likewise [1]
constexpr double kLayer           = 6;   // depth of one layer, likewise; holds slopes to 70 degrees [1]
constexpr double kOneSided = 0.8;    // offset of the splats' mean beyond which a pixel is past their edge: what a half
                                     // plane of points has at its border, sqrt(2 / pi) standard deviations [1]
constexpr int    kLayers        = 2; // a pixel past the edge of the front layer may show the one behind [1]
constexpr double kSmallestWidth = 0.6; // of a splat [px]
constexpr double kMostWork      = 150; // splatted pixels per pixel of the picture, bounds the time [1]

// How far apart points lie on the screen, on a coarse grid of cells.
class SpacingMap {
public:
    SpacingMap(std::span<const glm::dvec3> positions, const CloudCamera& camera);

    [[nodiscard]] double typical() const { return typical_; } // [px]
    // Standard deviation of a splat around a place. [px]
    [[nodiscard]] double width(double x, double y) const { return shrink_ * widths_[cell(x, y)]; }

private:
    void count(std::span<const glm::dvec3> positions, const CloudCamera& camera);
    void measure();
    void boundWork(std::span<const glm::dvec3> positions, const CloudCamera& camera);

    [[nodiscard]] std::size_t cell(double x, double y) const
    {
        const int column = std::clamp(int(x / side_), 0, columns_ - 1), row = std::clamp(int(y / side_), 0, rows_ - 1);
        return std::size_t(row) * std::size_t(columns_) + std::size_t(column);
    }

    int                 side_ = 0, columns_ = 0, rows_ = 0; // of a cell [px], of the grid [1]
    std::vector<float>  front_;                             // nearest depth per cell [px]
    std::vector<double> counts_;                            // points of the front layer per cell [1]
    std::vector<double> widths_;                            // [px]
    double              typical_ = 1, shrink_ = 1;
};

bool onPicture(const Pixel& p, const CloudCamera& camera)
{
    return p.x >= 0 && p.y >= 0 && p.x < camera.width && p.y < camera.height;
}

SpacingMap::SpacingMap(std::span<const glm::dvec3> positions, const CloudCamera& camera)
{
    constexpr int    kFirstSide = 4; // [px]
    constexpr double kEnough    = 6; // points in a cell that give a spacing [1]
    const int        largest    = std::max(camera.width, camera.height);
    for (side_ = kFirstSide;; side_ *= 2) {
        count(positions, camera);
        const double total = std::accumulate(counts_.begin(), counts_.end(), 0.0);
        const auto   empty = std::count(counts_.begin(), counts_.end(), 0.0);
        if (total >= kEnough * double(std::ptrdiff_t(counts_.size()) - empty) || side_ >= largest) break;
    }
    measure();
    boundWork(positions, camera);
}

void SpacingMap::count(std::span<const glm::dvec3> positions, const CloudCamera& camera)
{
    constexpr float kThickness = 3; // depth of the front layer per side of a cell [1]
    columns_                   = (camera.width + side_ - 1) / side_;
    rows_                      = (camera.height + side_ - 1) / side_;
    front_.assign(std::size_t(columns_) * std::size_t(rows_), kNothing);
    counts_.assign(front_.size(), 0);
    for (const glm::dvec3& position : positions)
        if (const auto p = camera.project(position); p && onPicture(*p, camera)) {
            float& front = front_[cell(p->x, p->y)];
            front        = std::min(front, float(p->depth));
        }
    for (const glm::dvec3& position : positions)
        if (const auto p = camera.project(position); p && onPicture(*p, camera)) {
            const std::size_t c = cell(p->x, p->y);
            counts_[c] += float(p->depth) <= front_[c] + kThickness * float(side_);
        }
}

void SpacingMap::measure()
{
    // Mean over the neighbourhood weighted by the counts themselves, so that cells cut by a silhouette hardly matter.
    widths_.assign(counts_.size(), 0);
    std::vector<double> spacings;
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column) {
            double sum = 0, sumOfSquares = 0;
            for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r)
                for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c) {
                    const double n = counts_[std::size_t(r) * std::size_t(columns_) + std::size_t(c)];
                    sum += n;
                    sumOfSquares += n * n;
                }
            const std::size_t here = std::size_t(row) * std::size_t(columns_) + std::size_t(column);
            if (sum > 0) widths_[here] = side_ / std::sqrt(sumOfSquares / sum);
            if (counts_[here] > 0) spacings.push_back(widths_[here]);
        }
    if (!spacings.empty()) {
        const auto middle = spacings.begin() + std::ptrdiff_t(spacings.size() / 2);
        std::nth_element(spacings.begin(), middle, spacings.end());
        typical_ = *middle;
    }
    constexpr double kNarrowest = 0.6, kWidest = 3; // relative to the typical spacing [1]
    for (double& width : widths_) {
        const double spacing = width > 0 ? std::clamp(width, kNarrowest * typical_, kWidest * typical_) : typical_;
        width                = std::max(kSmallestWidth, kWidthPerSpacing * spacing);
    }
}

void SpacingMap::boundWork(std::span<const glm::dvec3> positions, const CloudCamera& camera)
{
    double work = 0; // [px]
    for (const glm::dvec3& position : positions)
        if (const auto p = camera.project(position); p && onPicture(*p, camera)) {
            const double reach = 2 * kReach * width(p->x, p->y);
            work += reach * reach;
        }
    const double most = kMostWork * double(camera.width) * double(camera.height);
    if (work > most) shrink_ = std::sqrt(most / work);
}

// Weighted sums over the splats that reach a pixel; offsets in standard deviations of the splat.
struct Moments {
    float     w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0, wyy = 0; // of the offset
    float     wd = 0, wxd = 0, wyd = 0;                         // with the depth behind the front
    float     wWidth   = 0;                                     // with the splat's standard deviation [px]
    float     wDefined = 0, wv = 0;                             // of points that have a value
    glm::vec3 wn{0};                                            // with the supplied normal
};

struct Layer {
    std::vector<float>   floor; // only what lies deeper is drawn; infinity closes a pixel [px]
    std::vector<float>   front; // [px]
    std::vector<Moments> moments;
};

// Calls visit(index of pixel, offset x, offset y) for the pixels of a disc; the offset leads from the pixel's centre to
// the point.
template <class Visit>
void forDisc(const Pixel& p, double radius, const CloudCamera& camera, Visit visit)
{
    const int top    = std::max(0, int(std::floor(p.y - radius))),
              bottom = std::min(camera.height - 1, int(std::ceil(p.y + radius)));
    const int left   = std::max(0, int(std::floor(p.x - radius))),
              right  = std::min(camera.width - 1, int(std::ceil(p.x + radius)));
    for (int y = top; y <= bottom; ++y) {
        const float offsetY = float(p.y - (y + 0.5));
        for (int x = left; x <= right; ++x) {
            const float offsetX = float(p.x - (x + 0.5));
            if (offsetX * offsetX + offsetY * offsetY <= float(radius * radius))
                visit(std::size_t(y) * std::size_t(camera.width) + std::size_t(x), offsetX, offsetY);
        }
    }
}

// A splat around a point, if it can reach the picture.
std::optional<Pixel> splatAt(const glm::dvec3& position, const CloudCamera& camera, const SpacingMap& spacing,
                             double& width)
{
    const auto p = camera.project(position);
    if (!p) return std::nullopt;
    width = spacing.width(std::clamp(p->x, 0.0, double(camera.width)), std::clamp(p->y, 0.0, double(camera.height)));
    const double reach = kReach * width;
    if (p->x < -reach || p->y < -reach || p->x > camera.width + reach || p->y > camera.height + reach)
        return std::nullopt;
    return p;
}

void findFront(std::span<const glm::dvec3> positions, const CloudCamera& camera, const SpacingMap& spacing,
               Layer& layer)
{
    double width = 0;
    for (const glm::dvec3& position : positions)
        if (const auto p = splatAt(position, camera, spacing, width)) {
            const float depth = float(p->depth);
            forDisc(*p, std::max(0.75, kFrontReach * width), camera, [&](std::size_t pixel, float, float) {
                if (depth > layer.floor[pixel]) layer.front[pixel] = std::min(layer.front[pixel], depth);
            });
        }
}

void accumulate(std::span<const glm::dvec3> positions, std::span<const double> values,
                std::span<const glm::dvec3> normals, const CloudCamera& camera, const SpacingMap& spacing, Layer& layer)
{
    double width = 0;
    for (std::size_t n = 0; n < positions.size(); ++n) {
        const auto p = splatAt(positions[n], camera, spacing, width);
        if (!p) continue;
        const bool  defined = !values.empty() && std::isfinite(values[n]);
        const float value   = defined ? float(values[n]) : 0;
        glm::vec3   normal{0};
        if (!normals.empty()) {
            normal = {glm::dot(normals[n], camera.right), glm::dot(normals[n], camera.up),
                      glm::dot(normals[n], camera.toEye)};
            if (const float length = glm::length(normal); length > 0 && std::isfinite(length))
                normal *= (normal.z < 0 ? -1 : 1) / length;
            else
                normal = glm::vec3(0);
        }
        const float scale = float(1 / width);
        forDisc(*p, std::max(0.75, kReach * width), camera, [&](std::size_t pixel, float offsetX, float offsetY) {
            const float behind = float(p->depth) - layer.front[pixel];
            if (!(behind >= 0 && behind <= float(kLayer * width))) return;
            Moments&    m = layer.moments[pixel];
            const float x = scale * offsetX, y = scale * offsetY, d = scale * behind;
            const float w = std::exp(-0.5F * (x * x + y * y));
            m.w += w, m.wx += w * x, m.wy += w * y;
            m.wxx += w * x * x, m.wxy += w * x * y, m.wyy += w * y * y;
            m.wd += w * d, m.wxd += w * x * d, m.wyd += w * y * d;
            m.wWidth += w * float(width);
            if (defined) m.wDefined += w, m.wv += w * value;
            m.wn += w * normal;
        });
    }
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

CloudSurface::Sample sampleOf(const Moments& m, float front, bool normalsGiven)
{
    CloudSurface::Sample sample;
    const float          width  = m.wWidth / m.w;
    const float          offset = std::hypot(m.wx, m.wy) / m.w;
    // The edge is soft over about one pixel; the offset grows by about 0.6 per standard deviation there.
    const float soft      = 0.6F / width;
    sample.coverage       = std::clamp(0.5F + (float(kOneSided) - offset) / soft, 0.0F, 1.0F);
    const glm::vec3 plane = fittedPlane(m);
    sample.depth          = front + width * plane.x;
    sample.normal =
        normalsGiven && glm::length(m.wn) > 0 ? glm::normalize(m.wn) : glm::normalize(glm::vec3(plane.y, -plane.z, 1));
    sample.defined = m.wDefined > 0.5F * m.w;
    if (sample.defined) sample.value = m.wv / m.wDefined;
    return sample;
}

} // namespace

std::optional<Pixel> CloudCamera::project(const glm::dvec3& point) const
{
    constexpr double kNearest = 0.05; // distance from the eye relative to that of the centre [1]
    constexpr double kFar     = 1e7;  // beyond it nothing is drawn, and a pixel would not fit an int [px]
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
    const std::size_t pixels = std::size_t(camera.width) * std::size_t(camera.height);
    const SpacingMap  spacing(positions, camera);
    CloudSurface surface{camera.width, camera.height, spacing.typical(), std::vector<CloudSurface::Sample>(pixels)};
    Layer        layer{std::vector<float>(pixels, -kNothing), {}, {}};
    for (int number = 0; number < kLayers; ++number) {
        layer.front.assign(pixels, kNothing);
        layer.moments.assign(pixels, {});
        findFront(positions, camera, spacing, layer);
        accumulate(positions, values, normals, camera, spacing, layer);
        for (std::size_t n = 0; n < pixels; ++n) {
            const Moments& m = layer.moments[n];
            if (m.w <= 0) {
                layer.floor[n] = kNothing;
                continue;
            }
            const CloudSurface::Sample sample = sampleOf(m, layer.front[n], !normals.empty());
            if (sample.coverage > surface.samples[n].coverage) surface.samples[n] = sample;
            layer.floor[n] = sample.coverage < 0.5F ? layer.front[n] + float(kLayer) * m.wWidth / m.w : kNothing;
        }
    }
    return surface;
}

} // namespace palp
