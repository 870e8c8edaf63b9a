#pragma once
#include <string_view>
#include <vector>

#include "engine/plate/plate.h"

namespace palp::bench {

/// Returns a rigidity over the unit square by the name that benchmarks give it, relative to the softest (or, for
/// contrasts below 1, the surrounding) place [1].
///
///     linear      1 to `contrast` along x             hyperbolic  the same ends, 1/D linear
///     wart        1 + a Gaussian of deviation 0.1     disc        `contrast` within 0.2 of (0.45, 0.55), else 1
///     discs       100 and 0.1, side by side, in 1: a wart beside a soft spot
///
/// \throws Error naming the known laws
[[nodiscard]] double rigidityAt(std::string_view law, double contrast, double x, double z);

inline constexpr double kSoftest = 2e-3; ///< rigidity where the law says 1 [N m]

/// Makes a clamped square plate of 40 mm, as a patch window of skin is.
[[nodiscard]] Plate plateOf(std::string_view law, double contrast, int nodes);

/// A rigidity with the name under which it appears in tables.
struct Map {
    std::string_view name;
    std::string_view law;
    double           contrast;
    bool             smooth; ///< the discretisation is of second order for smooth maps only
};

/// Returns all maps that `palpate bench` knows.
[[nodiscard]] const std::vector<Map>& maps();
[[nodiscard]] const Map&              mapNamed(std::string_view name);
[[nodiscard]] Plate                   plateOf(const Map& map, int nodes);

/// Makes the load of a fingertip of 4 mm and 1 N at (x, z), both relative to the size of the plate [1]. On a very
/// coarse grid the fingertip has 1.5 spacings.
[[nodiscard]] NodeField fingertip(const PlateGrid& grid, double x = 0.5, double z = 0.5);

} // namespace palp::bench
