#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/point_grid.h"
#include "engine/cloud/soft_object.h"
#include "engine/cloud/surface_flood.h"

namespace palp {

/// A round brush. It covers a point at distance d by strength (1 - d²/radius²)²: all of the strength in the middle,
/// nothing at the radius, and without an edge that a finger would feel.
struct Brush {
    glm::dvec3 centre{};     ///< on the surface [m]
    double     radius   = 0; ///< > 0 [m]
    double     strength = 1; ///< how far one stroke goes to the value in the middle, 0 to 1 [1]

    [[nodiscard]] double coverage(double distance) const noexcept; ///< \param distance [m]
};

/// The stiffness of a cloud while it is being painted, and the strokes that can be taken back.
///
/// Dabs belong to strokes. Within a stroke a point goes by its largest coverage c so far from what it was when the
/// stroke began, v0, to v0^(1 - c) v^c: towards the dab's value v, in logarithms because stiffness is a scale. So dabs
/// over each other do not pile up; strokes do. A dab outside of a stroke is a stroke by itself. A dab changes only the
/// piece of surface that hangs together with its middle (SurfaceFlood).
///
/// Invariant: every stiffness is finite and above zero, between those that it was made of.
/// \thread one
class StiffnessPainting {
public:
    /// Most memory of the strokes that can be taken back or done again [bytes]: 12 for each point that a stroke
    /// changed, so 5.6 million points. The oldest strokes are forgotten first, but never the last: if it changed more
    /// points than that, it alone is held. Beside that a painting holds 20 bytes for each point of the cloud.
    static constexpr std::size_t kHistoryBytes = std::size_t(64) << 20;

    /// \param object  outlives this
    /// \throws Error if the cloud has fewer than seven points or most of them coincide
    explicit StiffnessPainting(const SoftObject& object, std::size_t historyBytes = kHistoryBytes);

    void beginStroke(); ///< Begins a stroke; ends the one before, if there is one.
    void endStroke();   ///< Ends the stroke: its changes are one step of undo().

    /// Puts one dab towards a value.
    /// \param value  [Pa] or [N m], as the cloud's kind
    /// \return       the points that the brush covers; valid until the next call
    /// \throws Error if the brush or the value is not finite or not above zero
    std::span<const std::uint32_t> paint(const Brush& brush, double value);

    /// Puts one dab towards the mean of the logarithms around each point, as they were when the stroke began: over an
    /// eighth of the radius, but at least 2 and at most 4 local spacings, weighted by 1 - (distance / that)².
    /// Returns and throws as paint().
    std::span<const std::uint32_t> smooth(const Brush& brush);

    /// Takes the last stroke back, to the bit; a stroke that has not ended ends.
    /// \return  the points that changed, none if there is nothing to take back; valid until the next call
    std::span<const std::uint32_t> undo();
    /// Does the stroke that was taken back again, to the bit.
    std::span<const std::uint32_t> redo();

    [[nodiscard]] bool canUndo() const noexcept { return !done_.empty() || !stroke_.points.empty(); }
    [[nodiscard]] bool canRedo() const noexcept { return !undone_.empty(); }

    [[nodiscard]] std::span<const double> stiffness() const noexcept { return stiffness_; } ///< [Pa] or [N m]
    [[nodiscard]] PointCloud              cloud() const; ///< with the stiffness as it is now
    [[nodiscard]] bool                    changed() const noexcept { return differing_ > 0; } ///< from the first cloud
    [[nodiscard]] std::size_t             historyBytes() const noexcept { return historyBytes_; } ///< held now

private:
    /// Points and their values before the stroke; undo() swaps the values, so that a swap goes either way.
    struct Stroke {
        std::vector<std::uint32_t> points;
        std::vector<double>        values; ///< [Pa] or [N m]

        [[nodiscard]] std::size_t bytes() const noexcept;
    };

    std::span<const std::uint32_t> coveredBy(const Brush& brush);
    void                           cover(std::uint32_t point, double coverage, double value);
    [[nodiscard]] double           before(std::uint32_t point) const noexcept;
    [[nodiscard]] double           riseToMean(std::size_t place, double radius);
    void                           set(std::uint32_t point, double value) noexcept;
    const Stroke&                  swapped(Stroke& stroke);

    const PointCloud&    original_;
    SurfaceFlood         flood_;
    const SurfaceSurvey& survey_;
    std::size_t          mostHistory_;   ///< [bytes]
    std::vector<double>  stiffness_;     ///< [Pa] or [N m]
    std::size_t          differing_ = 0; ///< points whose stiffness is not that of original_

    bool                       inStroke_ = false;
    Stroke                     stroke_;   ///< not yet ended
    std::vector<double>        coverage_; ///< of the points of stroke_ [1]
    std::vector<std::uint32_t> slot_;     ///< of each point in stroke_

    std::deque<Stroke>  done_;
    std::vector<Stroke> undone_; ///< the next to be done again is the last
    std::size_t         historyBytes_ = 0;

    std::vector<std::uint32_t> smoothed_;   ///< scratch of smooth()
    std::vector<glm::dvec3>    places_;     ///< [m] the same
    std::vector<double>        befores_;    ///< [Pa] or [N m] the same
    std::vector<double>        logarithms_; ///< of befores_, the same
    PointGrid                  grid_;       ///< the same
};

/// Returns the places of the dabs of a stroke along a path: an eighth of the radius apart, so that coverage along the
/// path dips by less than a hundredth. Those between the corners of the path lie on the points nearest to it, because a
/// straight line leaves a round object.
/// \param path  corners [m], at least one
/// \throws Error if there were more than 100 000
[[nodiscard]] std::vector<glm::dvec3> dabsAlong(std::span<const glm::dvec3> path, double radius,
                                                const SoftObject& object);

} // namespace palp
