#include "engine/viewer/touch_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

namespace palp {
namespace {

/// Shares of the window: large enough to be seen, small enough to leave the dent free [1].
constexpr double kArrow = 0.006, kOutline = 0.0016, kCue = 0.07;

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
      restNormals_(skin_.normals(cloud.positions())), normals_(restNormals_),
      positions_(cloud.positions().begin(), cloud.positions().end()), deflections_(cloud.size()), hollows_(cloud.size())
{
}

void TouchView::take(const Patch* patch)
{
    const auto same = [this](const Patch& now) {
        return now.contact.point == shown_.contact && now.compliance == shown_.compliance &&
               now.points.size() == shown_.points;
    };
    if (patch ? same(*patch) : shown_.points == 0) return;
    surface_ = patch ? PatchSurface(*patch, cloud_.positions(), kCue * settings_.window) : PatchSurface();
    shown_   = patch ? Shown{patch->contact.point, patch->compliance, patch->points.size()} : Shown{};
}

void TouchView::bend(double force, double exaggeration)
{
    for (const std::uint32_t n : moved_) {
        positions_[n]   = cloud_.positions()[n];
        normals_[n]     = restNormals_[n];
        deflections_[n] = hollows_[n] = 0;
    }
    moved_ = surface_.moving;
    for (std::size_t i = 0; i < moved_.size(); ++i) {
        const std::uint32_t n = moved_[i];
        deflections_[n]       = force * surface_.responses[i];
        positions_[n] += exaggeration * deflections_[n] * surface_.inward;
        const double side = glm::dot(restNormals_[n], surface_.inward) < 0 ? 1 : -1; // normals have either side
        hollows_[n]       = side * exaggeration * force * surface_.hollows[i];
    }
    skin_.refit(positions_, moved_, normals_);
}

void TouchView::paint(double force, const TouchLook& look)
{
    scene_.positions = positions_;
    scene_.normals   = normals_;
    scene_.radii     = skin_.radii();
    scene_.cores     = skin_.cores();
    scene_.hollows   = hollows_;
    scene_.ground    = look.ground;
    if (look.paint == ViewPaint::deflection) {
        const double most = look.deepest > 0 ? look.deepest : std::abs(force) * surface_.mostResponse;
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
    const auto placeOf         = [&](const PatchSurface::EdgePlace& e) {
        return e.rest + look.exaggeration * force * e.response * inward;
    };
    for (std::size_t n = 1; n < surface_.edge.size(); ++n)
        if (!surface_.edge[n].starts)
            scene_.outline.push_back({placeOf(surface_.edge[n - 1]), placeOf(surface_.edge[n])});
}

void TouchView::show(const Patch* patch, double force, const TouchLook& look, const std::optional<TouchHand>& hand)
{
    constexpr double kMarker = 0.45; // of the fingertip [1]
    take(patch);
    bend(force, look.exaggeration);
    scene_               = {};
    scene_.markerRadius  = std::min(kMarker * settings_.footprintRadius, 0.025 * settings_.window);
    scene_.arrowRadius   = kArrow * settings_.window;
    scene_.outlineRadius = kOutline * settings_.window;
    scene_.cueRadius     = kCue * settings_.window;
    paint(force, look);
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
