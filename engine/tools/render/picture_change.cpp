#include "engine/tools/render/picture_change.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include <glm/geometric.hpp>

namespace palp {
namespace {

using shared::ViewCorner;
using shared::ViewFrame;
using shared::ViewSplat;

// The layout has no gaps but named ones, which are always written.
template <class T>
bool same(const T& a, const T& b)
{
    return std::memcmp(&a, &b, sizeof a) == 0;
}

template <class T>
bool same(std::span<const T> a, std::span<const T> b)
{
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
}

/// A rectangle that grows over the drawn places.
class Part {
public:
    explicit Part(const ViewFrame& frame) : frame_(frame) {}

    /// \param radius [m]
    void add(const glm::vec3& place, float radius)
    {
        const glm::vec4 view = frame_.viewFromWorld * glm::vec4(place, 1), clip = frame_.clipFromView * view;
        const float     depth = frame_.orthographic == 1U ? 1.0F : -view.z; // [m], or nothing
        if (!(clip.w > 0) || !(depth > 0)) {                                // beside or behind the eye
            whole_ = true;
            return;
        }
        const float perMetre = 0.5F * frame_.width / (frame_.widthAtOne * depth);
        const float reach    = radius * perMetre + kMargin;
        const float x        = (0.5F + 0.5F * clip.x / clip.w) * frame_.width,
                    y        = (0.5F + 0.5F * clip.y / clip.w) * frame_.height;
        low_                 = glm::min(low_, glm::vec2(x, y) - reach);
        high_                = glm::max(high_, glm::vec2(x, y) + reach);
    }
    /// A point's square is at most so much wider than its disc, seen aslant from near by, see view_point.vert.
    void add(const ViewSplat& splat) { add(splat.position, 2 * std::abs(splat.radius)); }
    void add(const ViewCorner& corner) { add(corner.position, 0); }

    [[nodiscard]] std::optional<PixelRect> rect() const
    {
        if (whole_) return {};
        const auto pixel = [](float at, float most) { return int(std::clamp(at, 0.0F, most)); };
        if (!(low_.x < high_.x)) return PixelRect{};
        return PixelRect{pixel(std::floor(low_.x), frame_.width), pixel(std::floor(low_.y), frame_.height),
                         pixel(std::ceil(high_.x), frame_.width), pixel(std::ceil(high_.y), frame_.height)};
    }

private:
    /// Of points that are smaller than a pixel, twice 0.7, and of rounding [px].
    static constexpr float kMargin = 2.5F;
    const ViewFrame&       frame_;
    bool                   whole_ = false;
    glm::vec2              low_{1e9F}, high_{-1e9F}; // [px]
};

void addDiscs(Part& part, std::span<const ViewSplat> before, std::span<const ViewSplat> now)
{
    for (std::size_t n = 0; n < now.size(); ++n)
        if (!same(before[n], now[n])) {
            part.add(before[n]);
            part.add(now[n]);
        }
}

/// A face changes with any of its corners, and with the normals and colours there.
void addFaces(Part& part, std::span<const ViewSplat> before, std::span<const ViewSplat> now,
              std::span<const std::uint32_t> faces)
{
    std::vector<char> moved(now.size());
    for (std::size_t n = 0; n < now.size(); ++n) moved[n] = !same(before[n], now[n]);
    for (std::size_t n = 0; n + 2 < faces.size(); n += 3)
        if (moved[faces[n]] || moved[faces[n + 1]] || moved[faces[n + 2]])
            for (std::size_t k = n; k < n + 3; ++k) {
                part.add(before[faces[k]].position, 0);
                part.add(now[faces[k]].position, 0);
            }
}

/// Finds the triangles that differ between both, number by number.
void addShapes(Part& part, std::span<const ViewCorner> before, std::span<const ViewCorner> now)
{
    const std::size_t corners = std::max(before.size(), now.size());
    for (std::size_t n = 0; n + 2 < corners; n += 3) {
        const bool was = n + 2 < before.size(), is = n + 2 < now.size();
        if (was && is && same(before.subspan(n, 3), now.subspan(n, 3))) continue;
        for (std::size_t k = n; k < n + 3; ++k) {
            if (was) part.add(before[k]);
            if (is) part.add(now[k]);
        }
    }
}

} // namespace

std::optional<PixelRect> changedPart(const SurfaceInput& before, const SurfaceInput& now)
{
    const std::size_t points = now.splats.size() - now.dots;
    if (before.detail != Detail::fast || now.detail != Detail::fast || !same(before.frame, now.frame) ||
        before.splats.size() - before.dots != points || !same(before.faces, now.faces))
        return {};
    Part part(now.frame);
    if (now.faces.empty())
        addDiscs(part, before.splats.first(points), now.splats.first(points));
    else
        addFaces(part, before.splats.first(points), now.splats.first(points), now.faces);
    const auto dotsBefore = before.splats.subspan(points), dots = now.splats.subspan(points);
    if (!same(dotsBefore, dots)) {
        for (const ViewSplat& dot : dotsBefore) part.add(dot);
        for (const ViewSplat& dot : dots) part.add(dot);
    }
    addShapes(part, before.shapes, now.shapes);
    return part.rect();
}

PixelRect changedPart(const Overlay& before, const Overlay& now)
{
    PixelRect  part;
    const auto side = int(shared::kTile);
    const auto add  = [&](std::uint32_t tile) {
        const int x = int(tile & 0xFFFFU) * side, y = int(tile >> 16) * side;
        part = unionOf(part, {x, y, std::min(x + side, now.width), std::min(y + side, now.height)});
    };
    const auto differs = [&](std::uint32_t tile) {
        const int x = int(tile & 0xFFFFU) * side, y = int(tile >> 16) * side;
        const int width = std::min(side, now.width - x);
        for (int row = y; row < std::min(y + side, now.height); ++row) {
            const std::size_t at = std::size_t(row) * std::size_t(now.width) + std::size_t(x);
            if (std::memcmp(&before.pixels[at], &now.pixels[at], std::size_t(width) * sizeof before.pixels[at]) != 0)
                return true;
        }
        return false;
    };
    for (const auto* tiles : {&before.tiles, &now.tiles}) // what only one of them has is empty in the other
        for (const std::uint32_t tile : *tiles)
            if (differs(tile)) add(tile);
    return part;
}

} // namespace palp
