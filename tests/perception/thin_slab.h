#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/cloud/soft_object.h"
#include "engine/pipeline/patch.h"

namespace palp {

/// A slab of 40 x 40 x 3 mm whose upper face is softer than its lower one, as points 1 mm apart with their normals.
struct ThinSlab {
    static constexpr double kUpper = 0.2e6, kLower = 0.8e6; ///< moduli [Pa]

    PatchSettings settings{.foundation = 2e6, .window = 16e-3, .cells = 16, .footprintRadius = 2.5e-3};

    [[nodiscard]] static SoftObject object(bool isUniform = false)
    {
        std::vector<glm::dvec3> positions;
        std::vector<glm::vec3>  normals;
        std::vector<double>     modulus;
        for (const double side : {1.0, -1.0})
            for (int i = -20; i <= 20; ++i)
                for (int j = -20; j <= 20; ++j) {
                    positions.emplace_back(1e-3 * i, 1e-3 * j, 1.5e-3 * side);
                    normals.emplace_back(0, 0, side);
                    modulus.push_back(isUniform ? 0.4e6 : side > 0 ? kUpper : kLower);
                }
        return SoftObject(PointCloud(positions, modulus, StiffnessKind::modulus), {.thickness = 1e-3}, {}, normals);
    }

    /// Whether a point is so far from the slab's sides that its window does not reach beyond them.
    [[nodiscard]] static bool isInside(const glm::dvec3& p) { return std::max(std::abs(p.x), std::abs(p.y)) < 10e-3; }
};

} // namespace palp
