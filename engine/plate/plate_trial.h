#pragma once
#include <vector>

#include "engine/plate/footprint.h"
#include "engine/plate/plate.h"

namespace palp {

/// A plate and loads like those of a session, on which processors are compared.
struct PlateTrial {
    Plate                  plate;
    std::vector<Footprint> loads;
    double                 tolerance; ///< [1]
    double                 apart = 0; ///< from the end of a solve to the next [s]: a GPU that waits lowers its clock
};

/// Returns a square plate, clamped, of a smooth map of contrast 10, and footprints near its middle.
/// \param cells  a side
/// \param loads  at least 1
[[nodiscard]] PlateTrial plateTrial(int cells, int loads, double tolerance = 1e-4);

} // namespace palp
