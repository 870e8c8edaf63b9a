#include "engine/viewer/touch_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

namespace palp {
namespace {

/// How far the surface lies from the fitted sphere at a place of the chart: the mean over the nearest points of the
/// sheet on top. Empty where there is no surface.
std::optional<glm::dvec3> residualAt(const Patch& patch, std::span<const glm::dvec3> positions, const ChartPoint& at)
{
    constexpr std::size_t kNear  = 16;// points looked at [1]
    constexpr double      kFar   = 4; // spacings beyond which there is none [1]
    constexpr double      kSheet = 1; // spacings below the highest that are still the same sheet [1]
    std::array<std::pair<double, std::size_t>, kNear> near;
    near.fill({std::numeric_limits<double>::infinity(), 0});
    for (std::size_t n = 0; n < patch.positions.size(); ++n) {
        const double x = patch.positions[n].x - at.x, z = patch.positions[n].z - at.z;
        if (x * x + z * z >= near.back().first) continue;
        near.back() = {x * x + z * z, n};
        std::ranges::sort(near);
    }
    if (!(near.back().first < kFar * kFar * patch.spacing * patch.spacing)) return std::nullopt;
    std::vector<glm::dvec3> residuals;
    double                  highest = -std::numeric_limits<double>::infinity(); // [m]
    for (const auto& [distance, n] : near)
        if (const auto on = patch.chart.lift(patch.positions[n])) {
            residuals.push_back(positions[patch.points[n]] - *on);
            highest = std::max(highest, glm::dot(residuals.back(), patch.chart.frame.normal));
        }
    glm::dvec3 sum(0);
    double     count = 0;
    for (const glm::dvec3& residual : residuals)
        if (glm::dot(residual, patch.chart.frame.normal) >= highest - kSheet * patch.spacing) {
            sum += residual;
            ++count;
        }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
}

/// A line that follows the surface along the window's edge; parts where there is no surface are left out.
std::vector<ViewSegment> outlineOf(const Patch& patch, std::span<const glm::dvec3> positions)
{
    constexpr int    kSteps = 48; // a side [1]
    const double     width = patch.window.grid.sizeX(), height = patch.window.grid.sizeZ();
    const ChartPoint corner = patch.window.corner;
    const auto       place  = [&](int n) -> std::optional<glm::dvec3> {
        const int        side = n / kSteps % 4;
        const double     t    = double(n % kSteps) / kSteps;
        const double     x    = side == 0 ? t : side == 1 ? 1 : side == 2 ? 1 - t : 0;
        const double     z    = side == 0 ? 0 : side == 1 ? t : side == 2 ? 1 : 1 - t;
        const ChartPoint at{corner.x + x * width, corner.z + z * height};
        const auto       on = patch.chart.lift(at), off = residualAt(patch, positions, at);
        return on && off ? std::optional(*on + *off) : std::nullopt;
    };
    std::vector<ViewSegment>  segments;
    std::optional<glm::dvec3> last = place(0);
    for (int n = 1; n <= 4 * kSteps; ++n) {
        const auto next = place(n);
        if (last && next) segments.push_back({*last, *next});
        last = next;
    }
    return segments;
}

} // namespace

const char* name(ViewPaint paint) noexcept
{
    constexpr const char* kNames[] = {"deflection", "stiffness", "plain"};
    return kNames[int(paint)];
}

std::optional<ViewPaint> viewPaintNamed(std::string_view wanted)
{
    for (const ViewPaint paint : {ViewPaint::deflection, ViewPaint::stiffness, ViewPaint::plain})
        if (wanted == name(paint)) return paint;
    return std::nullopt;
}

TouchView::TouchView(const PointCloud& cloud, const NeighbourIndex& index, const PatchSettings& settings)
    : cloud_(cloud), settings_(settings), skin_(cloud.positions(), index),
      restNormals_(skin_.normals(cloud.positions()))
{
}

void TouchView::bend(const Patch* patch, double force, double exaggeration)
{
    positions_.assign(cloud_.positions().begin(), cloud_.positions().end());
    normals_ = restNormals_;
    deflections_.assign(cloud_.size(), 0);
    if (!patch) return;
    positions_   = displaced(cloud_, *patch, exaggeration * force);
    deflections_ = deflections(cloud_, *patch, force);
    skin_.refit(positions_, patch->points, normals_);
}

void TouchView::paint(const TouchLook& look)
{
    scene_.positions = positions_;
    scene_.normals   = normals_;
    scene_.radii     = skin_.radii();
    scene_.cores     = skin_.cores();
    scene_.ground    = look.ground;
    if (look.paint == ViewPaint::deflection) {
        const double most = look.deepest > 0 ? look.deepest : *std::ranges::max_element(deflections_);
        scene_.values     = deflections_;
        scene_.colours    = {look.map, Scale::linear, {0, most > 0 ? most : 1e-3}, "deflection", "m"};
    } else if (look.paint == ViewPaint::stiffness) {
        constexpr double kWide = 5; // from such a ratio on a linear scale hides the soft end [1]
        const auto       range = rangeOf(cloud_.stiffness(), Scale::logarithmic).value_or(ValueRange{});
        const Scale      scale = range.high > kWide * range.low ? Scale::logarithmic : Scale::linear;
        scene_.values          = cloud_.stiffness();
        if (cloud_.kind() == StiffnessKind::modulus)
            scene_.colours = {look.map, scale, widened(range, scale), "Young's modulus", "Pa"};
        else
            scene_.colours = {look.map, scale, widened(range, scale), "rigidity", "N m"};
    }
}

void TouchView::addShapes(const Patch& patch, double force, const TouchLook& look, const std::optional<TouchHand>& hand)
{
    constexpr double kLongest = 0.22, kNormal = 1.35; // of the window; of the force's arrow [1]
    const glm::dvec3 inward = patch.forceDirection();
    const PlateGrid& grid   = patch.window.grid;
    const double     dent   = force * patch.response(grid.cellsX / 2, grid.cellsZ / 2);
    const glm::dvec3 point  = patch.contact.point;
    const double     felt   = patch.feltStiffness;
    scene_.proxy            = point + look.exaggeration * dent * inward;
    scene_.hip              = hand ? hand->hip : point + look.exaggeration * (felt > 0 ? force / felt : dent) * inward;
    const double     strongest = look.strongest > 0 ? look.strongest : std::abs(force);
    const double     longest   = kLongest * settings_.window;
    const double     length    = strongest > 0 ? longest * std::abs(force) / strongest : 0;
    const glm::dvec3 against   = hand && glm::length(hand->force) > 0 ? glm::normalize(hand->force) : -inward;
    scene_.force               = ViewSegment{*scene_.proxy, *scene_.proxy + length * against};
    scene_.normal              = ViewSegment{*scene_.proxy, *scene_.proxy - kNormal * longest * inward};
    scene_.outline             = outlineOf(patch, positions_);
}

void TouchView::show(const Patch* patch, double force, const TouchLook& look, const std::optional<TouchHand>& hand)
{
    // Shares of the window and of the fingertip: large enough to be seen, small enough to leave the dent free.
    constexpr double kMarker = 0.45, kArrow = 0.006, kOutline = 0.0016, kCue = 0.07; // [1]
    bend(patch, force, look.exaggeration);
    scene_               = {};
    scene_.markerRadius  = std::min(kMarker * settings_.footprintRadius, 0.025 * settings_.window);
    scene_.arrowRadius   = kArrow * settings_.window;
    scene_.outlineRadius = kOutline * settings_.window;
    scene_.cueRadius     = kCue * settings_.window;
    paint(look);
    if (patch)
        addShapes(*patch, force, look, hand);
    else if (hand)
        scene_.hip = hand->hip;
}

Camera cameraAt(const Patch& patch, double aspect)
{
    constexpr double kAround = 0.62; // radius of what must be seen, of the window's edge [1]
    const Frame&     frame   = patch.chart.frame;
    Camera           camera;
    camera.up    = frame.normal;
    camera.toEye = glm::normalize(0.62 * frame.normal + 0.30 * frame.east - 0.72 * frame.north);
    return framed(camera, patch.contact.point, kAround * patch.window.grid.sizeX(), aspect);
}

double forceThatShows(const Patch& patch, double thickness)
{
    const double most   = *std::ranges::max_element(patch.response.values()); // [m/N]
    const double force  = thickness / (3 * most);
    const double decade = std::pow(10.0, std::floor(std::log10(force)) - 1);
    return std::round(force / decade) * decade;
}

} // namespace palp
