#pragma once
#include <numbers>

#include "engine/core/enum_names.h"

namespace palp {

/// The laws that turn the depth of the hand in the surface into a force.
enum class ForceLaw {
    series, ///< contact and plate are springs in series: F = depth / (1/k_c + c)
    paper   ///< F = k_c depth: the plate bends on the screen, but is not felt
};
constexpr auto namesOf(ForceLaw)
{
    using enum ForceLaw;
    return std::to_array<NamedValue<ForceLaw>>({{series, "series"}, {paper, "paper"}});
}

/// Returns the stiffness of the contact itself, k_c = E A / h [N/m], with A the area of the footprint.
/// For skin of 0.3 MPa, 4 mm thick, and a footprint of radius 3.6 mm it is about 3 kN/m.
/// \param modulus          E at the contact [Pa]
/// \param footprintRadius  [m]
/// \param thickness        h [m]
/// \source Kumari & Chaudhuri 2016, the force law F = (E A / h) depth
[[nodiscard]] inline double contactStiffness(double modulus, double footprintRadius, double thickness) noexcept
{
    return modulus * std::numbers::pi * footprintRadius * footprintRadius / thickness;
}

/// Returns the stiffness that the hand feels [N/m].
/// \param contactStiffness  k_c [N/m]
/// \param compliance        c of the plate under the footprint [m/N]
/// \differs the paper feels k_c alone, which does not depend on how the neighbourhood bends
[[nodiscard]] inline double feltStiffness(ForceLaw law, double contactStiffness, double compliance) noexcept
{
    return law == ForceLaw::series ? 1 / (1 / contactStiffness + compliance) : contactStiffness;
}

} // namespace palp
