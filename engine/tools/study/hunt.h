#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/cloud/point_cloud.h"

namespace palp::study {

/// A ball of another stiffness under the surface. In the sheet, at its radius the modulus is the geometric mean of
/// those inside and outside; it fades over a quarter of the radius to either side, so that no edge is sharper than
/// points can show. Below the sheet it is a BuriedNodule, which no picture of the stiffness shows.
struct Nodule {
    glm::dvec3 centre{};    ///< [m] on the object
    double     radius  = 0; ///< [m]
    double     modulus = 0; ///< Young's, in its middle [Pa]
    double     depth   = 0; ///< of its middle below the surface [m]; 0: in the sheet

    static constexpr double kFade = 0.25; ///< share of the radius [1]

    /// Returns the weight of its modulus at a distance [m] from its middle: 1 inside, 1/2 at the radius, 0 outside [1].
    [[nodiscard]] double share(double distance) const noexcept;
};

/// The nodules that are hidden in a scene, and the limits by which a search for them is scored.
struct Hunt {
    std::vector<Nodule> nodules;                           ///< as given; empty: `count` random ones
    std::size_t         count       = 0;                   ///< of random ones
    double              leastRadius = 0, mostRadius = 0;   ///< of random ones [m]
    double              leastModulus = 0, mostModulus = 0; ///< of random ones, even in the logarithm [Pa]
    double              leastDepth = 0, mostDepth = 0; ///< of random ones, even in the logarithm [m]; 0: in the sheet
    double ground     = 0;   ///< [m] radius about the scene's place: random nodules lie in it; 0: all of the object
    double pressForce = 0.2; ///< least force with which a finger that moves along an edge traces it [N]
    double tooHard    = 2;   ///< a trainer's limit [N]
};

/// Reads a hunt from JSON: {"nodules": [{"at": [x, y, z], "radius": "4 mm", "modulus": "3 MPa"}, ...]} or {"random":
/// {"count": 4, "radius": ["3 mm", "6 mm"], "modulus": [6e5, 3e6]}}; "ground", "press_force", "too_hard" are optional.
/// \param what  name of the text that begins errors
/// \throws Error naming the nodule, the key, what was expected and found
[[nodiscard]] Hunt parseHunt(std::string_view text, const std::string& what);

/// Writes the hunt as parseHunt() reads it.
[[nodiscard]] std::string huntJson(const Hunt& hunt);

/// Returns the nodules at their places: as given, or with a seed at random places, the same on every machine. Random
/// ones keep a footprint's radius from each other, lie within the ground, and have their whole edge on the object.
/// \param place            the scene's [m]
/// \param footprintRadius  of the fingertip [m]
/// \throws Error naming a nodule that lies beside the object, overlaps another, is too small for the cloud's points, or
///         finds no room
[[nodiscard]] std::vector<Nodule> hiddenNodules(const Hunt& hunt, const std::optional<std::uint64_t>& seed,
                                                const PointCloud& cloud, const glm::dvec3& place,
                                                double footprintRadius);

/// Returns the cloud with the nodules in the sheet laid over its stiffness: E = E0^(1-s) E_nodule^s with s =
/// Nodule::share().
/// \throws Error naming a nodule whose change of stiffness is too small to be felt
[[nodiscard]] PointCloud withNodules(const PointCloud& cloud, const std::vector<Nodule>& nodules,
                                     const Material& material);

} // namespace palp::study
