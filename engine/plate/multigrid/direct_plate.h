#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "engine/plate/footprint.h"
#include "engine/plate/plate.h"
#include "engine/plate/plate_solver.h"

namespace palp {

/// Solves for many footprints on a small plate whose rigidity jumps by a factor of its whole matrix, on the host and in
/// doubles. That takes the same time whatever the rigidity, where multigrid takes steps for each load that a jump makes
/// more and dearer.
///
/// A footprint and what it feels are on the same few nodes. So only those fronts are solved that hold these nodes, and
/// those that hold the borders of such fronts: a third of all work.
/// \thread one at a time
/// \source George 1973 (nested dissection); Gilbert & Peierls 1988 (solves that follow what is not zero)
class DirectPlate {
public:
    /// Returns whether it takes less time than multigrid for so many footprints together, as it was measured on plates
    /// of 33 to 129 nodes a side.
    [[nodiscard]] static bool pays(const Plate& plate, std::size_t footprints);

    /// Divides the nodes of a grid; all but the values of rigidity and foundation are for good.
    explicit DirectPlate(const Plate& plate);
    ~DirectPlate();
    DirectPlate(DirectPlate&&) noexcept;
    DirectPlate& operator=(DirectPlate&&) noexcept;

    [[nodiscard]] bool suits(const Plate& plate) const; ///< whether solve() can take it

    /// \param whole  index of the load whose deflection is wanted, and of which the report is
    /// \param error  that it may have, relative in the energy norm, as a step of refinement tells it [1]
    /// \return nothing if it has more, if a number is not finite, or if rounding hides how a part of the plate is held
    /// \throws Error if whyUnsolvable() refuses the rigidity
    [[nodiscard]] std::optional<FootprintSolution> solve(const Plate& plate, std::span<const Footprint> footprints,
                                                         std::size_t whole, double error);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
