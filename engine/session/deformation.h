#pragma once
#include <optional>
#include <string>

#include "engine/session/servo.h"

namespace palp {

/// The slow half of a session: from a touch to the patch and the table of compliances for where it will be.
/// \thread one at a time, together with its device
class Deformation {
public:
    /// Opens the scene's device and solves the homogeneous window, some tenths of a second.
    /// \param cloud, index  outlive it
    /// \throws Error as PlateDevice and footprintLattice() do
    Deformation(const PointCloud& cloud, const NeighbourIndex& index, const Scene& scene);

    /// Solves for the touch, 1.5 periods ahead of its motion. Off the object, or where the points determine no surface,
    /// for the touch itself; if that fails too there is no news, and why() says so.
    /// \param period  of the deformation, as measured [s]
    [[nodiscard]] std::optional<PatchNews> solve(const Touch& touch, double period);

    [[nodiscard]] const std::string&          why() const noexcept { return why_; } ///< the last failure; may be empty
    [[nodiscard]] const std::optional<Patch>& patch() const noexcept { return patch_; } ///< the last one
    [[nodiscard]] const PlateDevice&          device() const noexcept { return device_; }

private:
    [[nodiscard]] std::optional<PatchNews> solveAt(const glm::dvec3& place, const Touch& touch);

    const PointCloud&     cloud_;
    const NeighbourIndex& index_;
    HandOverLaw           law_;
    PatchSettings         settings_; ///< with the frame of the last patch
    PlateDevice           device_;
    FootprintLattice      lattice_;
    std::optional<Patch>  patch_;
    std::string           why_;
};

} // namespace palp
