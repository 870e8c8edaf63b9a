#pragma once
#include <array>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "engine/contact/detail/near_points.h"
#include "engine/contact/detail/plane_fit.h"

namespace palp {

/// The surfaces that a proxy knows of: one on a sheet, two in a groove or at an edge, three in a corner.
struct Surfaces {
    static constexpr int kMost = 3;

    std::array<SurfacePlane, kMost> planes{};
    int                             count   = 0;
    double                          spacing = 0; ///< [m] around here
    glm::dvec3                      seen{};      ///< [1] normal of the first, as last seen from afar; 0: none was seen

    [[nodiscard]] std::span<const SurfacePlane> all() const noexcept { return {planes.data(), std::size_t(count)}; }
    void                                        remove(int which) noexcept;
};

/// The place where a tool pulled to the HIP comes to rest on some planes.
struct RestPoint {
    glm::dvec3                          point{}; ///< [m] nearest to the HIP that is behind no plane
    std::array<double, Surfaces::kMost> load{};  ///< [m] how hard each plane holds, along its normal; 0: not touched

    [[nodiscard]] bool touching() const noexcept { return load[0] > 0 || load[1] > 0 || load[2] > 0; }
};

/// Returns the point nearest to `hip` that lies behind none of the planes, by trying every set of them.
/// \thread pure; no allocation
[[nodiscard]] RestPoint restPointOn(std::span<const SurfacePlane> planes, const glm::dvec3& hip) noexcept;

/// Returns the point nearest to `place` on all the planes that carry load in `rest`.
/// \thread pure; no allocation
[[nodiscard]] glm::dvec3 ontoLoaded(std::span<const SurfacePlane> planes, const RestPoint& rest,
                                    const glm::dvec3& place) noexcept;

/// Finds surfaces and follows them as the proxy moves.
///
/// A surface is found by a ball about the proxy, or above the surfaces that are known: a plane is fitted at its nearest
/// visible point, one that no known surface hides, from several directions in turn. A found surface is fitted again at
/// the foot of the proxy. Where it is known which way points face, those that face the proxy are preferred, and a
/// surface keeps to the side it was found on; but where it would end only because points face the other way, their side
/// is ignored.
/// \thread one; allocates nothing after construction
/// \source our own reconstruction, after the idea that only visible points may count
class SurfaceTracker {
public:
    /// \param points  outlives this
    explicit SurfaceTracker(NearPoints& points) : points_(points), fitter_(points) {}

    /// Adds at most one surface seen from `place` [m].
    /// \param towards  [m] where the proxy is going
    /// \return         true if visible points are within the ball; if no surface was added then, the way may be blocked
    bool discover(Surfaces& surfaces, const glm::dvec3& place, const glm::dvec3& towards) noexcept;

    /// Fits every surface again at the foot of `place` [m]. A surface that finds no points, or only points beyond its
    /// border, stays as it was, with support 0.
    /// \return  [m] the furthest that a surface was moved
    double refresh(Surfaces& surfaces, const glm::dvec3& place) noexcept;

private:
    /// The points in sight of a place.
    struct VisiblePoints {
        bool       any = false;
        NearPoint  nearest{};
        double     sparsest = 0; ///< [m] largest spacing of all points in whose own balls the place is
        glm::dvec3 outward{};    ///< [m^2] sum of overshoots, away from the points
        int        side = 0;     ///< 1: the nearest faces the place; -1: it faces away; 0: its side is not known
    };

    /// A plane to be fitted to the points around it, with a spacing.
    struct TrialPlane {
        glm::dvec3 place{};     ///< [m] near the surface
        glm::dvec3 normal{};    ///< [1] unit
        double     spacing = 0; ///< [m]
        int        side    = 0; ///< see SurfacePlane
    };

    /// The points in whose own balls a place lies.
    struct NearbyPoints {
        bool   alike   = false; ///< points about as close as the trial, or closer
        double sparser = 0;     ///< [m] spacing of the nearest of those much sparser; 0: none
    };

    [[nodiscard]] VisiblePoints           findVisible(const Surfaces& surfaces, const glm::dvec3& place);
    [[nodiscard]] NearbyPoints            pointsNear(const TrialPlane& trial) const noexcept;
    [[nodiscard]] std::optional<PlaneFit> fitPlane(const TrialPlane&             trial,
                                                   std::span<const SurfacePlane> others) noexcept;
    [[nodiscard]] std::optional<PlaneFit> fitAnyDensity(const TrialPlane&             trial,
                                                        std::span<const SurfacePlane> others) noexcept;
    [[nodiscard]] bool addSurface(Surfaces& surfaces, const VisiblePoints& visible, const glm::dvec3& place,
                                  const glm::dvec3& seed) noexcept;
    static void        dropContradicting(Surfaces& surfaces) noexcept;

    NearPoints& points_;
    PlaneFitter fitter_;
};

} // namespace palp
