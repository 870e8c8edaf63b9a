#pragma once
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

namespace palp {

class JsonObject;

/// A positive number that varies over space by a named law: the rigidity of a plate (at (x, 0, z)) or the stiffness
/// of a cloud's points.
///
/// | law         | value at p                                                        |
/// |-------------|-------------------------------------------------------------------|
/// | constant    | from                                                              |
/// | linear      | from + (to - from) t                                              |
/// | hyperbolic  | 1 / ((1-t)/from + t/to): the compliance varies linearly           |
/// | exponential | from (to/from)^t                                                  |
/// | gaussian    | from + (to - from) max over centres of exp(-|p-c|^2/(2 width^2))  |
/// | disc        | to within `width` of a centre, else from                          |
/// | box         | to within [low, high], else from                                  |
/// | checker     | to or from in cubes of edge `width`, counted from `start`         |
///
/// t runs from 0 at `start` to 1 at `end` along their line and is clamped beyond. Distances are measured in all three
/// coordinates.
struct SpatialLaw {
    enum class Space { plane, volume }; ///< points given as [x, z] (a plate) or [x, y, z] (a cloud)
    enum class Kind { constant, linear, hyperbolic, exponential, gaussian, disc, box, checker };

    Kind                    kind = Kind::constant;
    double                  from = 1;     ///< [Pa] or [N m]
    double                  to   = 1;     ///< [Pa] or [N m]
    glm::dvec3              start{};      ///< [m]
    glm::dvec3              end{1, 0, 0}; ///< [m]
    std::vector<glm::dvec3> centres{};    ///< [m]
    double                  width = 0;    ///< [m] standard deviation, radius or edge
    glm::dvec3              low{};        ///< [m] corner of the box
    glm::dvec3              high{};       ///< [m] opposite corner of the box

    [[nodiscard]] double operator()(const glm::dvec3& p) const noexcept;
};

/// Reads a law from a JSON object, {"law":"linear","from":1,"to":10,"axis":"x"}, or from its short form,
/// linear:from=1,to=10,axis=x (vectors in the short form: centre=0.1;0;0.2, lists of them:
/// centres=0.1;0;0.2/0.3;0;0.2).
///
/// | key | used by | means |
/// |-----|---------|-------|
/// | value | constant | the value |
/// | from, to | all others | see SpatialLaw |
/// | axis ("x", "y", "z") | linear, hyperbolic, exponential | runs across [low, high] along that axis; "x" if absent |
/// | start, end | the same three | the line, instead of an axis: both or neither |
/// | centre, centres | gaussian, disc | one point, or a list |
/// | sigma / radius / edge | gaussian / disc / checker | SpatialLaw::width |
/// | low, high | box | corners |
///
/// Points have as many coordinates as `space` says. A checker is counted from `low`. A point on the rim of a disc or a
/// box, or between two cubes, up to rounding, lies inside, or in the cube that begins there.
/// \param low,high  corners of the region that the law covers [m]: the plate, or the bounds of the cloud
/// \throws Error naming the key, what was expected and found, and for an unknown law or key the known ones
[[nodiscard]] SpatialLaw parseSpatialLaw(std::string_view text, const glm::dvec3& low, const glm::dvec3& high,
                                         SpatialLaw::Space space);
[[nodiscard]] SpatialLaw parseSpatialLaw(const JsonObject& object, const glm::dvec3& low, const glm::dvec3& high,
                                         SpatialLaw::Space space);

} // namespace palp
