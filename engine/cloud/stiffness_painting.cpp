#include "engine/cloud/stiffness_painting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "engine/cloud/tokens.h"
#include "engine/core/contract.h"

namespace palp {
namespace {

constexpr std::uint32_t kNoSlot = std::numeric_limits<std::uint32_t>::max(); ///< of a point that no dab has covered

/// Radius over which a brush smooths [1], as a share of the brush's, and its bounds in spacings: fewer points would be
/// no mean, more would cost time that a moving brush does not have.
constexpr double kSmoothShare = 1.0 / 8, kLeastSpacings = 2, kMostSpacings = 4;

constexpr double kDabShare = 1.0 / 8; ///< of the radius, between two dabs of a path
constexpr double kMostDabs = 1e5;     ///< of a path: some seconds

void checkBrush(const Brush& brush)
{
    for (int k = 0; k < 3; ++k)
        if (!std::isfinite(brush.centre[k]))
            throw Error("brush: expected a finite centre [m], found " + shown(brush.centre[k]));
    if (!(brush.radius > 0) || !std::isfinite(brush.radius))
        throw Error("brush: expected a finite radius above zero [m], found " + shown(brush.radius));
    if (!(brush.strength >= 0 && brush.strength <= 1))
        throw Error("brush: expected a strength from 0 to 1, found " + shown(brush.strength));
}

double smoothingRadius(double brushRadius, double spacing)
{
    return std::clamp(kSmoothShare * brushRadius, kLeastSpacings * spacing, kMostSpacings * spacing);
}

} // namespace

double Brush::coverage(double distance) const noexcept
{
    const double t = distance / radius;
    return t < 1 ? strength * (1 - t * t) * (1 - t * t) : 0;
}

std::size_t StiffnessPainting::Stroke::bytes() const noexcept
{
    return sizeof(Stroke) + points.capacity() * sizeof points[0] + values.capacity() * sizeof values[0];
}

StiffnessPainting::StiffnessPainting(const SoftObject& object, std::size_t historyBytes)
    : original_(object.cloud()), flood_(object), survey_(object.survey()), mostHistory_(historyBytes),
      stiffness_(original_.stiffness().begin(), original_.stiffness().end()), slot_(object.size(), kNoSlot)
{
}

void StiffnessPainting::set(std::uint32_t point, double value) noexcept
{
    const double first = original_.stiffness()[point];
    differing_ += value != first ? 1 : 0;
    differing_ -= stiffness_[point] != first ? 1 : 0;
    stiffness_[point] = value;
}

double StiffnessPainting::before(std::uint32_t point) const noexcept
{
    return slot_[point] == kNoSlot ? stiffness_[point] : stroke_.values[slot_[point]];
}

void StiffnessPainting::cover(std::uint32_t point, double coverage, double value)
{
    if (!(coverage > 0)) return;
    std::uint32_t& slot = slot_[point];
    if (slot == kNoSlot) {
        slot = std::uint32_t(stroke_.points.size());
        stroke_.points.push_back(point);
        stroke_.values.push_back(stiffness_[point]);
        coverage_.push_back(0);
    }
    if (coverage <= coverage_[slot]) return;
    coverage_[slot]   = coverage;
    const double from = stroke_.values[slot];
    // Clamped, because the logarithm and its inverse are rounded; full coverage gives the very value.
    const double to = std::exp(std::lerp(std::log(from), std::log(value), coverage));
    set(point, coverage < 1 ? std::clamp(to, std::min(from, value), std::max(from, value)) : value);
}

std::span<const std::uint32_t> StiffnessPainting::coveredBy(const Brush& brush)
{
    checkBrush(brush);
    return flood_.reach(brush.centre, brush.radius);
}

std::span<const std::uint32_t> StiffnessPainting::paint(const Brush& brush, double value)
{
    if (!(value > 0) || !std::isfinite(value))
        throw Error(std::string("paint: expected a finite stiffness above zero [") + unitOf(original_.kind()) +
                    "], found " + shown(value));
    const std::span<const std::uint32_t> points = coveredBy(brush);
    for (const std::uint32_t point : points)
        cover(point, brush.coverage(glm::length(original_.positions()[point] - brush.centre)), value);
    if (!inStroke_) endStroke();
    return points;
}

double StiffnessPainting::riseToMean(std::size_t place, double radius)
{
    // Taken relative to the point's own logarithm, so that among equal points it is exactly zero.
    double       sum = 0, weights = 0;
    const double own = logarithms_[place], perRadius2 = 1 / (radius * radius);
    grid_.around(places_[place], radius, [&](std::size_t other, double distance2) {
        const double inside = 1 - distance2 * perRadius2; // below zero outside
        const double weight = inside + std::abs(inside);  // twice as much or zero, without a branch to guess
        sum += weight * (logarithms_[other] - own);
        weights += weight;
    });
    return sum / weights; // its own weight is 2
}

std::span<const std::uint32_t> StiffnessPainting::smooth(const Brush& brush)
{
    const std::span<const std::uint32_t> covered = coveredBy(brush);
    if (covered.empty()) return covered;
    // In order, so that sums have the same bits on every processor.
    smoothed_.assign(covered.begin(), covered.end());
    std::sort(smoothed_.begin(), smoothed_.end());
    places_.clear();
    befores_.clear();
    logarithms_.clear();
    double reach = 0; // [m]
    for (const std::uint32_t point : smoothed_) {
        places_.push_back(original_.positions()[point]);
        befores_.push_back(before(point));
        logarithms_.push_back(std::log(befores_.back()));
        reach = std::max(reach, smoothingRadius(brush.radius, survey_.spacing(point)));
    }
    grid_.build(places_, reach);
    const auto [least, most] = std::minmax_element(befores_.begin(), befores_.end());
    for (std::size_t i = 0; i < smoothed_.size(); ++i) {
        const double coverage = brush.coverage(glm::length(places_[i] - brush.centre));
        if (!(coverage > 0)) continue;
        const double rise = riseToMean(i, smoothingRadius(brush.radius, survey_.spacing(smoothed_[i])));
        cover(smoothed_[i], coverage, std::clamp(befores_[i] * std::exp(rise), *least, *most));
    }
    if (!inStroke_) endStroke();
    return smoothed_;
}

void StiffnessPainting::beginStroke()
{
    endStroke();
    inStroke_ = true;
}

void StiffnessPainting::endStroke()
{
    inStroke_    = false;
    bool changed = false;
    for (std::size_t i = 0; i < stroke_.points.size(); ++i) {
        slot_[stroke_.points[i]] = kNoSlot;
        changed                  = changed || stiffness_[stroke_.points[i]] != stroke_.values[i];
    }
    coverage_.clear();
    if (changed) {
        for (const Stroke& stroke : undone_) historyBytes_ -= stroke.bytes();
        undone_.clear();
        done_.push_back(stroke_); // copied, so that it holds no more than it needs
        historyBytes_ += done_.back().bytes();
        while (historyBytes_ > mostHistory_ && done_.size() > 1) {
            historyBytes_ -= done_.front().bytes();
            done_.pop_front();
        }
    }
    stroke_.points.clear();
    stroke_.values.clear();
}

const StiffnessPainting::Stroke& StiffnessPainting::swapped(Stroke& stroke)
{
    for (std::size_t i = 0; i < stroke.points.size(); ++i) {
        const double now = stiffness_[stroke.points[i]];
        set(stroke.points[i], stroke.values[i]);
        stroke.values[i] = now;
    }
    return stroke;
}

std::span<const std::uint32_t> StiffnessPainting::undo()
{
    endStroke();
    if (done_.empty()) return {};
    undone_.push_back(std::move(done_.back()));
    done_.pop_back();
    return swapped(undone_.back()).points;
}

std::span<const std::uint32_t> StiffnessPainting::redo()
{
    endStroke();
    if (undone_.empty()) return {};
    done_.push_back(std::move(undone_.back()));
    undone_.pop_back();
    return swapped(done_.back()).points;
}

PointCloud StiffnessPainting::cloud() const
{
    return {original_, stiffness_};
}

std::vector<glm::dvec3> dabsAlong(std::span<const glm::dvec3> path, double radius, const SoftObject& object)
{
    PALP_EXPECT(!path.empty(), "a path needs a corner");
    PALP_EXPECT(radius > 0, "a radius of " + shown(radius) + " m");
    double dabs = 0; // counted first: a path may be long
    for (std::size_t k = 1; k < path.size(); ++k) dabs += glm::length(path[k] - path[k - 1]) / (kDabShare * radius);
    if (!(dabs <= kMostDabs))
        throw Error("stroke: expected at most " + shown(kMostDabs) + " dabs, found " + shown(std::round(dabs)) +
                    ": the path is long and the radius of " + shown(radius) + " m small; take a larger radius");
    std::vector<glm::dvec3> places{path[0]};
    for (std::size_t k = 1; k < path.size(); ++k) {
        const glm::dvec3 step  = path[k] - path[k - 1];
        const int        parts = std::max(1, int(std::ceil(glm::length(step) / (kDabShare * radius))));
        for (int part = 1; part < parts; ++part) {
            const glm::dvec3  between = path[k - 1] + step * (double(part) / parts);
            const glm::dvec3& place   = object.positions()[object.index().nearest(between, 1).front().point];
            if (place != places.back()) places.push_back(place);
        }
        places.push_back(path[k]);
    }
    return places;
}

} // namespace palp
