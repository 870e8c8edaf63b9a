#include "engine/tools/render/touch_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/tools/render/curvature_crosses.h"
#include "engine/tools/render/rest_relief.h"

namespace palp {
namespace {

/// Shares of the window: large enough to be seen, small enough to leave the dent free [1].
constexpr double kArrow = 0.006, kOutline = 0.0016, kCue = 0.07;

/// Share of even light where stiffness is painted, so that a stiff value in shade does not look like a softer one. Less
/// than that of a figure about values alone: the shape of what is touched has to be seen too [1].
constexpr double kLightOfStiffness = 0.6;

constexpr double kDot = 0.22; ///< radius of a dot, of the point's core [1]

/// Circles and spokes of the near half of the fitted sphere, as far as a window's edge reaches.
std::vector<ViewSegment> linesOf(const Chart& chart, double window)
{
    constexpr int    kCircles = 6, kSpokes = 12, kAround = 48, kAlong = 12;
    constexpr double kQuarter = std::numbers::pi / 2, kTurn = 2 * std::numbers::pi;
    const double     k = chart.curvature;                                                     // [1/m] signed
    const double most  = std::min(window, std::abs(k) > 0 ? kQuarter / std::abs(k) : window); // along the surface [m]
    const auto   at    = [&](double s, double angle) {
        const double     t      = s * k; // as seen from the centre [rad]
        const double     aside  = std::abs(t) > 1e-4 ? std::sin(t) / k : s;
        const double     sinks  = std::abs(t) > 1e-4 ? (1 - std::cos(t)) / k : s * t / 2;
        const glm::dvec3 radial = std::cos(angle) * chart.frame.east + std::sin(angle) * chart.frame.north;
        return chart.origin + aside * radial - sinks * chart.frame.normal;
    };
    std::vector<ViewSegment> lines;
    for (int c = 1; c <= kCircles; ++c)
        for (int n = 0; n < kAround; ++n)
            lines.push_back(
                {at(most * c / kCircles, kTurn * n / kAround), at(most * c / kCircles, kTurn * (n + 1) / kAround)});
    for (int s = 0; s < kSpokes; ++s)
        for (int n = 0; n < kAlong; ++n)
            lines.push_back(
                {at(most * n / kAlong, kTurn * s / kSpokes), at(most * (n + 1) / kAlong, kTurn * s / kSpokes)});
    return lines;
}

} // namespace

TouchView::TouchView(const SoftObject& object, const PatchSettings& settings)
    : object_(object), bent_(bentSize(object, settings)), fingertip_(settings.footprintRadius),
      skin_(object.positions(), object.index()), restNormals_(skin_.normals(object.positions())),
      oneSided_(skin_.turnOutwards(object.positions(), restNormals_)), normals_(restNormals_),
      positions_(object.positions().begin(), object.positions().end()), deflections_(object.size()),
      stiffness_(object.cloud().stiffness())
{
    if (!object.mesh().faces.empty()) mesh_.emplace(object);
    findRelief();
}

void TouchView::findRelief()
{
    // Each point sees it in the noise of its own normal.
    relief_  = skin_.smoothed(restRelief(object_.positions(), restNormals_, object_.spacing(), kCue * bent_));
    hollows_ = relief_;
    if (mesh_) mesh_->relieve(relief_, restNormals_);
}

void TouchView::use(const PatchSettings& settings)
{
    const double before = std::exchange(bent_, bentSize(object_, settings));
    fingertip_          = settings.footprintRadius;
    if (bent_ != before) findRelief();
}

void TouchView::take(const Patch* patch)
{
    const auto same = [this](const Patch& now) {
        return now.contact.point == shown_.contact && now.compliance == shown_.compliance &&
               now.points.size() == shown_.points;
    };
    if (patch ? same(*patch) : shown_.points == 0) return;
    surface_ = patch ? PatchSurface(*patch, object_.positions(), kCue * bent_) : PatchSurface();
    shown_   = patch ? Shown{patch->contact.point, patch->compliance, patch->points.size()} : Shown{};
    if (mesh_) mesh_->take(surface_);
}

void TouchView::bend(double load, double exaggeration)
{
    if (mesh_) return mesh_->bend(load, exaggeration);
    for (const std::uint32_t n : moved_) {
        positions_[n]   = object_.positions()[n];
        normals_[n]     = restNormals_[n];
        deflections_[n] = 0;
        hollows_[n]     = relief_[n];
    }
    moved_ = surface_.moving;
    for (std::size_t i = 0; i < moved_.size(); ++i) {
        const std::uint32_t n = moved_[i];
        deflections_[n]       = load * surface_.responses[i];
        positions_[n] += exaggeration * deflections_[n] * surface_.inward;
        const double side = glm::dot(restNormals_[n], surface_.inward) < 0 ? 1 : -1; // normals have either side
        hollows_[n]       = relief_[n] + side * exaggeration * load * surface_.hollows[i];
    }
    skin_.refit(positions_, std::span(moved_).first(surface_.sloping), normals_);
}

void TouchView::paint(double load, const TouchLook& look)
{
    scene_.positions = positions_;
    scene_.normals   = normals_;
    scene_.radii     = skin_.radii();
    scene_.cores     = skin_.cores();
    scene_.hollows   = hollows_;
    scene_.oneSided  = oneSided_;
    scene_.ground    = look.ground;
    if (look.paint == ViewPaint::deflection) {
        constexpr double kRounding = 1e-9; // [1]
        const double     most      = look.deepest > 0 ? look.deepest : std::abs(load) * surface_.mostResponse;
        scene_.values              = deflections_;
        scene_.colours             = {look.map, Scale::linear, {0, most > 0 ? most : 1e-3}, "deflection", "m"};
        scene_.colours.goesOn      = std::abs(load) * surface_.mostResponse > (1 + kRounding) * most;
    } else if (look.paint == ViewPaint::stiffness) {
        constexpr double kWide = 5; // from such a ratio on a linear scale hides the soft end [1]
        const auto       range = rangeOf(stiffness_, Scale::logarithmic).value_or(ValueRange{});
        const Scale      scale = range.high > kWide * range.low ? Scale::logarithmic : Scale::linear;
        scene_.values          = stiffness_;
        scene_.evenLight       = kLightOfStiffness;
        if (object_.cloud().kind() == StiffnessKind::modulus)
            scene_.colours = {look.map, scale, widened(range, scale), "Young's modulus", "Pa"};
        else
            scene_.colours = {look.map, scale, widened(range, scale), "rigidity", "N m"};
    }
}

/// Puts the faces of the mesh in place of the points.
void TouchView::drawMesh(const TouchLook& look)
{
    scene_.positions = mesh_->positions();
    scene_.normals   = mesh_->normals();
    scene_.radii     = mesh_->radii();
    scene_.cores     = mesh_->radii();
    scene_.hollows   = mesh_->hollows();
    scene_.oneSided  = {};
    scene_.faces     = mesh_->faces();
    if (look.paint == ViewPaint::deflection) scene_.values = mesh_->deflections();
    if (look.paint == ViewPaint::stiffness) {
        mesh_->paint(stiffness_);
        scene_.values = mesh_->painted();
    }
}

void TouchView::addHand(const Patch& patch, Pressed by, const TouchLook& look, const std::optional<TouchHand>& hand)
{
    constexpr double kLongest = 0.22, kNormal = 1.35; // of the window; of the force's arrow [1]
    const glm::dvec3 inward = patch.forceDirection();
    const auto [i, j]       = nodeAtContact(patch);
    const double     dent   = by.load * patch.response(i, j);
    const glm::dvec3 point  = hand && hand->proxy ? *hand->proxy : patch.contact.point;
    const double     felt   = patch.feltStiffness;
    const glm::dvec3 proxy  = point + look.exaggeration * dent * inward;
    if (look.overlays.markers) {
        scene_.proxy = proxy;
        // An exaggerated dent moves the hand with it.
        const glm::dvec3 deeper = (look.exaggeration - 1) * dent * inward;
        scene_.hip =
            hand ? hand->hip + deeper : point + look.exaggeration * (felt > 0 ? by.load / felt : dent) * inward;
    }
    if (!look.overlays.arrows) return;
    const double     strongest = look.strongest > 0 ? look.strongest : std::abs(by.force);
    const double     longest   = kLongest * bent_;
    const double     length    = strongest > 0 ? longest * std::min(1.0, std::abs(by.force) / strongest) : 0;
    const glm::dvec3 against   = hand && glm::length(hand->force) > 0 ? glm::normalize(hand->force) : -inward;
    scene_.force               = ViewSegment{proxy, proxy + length * against};
    scene_.normal              = ViewSegment{proxy, proxy - kNormal * longest * inward};
}

/// Adds the stylus of a hand whose HIP is drawn.
void TouchView::addStylus(const std::optional<TouchHand>& hand)
{
    constexpr double kLength = 0.5, kThick = 1.5; // of the window; of an arrow's shaft [1]
    if (!hand || !hand->turn || !scene_.hip) return;
    scene_.stylus = ViewStylus{*scene_.hip, *hand->turn * glm::dvec3(0, 0, 1), *hand->turn * glm::dvec3(0, 1, 0),
                               kLength * bent_, kThick * scene_.arrowRadius};
}

void TouchView::addOutline(double load, double exaggeration)
{
    const auto placeOf = [&](const PatchSurface::EdgePlace& e) {
        return e.rest + exaggeration * load * e.response * surface_.inward;
    };
    for (std::size_t n = 1; n < surface_.edge.size(); ++n)
        if (!surface_.edge[n].starts)
            scene_.outline.push_back({placeOf(surface_.edge[n - 1]), placeOf(surface_.edge[n])});
}

/// What a fit and a chart made of the points.
void TouchView::addFit(const Patch& patch, const Overlays& overlays)
{
    if (overlays.sphere) scene_.sphere = linesOf(chartAtContact(patch), bent_);
    if (overlays.projected)
        eachMoving(patch, object_.positions(), [&](std::uint32_t point, const ChartPoint& place, double) {
            if (const auto on = patch.window.holds(place) ? patch.chart.lift(place) : std::nullopt)
                scene_.dots.push_back({*on, kDot * skin_.cores()[point], kProjectedColour});
        });
    if (overlays.curvature) {
        CurvatureCrosses crosses = curvatureCrosses(patch, object_.positions(), positions_, restNormals_);
        scene_.bulging           = std::move(crosses.bulging);
        scene_.hollow            = std::move(crosses.hollow);
    }
}

void TouchView::addGhost(Ground ground)
{
    constexpr double kNotable = 0.05; // of the deepest: below it a dot lies in the surface [1]
    for (std::size_t i = 0; i < surface_.moving.size(); ++i) {
        const std::uint32_t n = surface_.moving[i];
        if (std::abs(surface_.responses[i]) > kNotable * surface_.mostResponse)
            scene_.dots.push_back({object_.positions()[n], kDot * skin_.cores()[n], inkOn(ground)});
    }
}

void TouchView::show(const Patch* patch, double force, const TouchLook& look, const std::optional<TouchHand>& hand,
                     std::optional<double> load)
{
    const Pressed    by{force, load.value_or(force)};
    constexpr double kMarker = 0.45; // of the fingertip [1]
    take(patch);
    bend(by.load, look.exaggeration);
    scene_               = {};
    scene_.markerRadius  = std::min(kMarker * fingertip_, 0.025 * bent_);
    scene_.arrowRadius   = kArrow * bent_;
    scene_.outlineRadius = kOutline * bent_;
    scene_.cueRadius     = kCue * bent_;
    scene_.faces         = object_.faces();
    paint(by.load, look);
    if (mesh_) drawMesh(look);
    if (patch) {
        addHand(*patch, by, look, hand);
        if (look.overlays.outline) addOutline(by.load, look.exaggeration);
        addFit(*patch, look.overlays);
        if (look.overlays.ghost) addGhost(look.ground);
    } else if (hand && look.overlays.markers) {
        scene_.hip   = hand->hip;
        scene_.proxy = hand->proxy;
    }
    addStylus(hand);
}

Camera cameraAt(const Patch& patch, double aspect)
{
    constexpr double kAround = 0.62; // radius of what must be seen, of the window's edge [1]
    const Frame      frame   = Frame::about(chartAtContact(patch).frame.normal); // the window may stand on its corner
    Camera           camera;
    camera.up    = frame.normal;
    camera.toEye = glm::normalize(0.62 * frame.normal + 0.30 * frame.east - 0.72 * frame.north);
    return framed(camera, patch.contact.point, kAround * bentSize(patch), aspect);
}

double forceThatShows(const Patch& patch, double thickness)
{
    const double most   = mostResponse(patch); // [m/N]
    const double force  = thickness / (3 * most);
    const double decade = std::pow(10.0, std::floor(std::log10(force)) - 1);
    return std::round(force / decade) * decade;
}

} // namespace palp
