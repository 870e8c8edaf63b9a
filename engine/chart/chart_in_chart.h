#pragma once
#include <optional>
#include <span>

#include "engine/chart/chart.h"
#include "engine/core/grid.h"

namespace palp {

/// A place that two charts of one surface have, and how much it counts.
struct PlaceInBoth {
    ChartPoint own{}, other{}; ///< [m]
    double     weight = 1;     ///< [1]
};

/// How a chart lies in another one of the same surface, near its origin: to the second order.
class ChartInChart {
public:
    /// Fits it to places.
    /// \param radius  within which they lie [m]
    /// \return nothing if they do not determine it
    [[nodiscard]] static std::optional<ChartInChart> fitted(std::span<const PlaceInBoth> places, double radius);

    [[nodiscard]] ChartPoint at(const ChartPoint& own) const noexcept; ///< in the other one [m]
    /// Returns by how much lengths at a place are off [1]; infinite where one shows the surface's other side.
    [[nodiscard]] double stretchAt(const ChartPoint& own) const noexcept;
    /// Returns the root mean square distance of the places from it [m].
    [[nodiscard]] double misfit() const noexcept { return misfit_; }

private:
    struct Polynomial {
        double constant = 0, x = 0, z = 0, xx = 0, xz = 0, zz = 0; ///< of places over the radius [m]
    };
    double     radius_ = 1; ///< [m]
    Polynomial x_{}, z_{};
    double     misfit_ = 0;
};

} // namespace palp
