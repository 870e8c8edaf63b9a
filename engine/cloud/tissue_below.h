#pragma once
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/core/spatial_law.h"

namespace palp {

class SoftObject;

/// A ball of another modulus in the tissue below the sheet.
struct BuriedNodule {
    glm::dvec3 at{};        ///< [m] on the object, above its middle
    double     depth   = 0; ///< of its middle below the surface [m]
    double     radius  = 0; ///< [m]
    double     modulus = 0; ///< Young's [Pa]

    bool operator==(const BuriedNodule&) const = default;
};

/// The tissue between the soft sheet and what does not give, such as bone.
struct TissueBelow {
    double                    depth   = 0; ///< H of the tissue [m]; the sheet is not part of it
    double                    modulus = 0; ///< Young's [Pa], of the tissue whose foundation the scene states
    std::vector<BuriedNodule> nodules;
    std::optional<SpatialLaw> volume{}; ///< moduli of the tissue where they vary, a grid [Pa]
};

/// Computes the foundation below each point over that of even tissue [1], as SoftObject::withFoundation() takes it.
///
/// Below a point the tissue is a column along the inward normal from h to h + H. A part of the column counts by the
/// share w(z) of the energy that even tissue stores at that depth, w ~ cosh^2 (q (H - z)): what is near the skin counts
/// most.
///
///     nodule, m times as stiff, share f of the column
///         m > 1, nearly in series:                          s = (1 - f + f m^-0.85)^(-1/0.85)
///         m < 1, side by side, for the tissue bridges it:   s = 1 - f + f m
///     volume, in series:                                    s = 1 / int w E/E(z) dz
///
/// Where the side of a point is not known, its column runs on the side of the nodule, which lies below the point next
/// to it as seen from without, away from the middle of the object's bounds; or where the volume has more values.
/// \param fingertip  radius a [m]; together with the sheet's thickness h it sets the decay, q = 0.45 / (h + a/2)
/// \throws Error naming the nodule that does not lie in the tissue, or the point where the volume has no value, or as
///         many on both sides, and others
/// \source Vlasov and Leont'ev 1966: a foundation whose displacement decays with depth as sinh (q (H - z))
/// \differs q and the exponent are constants, fitted to 84 axisymmetric solids computed by CalculiX 2.20 (nodules that
///          are 0.1, 5 and 50 times as stiff as the tissue, radius 2.5 to 7 mm, their tops 1 to 5 mm below a sheet of
///          1.5 to 4 mm, fingertips of 2.4 to 6 mm, layers of 15 and 25 mm): the felt stiffness over that without a
///          nodule is right to 10 %, rms 4 %. The column without weight and in series, s = H / int E/E(z) dz, is off
///          by 36 %, and takes a deep nodule for a shallow one
[[nodiscard]] std::vector<double> foundationShape(const SoftObject& object, const TissueBelow& below, double fingertip);

} // namespace palp
