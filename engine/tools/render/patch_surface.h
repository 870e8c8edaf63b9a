#pragma once
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/pipeline/patch.h"

namespace palp {

/// The parts of a patch's picture that no force changes: made once for each answer of the plate, not for each frame.
struct PatchSurface {
    /// A place on the window's edge.
    struct EdgePlace {
        glm::dvec3 rest{};           ///< [m]
        double     response = 0;     ///< deflection per force there [m/N]
        bool       starts   = false; ///< no line comes from the place before, because no surface lies between them
    };

    std::vector<std::uint32_t> moving;      ///< points of the cloud that a force moves notably
    std::size_t                sloping = 0; ///< number of them, from the first, whose slope is visible
    std::vector<double>        responses;   ///< as many: deflection per force [m/N]
    std::vector<double>        hollows;     ///< as many: how far the surroundings rise above the dent, per force [1/N]
    std::vector<EdgePlace>     edge;        ///< once around
    double                     mostResponse = 0; ///< [m/N] of the grid's nodes
    glm::dvec3                 inward{};         ///< unit vector along which everything moves [1]

    PatchSurface() = default;
    /// \param positions  of the cloud at rest [m]
    /// \param cueRadius  of the surroundings that tell hollows from humps [m]
    PatchSurface(const Patch& patch, std::span<const glm::dvec3> positions, double cueRadius);
};

} // namespace palp
