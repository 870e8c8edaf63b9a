#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/contract.h"
#include "engine/core/enum_names.h"

namespace palp {

class JsonObject;
class VolumeGrid;

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
/// | grid        | that of a volume in a file, see VolumeGrid::at; else `outside`    |
///
/// t runs from 0 at `start` to 1 at `end` along their line and is clamped beyond. Distances are measured in all three
/// coordinates.
struct SpatialLaw {
    enum class Space { plane, volume }; ///< points given as [x, z] (a plate) or [x, y, z] (a cloud)
    enum class Kind { constant, linear, hyperbolic, exponential, gaussian, disc, box, checker, grid };

    /// Where a volume is asked for the stiffness of a cloud's point.
    enum class Along {
        points,   ///< at the point
        thickness ///< through the sheet below it, see VolumeGrid::sheetAlong()
    };
    friend constexpr auto namesOf(Along)
    {
        return std::to_array<NamedValue<Along>>({{Along::points, "points"}, {Along::thickness, "thickness"}});
    }

    Kind                    kind = Kind::constant;
    double                  from = 1;     ///< [Pa] or [N m]
    double                  to   = 1;     ///< [Pa] or [N m]
    glm::dvec3              start{};      ///< [m]
    glm::dvec3              end{1, 0, 0}; ///< [m]
    std::vector<glm::dvec3> centres{};    ///< [m]
    double                  width = 0;    ///< [m] standard deviation, radius or edge
    glm::dvec3              low{};        ///< [m] corner of the box
    glm::dvec3              high{};       ///< [m] opposite corner of the box

    std::shared_ptr<const VolumeGrid> volume{};  ///< of a grid
    std::string                       file{};    ///< of the volume
    std::optional<double>             outside{}; ///< where the volume has no value [Pa]; empty: nowhere else is asked
    Along                             along = Along::points;

    /// Returns the value at a place; NaN where a volume has none.
    [[nodiscard]] double operator()(const glm::dvec3& p) const noexcept;

    /// Returns the same.
    /// \param what  of the place, for the error: "point 7"
    /// \throws Error naming the place and the volume's extent, or its node, where the volume has no value
    [[nodiscard]] double valueAt(const glm::dvec3& p, const std::string& what) const;

    /// The sheet below a point.
    struct Below {
        glm::dvec3 normal{};          ///< of unit length [1]
        bool       outward   = false; ///< the normal is known to point outwards; else its side is not known
        double     thickness = 0;     ///< [m]
    };

    /// Returns the value of a volume through the sheet below a place. Where the outside is not known, the sheet lies on
    /// the side where the volume has more values.
    /// \pre a grid that has been read
    /// \throws Error as valueAt(), where no part of the sheet has a value, and where both sides have as many
    [[nodiscard]] double valueBelow(const glm::dvec3& p, const Below& below, const std::string& what) const;

    /// Returns the error that says that a volume has values on both sides of a place, and so that its inside must be
    /// told.
    /// \param orElse  what else helps, ", or ..."
    [[nodiscard]] Error sideUnknown(const glm::dvec3& p, const std::string& what, const std::string& orElse) const;
};

/// What becomes of the files that a law names.
enum class LawFiles { read, left };

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
/// | file | grid, of a cloud | .npy, .nii or .nii.gz; a path as the caller has put it |
/// | factor | grid | on the file's values, 1 if absent: 1000 for kPa |
/// | outside | grid | value where the file has none; refused if absent |
/// | along | grid | "points", or "thickness": of the sheet below each point, see VolumeGrid::sheetAlong |
/// | length_unit | grid, NIfTI | of the file's lengths, if it states none |
/// | origin, spacing | grid, .npy | place of the first value, 0 if absent; metres between values, one or three numbers |
///
/// Points have as many coordinates as `space` says. A checker is counted from `low`. A point on the rim of a disc or a
/// box, or between two cubes, up to rounding, lies inside, or in the cube that begins there.
/// \param low,high  corners of the region that the law covers [m]: the plate, or the bounds of the cloud
/// \param files     `left`: the file of a grid is not read, and the law has no values there
/// \throws Error naming the key, what was expected and found, and for an unknown law or key the known ones
[[nodiscard]] SpatialLaw parseSpatialLaw(std::string_view text, const glm::dvec3& low, const glm::dvec3& high,
                                         SpatialLaw::Space space, LawFiles files = LawFiles::read);
[[nodiscard]] SpatialLaw parseSpatialLaw(const JsonObject& object, const glm::dvec3& low, const glm::dvec3& high,
                                         SpatialLaw::Space space, LawFiles files = LawFiles::read);

/// Returns a law that is a grid with its file in a folder, unless its path is absolute; any other text as it is.
[[nodiscard]] std::string lawWithFileIn(const std::string& text, const std::filesystem::path& folder);

} // namespace palp
