#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/vec3.hpp>

#include "engine/cloud/point_cloud_io.h"

namespace palp {

/// Finds out how coarsely the coordinates of a file are rounded. Numbers that are all floats were floats once, whatever
/// they are stored as: far from the origin their steps are large, such as 0.5 m at 5 400 000 m.
class CoordinateRounding {
public:
    /// Takes the coordinates of a point as they stand in the file.
    void add(const glm::dvec3& p) noexcept
    {
        for (int k = 0; k < 3; ++k) {
            floats_  = floats_ && double(float(p[k])) == p[k];
            largest_ = std::max(largest_, std::abs(p[k]));
        }
    }

    /// Returns the largest distance between neighbouring numbers among the coordinates, in the file's unit.
    [[nodiscard]] double step() const noexcept
    {
        const double infinity = std::numeric_limits<double>::infinity();
        return floats_ ? double(std::nextafter(float(largest_), float(infinity))) - largest_
                       : std::nextafter(largest_, infinity) - largest_;
    }

private:
    bool   floats_  = true;
    double largest_ = 0;
};

/// Adds a warning to a cloud whose coordinates are rounded by more than a quarter of its spacing.
void warnOfRounding(LoadedCloud& loaded);

} // namespace palp
