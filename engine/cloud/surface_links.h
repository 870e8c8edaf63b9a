#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/neighbour_index.h"
#include "engine/cloud/surface_survey.h"

namespace palp {

/// Longest step along a surface in spacings of the sparser of its two points [1]. A disc of that radius holds 13 random
/// points, so that one in 300 000 has no neighbour.
inline constexpr double kLongestStep = 2;

/// Returns whether a step runs along one sheet: it rises little over the mean tangent plane of its ends, noise apart.
/// Across an edge of 90 degrees enough steps do, straight through a sheet's thickness none does.
/// \param from, to  normals of its ends, of either sign [1]; a step to a point without one always does
/// \param step      [m]
/// \param noise     the larger one of its ends [m]
[[nodiscard]] bool runsAlongSheet(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& step,
                                  double noise) noexcept;

/// The points that a step of a SurfaceFlood leads to from each point of an object. They depend on the points alone;
/// they are found where a flood comes for the first time, and kept: a hand that slides on has little left to find. Some
/// 60 bytes for each point that was ever in reach.
/// \thread any
class SurfaceLinks {
public:
    /// \param survey  of the index's points, with a surface where anything is prepared
    SurfaceLinks(std::shared_ptr<const NeighbourIndex> index, std::shared_ptr<const SurfaceSurvey> survey);

    /// Finds what is not yet known of these points.
    /// \param ranks  along the curve of the index
    void prepare(std::span<const std::uint32_t> ranks);

    /// Returns the ranks that steps lead to from a point that the calling thread has prepared. A step between a point
    /// and one of half as dense a neighbourhood or less may stand at the latter alone. A point without a normal has all
    /// that are near enough.
    [[nodiscard]] std::span<const std::uint32_t> from(std::uint32_t rank) const noexcept;

private:
    static constexpr std::uint32_t kRun = 256; ///< points along the curve that are found together

    struct Run {
        std::array<std::uint32_t, kRun + 1> begin{}; ///< in `to`, of each point; and the end
        std::vector<std::uint32_t>          to;      ///< ranks
    };

    [[nodiscard]] std::unique_ptr<const Run> runFrom(std::uint32_t first) const;

    std::shared_ptr<const NeighbourIndex>   index_;
    std::shared_ptr<const SurfaceSurvey>    survey_;
    std::mutex                              mutex_; ///< of who finds runs; a run that is there does not change
    std::vector<std::unique_ptr<const Run>> runs_;  ///< null: not found yet
};

} // namespace palp
