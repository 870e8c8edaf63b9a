#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/stiffness_painting.h"

namespace palp {

/// A stroke of a brush as the command line takes it: 'at=X,Y,Z;X,Y,Z radius=5mm value=2MPa strength=0.5'.
struct StrokeOrder {
    std::vector<glm::dvec3> path;         ///< corners [m]
    double                  radius   = 0; ///< [m]
    double                  strength = 1; ///< [1]
    std::optional<double>   value;        ///< [Pa] or [N m]; empty: the stroke smooths, or paints one of the next
    std::optional<double>   stiffening;   ///< b [1/m], see DepthLaw
    std::optional<double>   held;         ///< share of a point that is held, 0 to 1 [1]
};

/// Reads a stroke.
/// \param what                  opens error sentences, such as "--stroke 2"
/// \param metresPerPlainNumber  applies to places and radii without a unit
/// \throws Error naming the word, what was expected and what was found
[[nodiscard]] StrokeOrder parseStroke(const std::string& text, const std::string& what, double metresPerPlainNumber,
                                      StiffnessKind kind);

/// Returns the number above zero that stands for a share that is held where logarithms are painted.
[[nodiscard]] double holdOf(double held) noexcept;
/// Returns its inverse, 0 to 1.
[[nodiscard]] double heldOf(double hold) noexcept;

/// The effect of a stroke.
struct StrokeReport {
    std::size_t dabs   = 0;
    std::size_t points = 0; ///< number that the brush covered
};

/// Paints a stroke and shows progress on a terminal.
/// \param painting  of the stiffness; or of growthOf() the stiffening or holdOf() the share that is held, if the stroke
///                  is one of those
/// \throws Error if a corner of the path is farther from the cloud than the radius
[[nodiscard]] StrokeReport paintStroke(const StrokeOrder& order, const std::string& what, const SoftObject& object,
                                       StiffnessPainting& painting);

} // namespace palp
