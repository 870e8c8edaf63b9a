#pragma once
#include <memory>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/soft_object.h"
#include "engine/contact/detail/point_tree.h"

namespace palp {

/// The points that a proxy touches, made once from those of an object.
///
/// Where the survey finds the points to be clean they are the object's own, to the bit. Where their noise exceeds an
/// eighth of their spacing, a fit through the usual two dozen would leave much of it, so the surface is shown at a
/// touch scale of eleven or seven times the noise (cloud/touch_scale.h): about one point per square of that side, each
/// moved onto a quadric through the points within some scales. Its spacing is the scale, so that all that the proxy
/// does in spacings it does in scales there. Points that lie on one another count once.
///
/// Points of which the survey knows the side are marked with it, and so are those in line with them.
///
/// A fit within 3.75 scales of seven times the noise sigma holds N = pi (26 sigma)^2 / s^2 points of spacing s, of
/// which about half count: what is left is sigma / sqrt(0.55 N) = 0.029 s, however large the noise is; of eleven times,
/// 0.019 s.
/// \thread immutable
/// \source the projection: Levin 1998, The approximation power of moving least squares; the scale is our own
class ContactPoints {
public:
    /// Takes about 3 s of one core for a million noisy points, on all cores; nothing much where all are clean.
    /// \param object  outlives this: clean points are not copied
    /// \throws Error if most of the points coincide
    explicit ContactPoints(const SoftObject& object);

    [[nodiscard]] std::span<const glm::dvec3> positions() const noexcept { return positions_; } ///< [m]
    [[nodiscard]] std::span<const double>     spacings() const noexcept { return spacings_; }   ///< [m]
    [[nodiscard]] std::span<const PointMark>  marks() const noexcept { return marks_; }         ///< empty: no marks
    [[nodiscard]] double                      usualSpacing() const noexcept { return usual_; }  ///< [m]

private:
    struct Source;

    void unstack(Source& source);
    void smooth(const Source& source);
    void markSides(const Source& source);

    std::span<const glm::dvec3> positions_;
    std::span<const double>     spacings_;
    double                      usual_ = 0;
    std::vector<PointMark>      marks_;

    // What is not the object's own.
    std::vector<glm::dvec3>               ownPositions_;
    std::vector<double>                   ownSpacings_;
    std::unique_ptr<const NeighbourIndex> ownIndex_;
    std::unique_ptr<const SurfaceSurvey>  ownSurvey_;
};

} // namespace palp
