#include "engine/plate/detail/rigidity_unit.h"

#include <cmath>

#include "engine/core/contract.h"
#include "engine/core/quantity.h"

namespace palp {

namespace {

constexpr double kLeast = 1e-15, kMost = 1e15; // relative to the unit [1]

void checkFits(double rigidity, double unit)
{
    const double relative = rigidity / unit;
    if (!(relative > kLeast && relative < kMost))
        throw Error("plate: the rigidity spans too many orders of magnitude for 32-bit arithmetic: there is " +
                    formatQuantity(rigidity, "N m") + ", the largest being about " + formatQuantity(unit, "N m"));
}

} // namespace

double rigidityUnit(double largest) noexcept
{
    return std::ldexp(1.0, 2 * int(std::floor(std::ilogb(largest) / 2.0)));
}

bool isUnitOf(double unit, const Extremes& rigidity) noexcept
{
    constexpr double kApart = 1e3; // [1]
    return rigidity.most < kApart * unit && rigidity.most > unit / kApart && rigidity.least > kLeast * unit;
}

Extremes inRigidityUnits(std::span<const double> rigidities, double unit, std::span<float> relative)
{
    const Extremes of = extremesOf(rigidities);
    for (const double end : {of.least, of.most}) checkFits(end, unit);
    for (std::size_t n = 0; n < rigidities.size(); ++n) relative[n] = float(rigidities[n] / unit);
    return of;
}

} // namespace palp
