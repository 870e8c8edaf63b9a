#pragma once
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace palp {

/// How a surface bends at a place.
struct LocalCurvature {
    glm::dvec3 normal{};  ///< [1] unit, towards the finger
    glm::dmat3 tensor{0}; ///< [1/m] in the world's axes, symmetric, nothing along the normal; > 0 bulges to the finger
    double     sure = 1;  ///< how well the points determine it: 1 all around, about a tenth at a border [1]
};

/// What is known of an object's curvature from touches so far. It depends on the points alone, not on where they were
/// touched: so neighbouring patches agree, and a hand that slides on has little left to fit.
/// \thread any, under the mutex
struct CurvatureNotes {
    /// Fits of one radius, at points spread evenly over the object. All of this is by rank along the curve of the
    /// index.
    struct Level {
        std::vector<bool>                        isSite;
        std::unordered_map<std::uint32_t, float> share; ///< points that each site stands for [1]
        /// Empty where the points around determine none. Their normals are on either side of the surface.
        std::unordered_map<std::uint32_t, std::optional<LocalCurvature>> fits;
    };

    std::mutex mutex;
    std::map<std::pair<int, bool>, Level>
        levels; ///< by their place on the ladder of radii, and whether they are a survey's
};

} // namespace palp
