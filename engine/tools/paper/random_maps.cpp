#include "engine/tools/paper/random_maps.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace palp::report {
namespace {

/// The position, 0 to 1 along the logarithm of the contrast, of a place on the unit square [1].
using Field = std::function<double(double x, double z)>;

Field waves(Uniform& uniform)
{
    struct Wave {
        double x, z, phase;
    };
    constexpr double  kMost = 4; // whole waves across the plate
    std::vector<Wave> all(6);
    for (Wave& wave : all)
        wave = {2 * std::numbers::pi * uniform(-kMost, kMost), 2 * std::numbers::pi * uniform(-kMost, kMost),
                uniform(0, 2 * std::numbers::pi)};
    return [all](double x, double z) {
        double sum = 0;
        for (const Wave& wave : all) sum += std::cos(wave.x * x + wave.z * z + wave.phase);
        return sum;
    };
}

Field inclusions(Uniform& uniform)
{
    struct Disc {
        double x, z, radius, value;
    };
    std::vector<Disc> all(std::size_t(uniform(1, 6)));
    for (Disc& disc : all) disc = {uniform(), uniform(), uniform(0.05, 0.3), uniform() < 0.5 ? 0.0 : 1.0};
    const double ground = uniform() < 0.5 ? 0.5 : 1 - all.back().value;
    return [all, ground](double x, double z) {
        double value = ground;
        for (const Disc& disc : all)
            if (std::hypot(x - disc.x, z - disc.z) < disc.radius) value = disc.value;
        return value;
    };
}

Field checkers(Uniform& uniform)
{
    constexpr int       kSide = 8; // blocks a side
    std::vector<double> values(kSide * kSide);
    for (double& value : values) value = uniform();
    return [values](double x, double z) {
        const auto at = [](double t) { return std::min(int(t * kSide), kSide - 1); };
        return values[std::size_t(at(x) * kSide + at(z))];
    };
}

Field fieldOf(MapKind kind, Uniform& uniform)
{
    switch (kind) {
    case MapKind::smooth:
        return waves(uniform);
    case MapKind::discs:
        return inclusions(uniform);
    case MapKind::blocks:
        return checkers(uniform);
    case MapKind::rough:
        break;
    }
    return [&uniform](double, double) { return uniform(); };
}

} // namespace

NodeField randomMap(MapKind kind, const PlateGrid& grid, double contrast, Uniform& uniform)
{
    const Field field = fieldOf(kind, uniform);
    NodeField   map(grid);
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) map(i, j) = field(double(i) / grid.cellsX, double(j) / grid.cellsZ);
    const auto [least, most] = std::minmax_element(map.values().begin(), map.values().end());
    const double low = *least, span = *most - *least;
    for (double& value : map.values()) value = std::pow(contrast, span > 0 ? (value - low) / span : 0);
    return map;
}

} // namespace palp::report
