#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/cloud/point_cloud.h"
#include "engine/core/spatial_law.h"

namespace palp {

/// A procedural object that needs no file: its shape, its stiffness, and scene constants that suit it.
///
/// The constants keep a poke of 0.5 N inside Kirchhoff theory (deflection below half the thickness) at most places.
struct Sample {
    std::string_view          name;        ///< as users type it, "ear-lobe"
    std::string_view          description; ///< one line
    std::size_t               points;      ///< default number of points
    Material                  material;
    double                    foundation;      ///< elastic foundation k [Pa/m]
    double                    window;          ///< edge of the patch window [m]
    double                    footprintRadius; ///< of the fingertip [m]
    glm::dvec3                place;           ///< where a first touch is interesting [m]
    std::optional<glm::dvec3> from;            ///< the finger's side of an open shell [1]; empty: closed, from outside
};

/// Returns all samples, in the order in which help texts list them.
[[nodiscard]] std::vector<Sample> samples();

/// Returns the sample of that name.
/// \throws Error naming the samples there are
[[nodiscard]] const Sample& sampleNamed(std::string_view name);

/// Makes random points, uniform per area, on the sample's surface; the modulus [Pa] follows the sample's law or `law`.
/// The same seed gives the same points on every machine.
/// \param points  at least 16
[[nodiscard]] PointCloud makeSample(const Sample& sample, std::size_t points, std::uint64_t seed,
                                    const std::optional<SpatialLaw>& law = {});

/// Returns the region a sample fills [m]; laws are laid across it.
[[nodiscard]] Bounds boundsOf(const Sample& sample);

} // namespace palp
