#include "engine/plate/plate_trial.h"

#include <cmath>

#include "engine/plate/load.h"

namespace palp {

PlateTrial plateTrial(int cells, int loads, double tolerance)
{
    constexpr double kSize = 0.04, kRadius = 0.004, kApart = 0.001; // a fingertip in a usual patch window [m]
    PlateTrial       trial;
    trial.tolerance      = tolerance;
    trial.plate.grid     = {cells, cells, kSize / cells, kSize / cells};
    trial.plate.rigidity = NodeField(trial.plate.grid);
    for (int i = 0; i <= cells; ++i)
        for (int j = 0; j <= cells; ++j) trial.plate.rigidity(i, j) = 1 + 9.0 * i / cells;
    const int side = int(std::ceil(std::sqrt(double(loads))));
    for (int n = 0; n < loads; ++n)
        trial.loads.emplace_back(footprintLoad(trial.plate.grid, 1, kSize / 2 + kApart * (n / side - (side - 1) / 2.0),
                                               kSize / 2 + kApart * (n % side - (side - 1) / 2.0), kRadius));
    return trial;
}

} // namespace palp
