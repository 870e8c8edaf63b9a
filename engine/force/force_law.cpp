#include "engine/force/force_law.h"

#include <numbers>

namespace palp {

const char* name(ForceLaw law) noexcept
{
    return law == ForceLaw::series ? "series" : "paper";
}

std::optional<ForceLaw> forceLawNamed(std::string_view text)
{
    for (ForceLaw law : {ForceLaw::series, ForceLaw::paper})
        if (name(law) == text) return law;
    return {};
}

double contactStiffness(double modulus, double footprintRadius, double thickness) noexcept
{
    return modulus * std::numbers::pi * footprintRadius * footprintRadius / thickness;
}

double feltStiffness(ForceLaw law, double contact, double compliance) noexcept
{
    return law == ForceLaw::series ? 1 / (1 / contact + compliance) : contact;
}

} // namespace palp
