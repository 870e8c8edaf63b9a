#include "engine/force/compliance_table.h"

#include <algorithm>
#include <cmath>

namespace palp {
namespace {

/// Hermite's cubics on [0, 1]: of the values at both ends, and of the slopes there.
struct Hermite {
    std::array<double, 2> value, slope;

    explicit Hermite(double t) noexcept
        : value{(1 + 2 * t) * (1 - t) * (1 - t), t * t * (3 - 2 * t)}, slope{t * (1 - t) * (1 - t), t * t * (t - 1)}
    {
    }
};

/// The cell of the lattice that holds a coordinate, and the place in the cell.
struct Place {
    int    cell;
    double fraction;
};

Place placeOf(double coordinate, const ComplianceTable& table) noexcept
{
    const double along = (coordinate + table.reach()) / table.spacing;
    const int    cell  = along > 0 ? std::min(int(along), table.side - 2) : 0; // not a number: 0, and stays none
    return {cell, along - cell};
}

/// One of a table's functions.
struct Lattice {
    const ComplianceTable::Entries& entries;
    int                             side;
    double                          spacing; ///< [m]

    [[nodiscard]] const ComplianceTable::Entry& operator()(int i, int j) const noexcept
    {
        return entries[std::size_t(i * side + j)];
    }

    /// Returns the mixed derivative times spacing^2: the mean of how slopeX changes along z and slopeZ along x;
    /// one-sided at the rim.
    [[nodiscard]] double twist(int i, int j) const noexcept
    {
        const int    i0 = std::max(i - 1, 0), i1 = std::min(i + 1, side - 1);
        const int    j0 = std::max(j - 1, 0), j1 = std::min(j + 1, side - 1);
        const double alongX = ((*this)(i1, j).slopeZ - (*this)(i0, j).slopeZ) / (i1 - i0);
        const double alongZ = ((*this)(i, j1).slopeX - (*this)(i, j0).slopeX) / (j1 - j0);
        return 0.5 * spacing * (alongX + alongZ);
    }

    [[nodiscard]] double at(const Place& px, const Place& pz) const noexcept
    {
        const Hermite alongX(px.fraction), alongZ(pz.fraction);
        double        sum = 0;
        for (int m = 0; m < 2; ++m)
            for (int n = 0; n < 2; ++n) {
                const std::size_t            a = std::size_t(m), b = std::size_t(n);
                const ComplianceTable::Entry entry = (*this)(px.cell + m, pz.cell + n);
                sum += alongX.value[a] * alongZ.value[b] * entry.value +
                       alongX.slope[a] * alongZ.value[b] * spacing * entry.slopeX +
                       alongX.value[a] * alongZ.slope[b] * spacing * entry.slopeZ +
                       alongX.slope[a] * alongZ.slope[b] * twist(px.cell + m, pz.cell + n);
            }
        return sum;
    }
};

bool finite(const ComplianceTable::Entry& entry) noexcept
{
    return std::isfinite(entry.value) && std::isfinite(entry.slopeX) && std::isfinite(entry.slopeZ);
}

} // namespace

ComplianceTable::Values ComplianceTable::middle() const noexcept
{
    const auto n = std::size_t(side * side / 2);
    return {compliance[n].value, contactStiffness[n].value, false,
            stiffens ? std::optional(stiffening[n].value) : std::nullopt};
}

ComplianceTable::Values ComplianceTable::at(const ChartPoint& place) const noexcept
{
    const double     most = reach();
    const ChartPoint inside{std::clamp(place.x, -most, most), std::clamp(place.z, -most, most)};
    Values           look = middle();
    if (side > 1) {
        const Place px = placeOf(inside.x, *this), pz = placeOf(inside.z, *this);
        look.lnCompliance       = Lattice{compliance, side, spacing}.at(px, pz);
        look.lnContactStiffness = Lattice{contactStiffness, side, spacing}.at(px, pz);
        if (stiffens)
            look.stiffening = std::max(0.0, Lattice{stiffening, side, spacing}.at(px, pz)); // cubics overshoot
    }
    look.clamped = inside.x != place.x || inside.z != place.z;
    return look;
}

bool ComplianceTable::usable() const noexcept
{
    if (side < 1 || side > kMostSide || side % 2 == 0 || !(side == 1 || spacing > 0) || !std::isfinite(spacing))
        return false;
    const auto all = [this](const Entries& entries) {
        return std::all_of(entries.begin(), entries.begin() + side * side, finite);
    };
    return all(compliance) && all(contactStiffness) && (!stiffens || all(stiffening));
}

} // namespace palp
