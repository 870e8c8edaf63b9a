#include "engine/tools/paper/dent_shape.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "engine/core/contract.h"

namespace palp::report {
namespace {

/// Returns the chart coordinate where the field has fallen to half along one axis, linear between nodes.
double halfWay(const PatchWindow& window, const NodeField& field, bool east)
{
    const PlateGrid& grid = window.grid;
    const int        i0 = grid.cellsX / 2, j0 = grid.cellsZ / 2, last = east ? grid.cellsX - i0 : grid.cellsZ - j0;
    const double     half = 0.5 * field(i0, j0), spacing = east ? grid.spacingX : grid.spacingZ;
    for (int n = 1; n <= last; ++n) {
        const double before = east ? field(i0 + n - 1, j0) : field(i0, j0 + n - 1);
        const double here   = east ? field(i0 + n, j0) : field(i0, j0 + n);
        if (here <= half) return spacing * (n - 1 + (before - half) / (before - here));
    }
    throw Error("the dent does not fall to half its depth within the patch window");
}

} // namespace

double distanceOnObject(const Chart& chart, const ChartPoint& position)
{
    const auto place = chart.lift(position);
    PALP_EXPECT(place.has_value(), "a chart position beyond the hemisphere");
    const double chord = glm::length(*place - chart.origin), curvature = std::abs(chart.curvature);
    const double sine = 0.5 * chord * curvature; // of half the angle
    return sine < 1e-9 ? chord : 2 * std::asin(std::min(sine, 1.0)) / curvature;
}

DentShape dentShape(const Chart& chart, const PatchWindow& window, const NodeField& field)
{
    return {field(window.grid.cellsX / 2, window.grid.cellsZ / 2),
            distanceOnObject(chart, {halfWay(window, field, true), 0}),
            distanceOnObject(chart, {0, halfWay(window, field, false)})};
}

} // namespace palp::report
