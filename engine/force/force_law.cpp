#include "engine/force/force_law.h"

#include <numbers>

namespace palp {

double contactStiffness(double modulus, double footprintRadius, double thickness) noexcept
{
    return modulus * std::numbers::pi * footprintRadius * footprintRadius / thickness;
}

double feltStiffness(ForceLaw law, double contact, double compliance) noexcept
{
    return law == ForceLaw::series ? 1 / (1 / contact + compliance) : contact;
}

} // namespace palp
