#pragma once
#include <string>
#include <vector>

#include "engine/cloud/soft_object.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// Share by which a curvature may be read too strong before it is said [1].
inline constexpr double kMostFitBias = 0.05;

/// Returns by what share fits read a curvature too strong, because the surface is no quadric so far around [1]:
/// radius^2 (0.10 k1^2 + 0.06 k1 k2), and without the second part where the surface bends both ways against each other.
///
/// Measured on spheres and cylinders of 100 to 20 000 points, even and random, whose fits reach five spacings: 1.2,
/// 3.4, 4.9, 9.5, 14 and 25 % at radii of 0.27, 0.45, 0.54, 0.71, 0.82 and 0.98 of a sphere's, and 1.8, 2.7, 5.3, 8.3
/// and 17 % at 0.42, 0.51, 0.69, 0.82 and 1.07 of a cylinder's; this is right to 1 % of the curvature up to there, and
/// says too much beyond.
/// \param radius           of the fits [m]
/// \param larger, smaller  principal curvatures as they were read [1/m]
[[nodiscard]] double fitBias(double radius, double larger, double smaller) noexcept;

/// Returns by what share fits read the larger curvature at a contact too weak, because it is largest there and changes
/// within their radius [1]; below 0 too strong, because it is least there; 0 where there is little of it.
///
/// Of waves cos(q x), of which a fit within r reads 9, 16, 37 and 51 % too little at q r of 1.0, 1.3, 2.0 and 2.7 (1.5
/// mm high and 16 mm long, 1 mm and 24 mm, points 0.5 and 1 mm apart, with and without noise), it is 0.115 times what
/// two places r to either side along that curvature have less of it than the middle, over it: 10, 17, 33 and 44 %. A
/// weaker reading is weaker everywhere, so that this share does not feel it.
[[nodiscard]] double changeBias(const Patch& patch);

/// Returns how wide the facets of a mesh are around a place, across the edges at which they meet at 1 to 40 degrees
/// [m]: a mean by area; 0 if there are none, or the mesh bends nowhere around.
/// \thread pure; passes over all faces
[[nodiscard]] double facetWidth(const SurfaceMesh& mesh, const glm::dvec3& place, double reach);

/// Returns, in sentences, why the curvature that a patch bent with may be read wrong: points that are too far apart,
/// what changes within its fits, or facets that are wider than them. Of an object with a border nearly as wide as it is
/// long it says that a window about the contact does not know it. Of a plate it says that the surface is curved where
/// the fitted sphere, of which warnings() knows, is not: a saddle's has no curvature, and a tube's half of it. Empty is
/// good.
///
/// Measured on spheres and cylinders of facets: fits as wide as 1.15 facets and more are right to 5 %, of 0.9 off by
/// -12 to 3 %, of 0.7 by -3 to 35 %, and of half of one by -73 to 63 %: they find a curvature of none on the facets.
[[nodiscard]] std::vector<std::string> curvatureDoubts(const SoftObject& object, const Patch& patch,
                                                       const PatchSettings& settings);

/// Returns why the points of an object may be too far apart for its curvature, from places all over it; empty if fewer
/// than a tenth of them are. Milliseconds, and longer on dense clouds.
[[nodiscard]] std::string sparseForCurvature(const SoftObject& object);

} // namespace palp
