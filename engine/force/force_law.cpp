#include "engine/force/force_law.h"

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
    constexpr double kPi = 3.14159265358979323846;
    return modulus * kPi * footprintRadius * footprintRadius / thickness;
}

double feltStiffness(ForceLaw law, double contact, double compliance) noexcept
{
    return law == ForceLaw::series ? 1 / (1 / contact + compliance) : contact;
}

} // namespace palp
