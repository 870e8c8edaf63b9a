#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/plate/point_buckets.h"
#include "tests/plate/kernels/host_passes.h"

// Points over grids, with what goes wrong where points and nodes meet; and the kernels between them as C++.

namespace palp {

struct PointScene {
    std::string             name;
    PlateGrid               grid;
    ChartPoint              corner;
    std::vector<ChartPoint> positions;
    std::vector<double>     rigidities{}; ///< all different, contrast up to 1000 [N m]
    double                  spacing = 0;
    bool                    dyadic  = false; ///< positions and grid are such that floats round nothing

    static constexpr double kUnit = 0.9; ///< near the largest one [N m]

    [[nodiscard]] PlatePoints  points() const { return {positions, rigidities, corner, spacing, kUnit}; }
    [[nodiscard]] PointBuckets buckets() const { return bucketPoints(grid, points()); }

    [[nodiscard]] double distance(int i, int j, std::size_t point) const
    {
        return std::hypot(positions[point].x - corner.x - i * grid.spacingX,
                          positions[point].z - corner.z - j * grid.spacingZ);
    }

    /// Number of the point that gave a node its rigidity.
    [[nodiscard]] std::size_t pointOf(float rigidity) const
    {
        for (std::size_t n = 0; n < rigidities.size(); ++n)
            if (float(rigidities[n] / kUnit) == rigidity) return n;
        return rigidities.size();
    }
};

inline void giveRigidities(PointScene& scene)
{
    const std::vector<double> rough = roughValues<double>(scene.positions.size(), 90);
    for (const double value : rough) scene.rigidities.push_back(0.9 * std::pow(1000, 0.5 * (value - 1)));
}

/// Points at random, in fractions of the grid's size from its corner.
inline PointScene scatteredScene(const std::string& name, const PlateGrid& grid, std::size_t points, ChartPoint from,
                                 ChartPoint to)
{
    const std::vector<double> at = roughValues<double>(2 * points, std::uint32_t(points) + 91);
    PointScene                scene{name, grid, {-0.4 * grid.sizeX(), 3 * grid.sizeZ()}, {}};
    for (std::size_t n = 0; n < points; ++n) {
        const double x = from.x + (to.x - from.x) * (at[2 * n] + 1) / 2;
        const double z = from.z + (to.z - from.z) * (at[2 * n + 1] + 1) / 2;
        scene.positions.push_back({scene.corner.x + x * grid.sizeX(), scene.corner.z + z * grid.sizeZ()});
    }
    scene.spacing = std::sqrt(grid.sizeX() * grid.sizeZ() * (to.x - from.x) * (to.z - from.z) / double(points));
    return scene;
}

/// Three points at every third place; many nodes are equally far from several places.
inline PointScene latticeScene(int cellsX, int cellsZ)
{
    PointScene scene{"a lattice of triples", {cellsX, cellsZ, 0.25, 0.25}, {-2, 1}, {}};
    for (int copy = 0; copy < 3; ++copy)
        for (int i = -3; i <= cellsX + 3; i += 3)
            for (int j = cellsZ + 3; j >= -3; j -= 3)
                scene.positions.push_back({-2 + 0.25 * (i + 0.5), 1 + 0.25 * (j - 0.5)});
    scene.spacing = 0.5;
    scene.dyadic  = true;
    return scene;
}

/// \param small  for checks that take long
inline std::vector<PointScene> pointScenes(bool small)
{
    const PlateGrid         wide{9, 14, 0.002, 0.0026}, tall{small ? 12 : 41, 6, 0.5, 0.3};
    std::vector<PointScene> scenes;
    const auto add = [&](const std::string& name, const PlateGrid& grid, std::size_t points, ChartPoint from,
                         ChartPoint to) -> PointScene& {
        return scenes.emplace_back(scatteredScene(name, grid, points, from, to));
    };
    add("all over the grid and beyond", wide, 300, {-0.3, -0.2}, {1.2, 1.3});
    add("sparse", tall, 31, {-0.1, -0.1}, {1.1, 1.1});
    add("one point", tall, 1, {0.6, 0.2}, {0.7, 0.3});
    add("in one corner", wide, 200, {0.97, 0}, {1, 0.02});
    add("beyond one side", tall, 60, {-5, 0.2}, {-0.3, 0.9});
    add("far beyond a corner", wide, 40, {3, 4}, {7, 5});
    add("apart on all sides", wide, 12, {-4, -4}, {5, 5});

    PointScene& hole = add("around a hole", wide, 500, {-0.2, -0.2}, {1.2, 1.2});
    std::erase_if(hole.positions, [&](const ChartPoint& p) {
        return std::abs(p.x - hole.corner.x - 0.4 * wide.sizeX()) < 0.3 * wide.sizeX() &&
               std::abs(p.z - hole.corner.z - 0.5 * wide.sizeZ()) < 0.3 * wide.sizeZ();
    });
    PointScene& crowd = add("a crowd and three others", wide, 400, {0.5, 0.5}, {0.5001, 0.5001});
    crowd.spacing     = 0.0029; // with 0.003 points lie on the sides of squares, and rounding decides
    for (const ChartPoint p : {ChartPoint{0, 0.9}, {0.1, 0}, {1, 1}})
        crowd.positions.push_back({crowd.corner.x + p.x * wide.sizeX(), crowd.corner.z + p.z * wide.sizeZ()});
    scenes.push_back(latticeScene(small ? 8 : 19, small ? 7 : 34));
    for (PointScene& scene : scenes) giveRigidities(scene);
    return scenes;
}

namespace host {

/// What the kernels that sample write.
struct Sampled {
    std::vector<float>         rigidity; ///< [unit]
    std::vector<std::uint32_t> without;

    explicit Sampled(std::size_t nodes) : rigidity(nodes), without(nodes) {}
    explicit Sampled(const PointLayout& g) : Sampled(std::size_t(g.cellsX + 1) * std::size_t(g.cellsZ + 1)) {}
};

inline Sampled nearestSampled(const PointBuckets& from)
{
    const PointLayout& g = from.layout;
    Sampled            all(g);
    Sample             sample{from.starts.data(), from.points.data()};
    for (int i = 0, n = 0; i <= g.cellsX; ++i)
        for (int j = 0; j <= g.cellsZ; ++j, ++n) {
            const auto nearest           = sample.nearestPoint(g, i, j);
            all.rigidity[std::size_t(n)] = from.points[std::size_t(nearest.at)].rigidity;
            all.without[std::size_t(n)]  = nearest.distance2 > g.nearby2;
        }
    return all;
}

inline Sampled logMeanSampled(const PointBuckets& from)
{
    const PointLayout& g = from.layout;
    Sampled            all(g);
    Sample             sample{from.starts.data(), from.points.data()};
    for (int i = 0, n = 0; i <= g.cellsX; ++i)
        for (int j = 0; j <= g.cellsZ; ++j, ++n) {
            const auto mean    = sample.logMeanAt(g, i, j);
            const int  nearest = sample.nearestPoint(g, i, j).at;
            all.rigidity[std::size_t(n)] =
                mean.weight > 0 ? exp(mean.logarithm / mean.weight) : from.points[std::size_t(nearest)].rigidity;
            all.without[std::size_t(n)] = mean.nearest2 > g.nearby2;
        }
    return all;
}

template <class Real>
std::vector<float> lifted(const PointBuckets& from, const std::vector<Real>& answer, const std::vector<float>& metres)
{
    const PointLayout& g     = from.layout;
    const std::size_t  nodes = Sampled(g).rigidity.size();
    std::vector<float> w(metres.size() * from.points.size());
    for (std::size_t load = 0; load < metres.size(); ++load) {
        Lift<Real> lift{answer.data() + load * nodes, g.cellsZ + 1};
        for (const ScatteredPoint& p : from.points)
            w[load * from.points.size() + p.number] = float(lift.liftedAt(g, p.x, p.z)) * metres[load];
    }
    return w;
}

} // namespace host
} // namespace palp
