#include "engine/tools/paper/section.h"

#include <cmath>
#include <cstdio>

#include "engine/core/contract.h"

namespace palp::report {

const std::vector<double>& Section::number(std::string_view wanted) const
{
    for (const Quantity& quantity : numbers)
        if (quantity.name == wanted) return quantity.values;
    throw Error("section " + std::string(1, letter) + " has no number \"" + std::string(wanted) + "\"");
}

std::string percent(double share)
{
    char text[32];
    std::snprintf(text, sizeof text, std::abs(share) < 0.1 ? "%.2g %%" : "%.0f %%", 100 * share);
    return text;
}

std::string fixed(double value, int decimals)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    return text;
}

} // namespace palp::report
