#include "engine/tools/bench/bench_plates.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/core/contract.h"
#include "engine/plate/load.h"

namespace palp::bench {

double rigidityAt(std::string_view law, double contrast, double x, double z)
{
    if (law == "linear") return 1 + (contrast - 1) * x;
    if (law == "hyperbolic") return 1 / (1 - (1 - 1 / contrast) * x);
    if (law == "wart") return 1 + (contrast - 1) * std::exp(-50 * ((x - 0.5) * (x - 0.5) + (z - 0.5) * (z - 0.5)));
    if (law == "disc") return std::hypot(x - 0.45, z - 0.55) < 0.2 ? contrast : 1;
    if (law == "discs")
        return std::hypot(x - 0.32, z - 0.55) < 0.15 ? 100 : std::hypot(x - 0.7, z - 0.45) < 0.15 ? 0.1 : 1;
    throw Error("--law: unknown name \"" + std::string(law) + "\"; known: linear, hyperbolic, wart, disc, discs");
}

Plate plateOf(std::string_view law, double contrast, int nodes)
{
    constexpr double kSize = 40e-3; // [m]
    const int        cells = nodes - 1;
    Plate            plate;
    plate.grid     = {cells, cells, kSize / cells, kSize / cells};
    plate.rigidity = NodeField(plate.grid);
    for (int i = 0; i < nodes; ++i)
        for (int j = 0; j < nodes; ++j)
            plate.rigidity(i, j) = kSoftest * rigidityAt(law, contrast, double(i) / cells, double(j) / cells);
    return plate;
}

const std::vector<Map>& maps()
{
    static const std::vector<Map> all{{"linear", "linear", 10, true},   {"hyperbolic", "hyperbolic", 10, true},
                                      {"wart", "wart", 100, true},      {"disc_100", "disc", 100, false},
                                      {"disc_0.1", "disc", 0.1, false}, {"disc_1000", "disc", 1000, false},
                                      {"disc_1e5", "disc", 1e5, false}, {"discs", "discs", 1000, false}};
    return all;
}

const Map& mapNamed(std::string_view name)
{
    for (const Map& map : maps())
        if (map.name == name) return map;
    throw Error("unknown map \"" + std::string(name) + "\"");
}

Plate plateOf(const Map& map, int nodes)
{
    return plateOf(map.law, map.contrast, nodes);
}

NodeField fingertip(const PlateGrid& grid, double x, double z)
{
    return footprintLoad(grid, 1, x * grid.sizeX(), z * grid.sizeZ(), std::max(4e-3, 1.5 * grid.spacingX));
}

} // namespace palp::bench
