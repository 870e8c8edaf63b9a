#pragma once
#include "engine/chart/chart.h"
#include "engine/chart/resample.h"

namespace palp::report {

/// The shape of a dent on the object, independent of the map in which it was computed.
struct DentShape {
    double deepest    = 0; ///< deflection under the contact [unit of the field]
    double alongEast  = 0; ///< half width at half depth along the chart's east, on the sphere [m]
    double alongNorth = 0; ///< along its north [m]

    /// Returns the longer half width over the shorter one [1]: 1 is round.
    [[nodiscard]] double elongation() const noexcept
    {
        return alongEast > alongNorth ? alongEast / alongNorth : alongNorth / alongEast;
    }
};

/// Measures the dent of a field.
/// \param field  on the window's grid, deepest at the chart's origin, which is a node
/// \throws Error if the field does not fall to half within the window
[[nodiscard]] DentShape dentShape(const Chart& chart, const PatchWindow& window, const NodeField& field);

/// Returns the distance of a chart position from the contact along the sphere, or the plane [m].
[[nodiscard]] double distanceOnObject(const Chart& chart, const ChartPoint& position);

} // namespace palp::report
