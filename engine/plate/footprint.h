#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/core/grid.h"

namespace palp {

/// A load on few nodes, and how it changes as it moves: the pressure of a fingertip.
struct Footprint {
    /// The load of one node.
    struct Part {
        std::uint32_t node    = 0; ///< its index among NodeField::values()
        double        force   = 0; ///< [N]
        double        changeX = 0; ///< of the force as the footprint moves along x [N/m]
        double        changeZ = 0; ///< along z [N/m]
    };

    std::vector<Part> parts{}; ///< nodes ascending

    Footprint() = default;
    /// Takes the nodes at which the load is not 0; it does not move.
    explicit Footprint(const NodeField& load);
    /// Takes the nodes at which any of these fields is not 0; the fields lie on one grid.
    Footprint(const NodeField& load, const NodeField& changeX, const NodeField& changeZ);

    [[nodiscard]] NodeField load(const PlateGrid& grid) const; ///< [N]
};

/// What a footprint feels of its own deflection w.
struct FootprintResponse {
    double work    = 0; ///< of the load along w [N m]; for a load of 1 N the compliance [m/N]
    double changeX = 0; ///< work of the changes along w: half of what `work` changes as the footprint moves [N]
    double changeZ = 0; ///< along z [N]
    double curved  = 0; ///< of the moments along what else bends a curved object, see CurvedBending [N m]
};

/// Returns the response from a deflection [m].
[[nodiscard]] FootprintResponse responseOf(const Footprint& footprint, const NodeField& deflection);

} // namespace palp
