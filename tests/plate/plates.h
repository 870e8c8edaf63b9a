#pragma once
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "engine/plate/load.h"
#include "engine/plate/reference/reference_plate_solver.h"
#include "tests/plate/reference_values.h"
#include "tests/support/errors.h"

// Plates and loads that several tests share.

namespace palp::reference {

inline double rigidityOf(Law law, double x, double z)
{
    const auto wart = [&](double cx, double cz) {
        constexpr double kDeviation = 0.1; // [m]
        return std::exp(-((x - cx) * (x - cx) + (z - cz) * (z - cz)) / (2 * kDeviation * kDeviation));
    };
    switch (law) {
    case Law::linear:
        return 1 + 9 * x;
    case Law::bilinear:
        return 1 + 9 * x * z;
    case Law::hyperbolic:
        return 10 / (1 + 9 * x);
    case Law::wartCentred:
        return 1 + 9 * wart(0.5, 0.5);
    case Law::wartOffCentre:
        return 1 + 99 * wart(0.4, 0.55);
    case Law::box:
        return std::abs(x - 0.5) <= 0.125 && std::abs(z - 0.5) <= 0.125 ? 10 : 1;
    }
    return 0;
}

inline const char* name(Law law)
{
    constexpr std::array kNames = {"Linear", "Bilinear", "Hyperbolic", "WartCentred", "WartOffCentre", "Box"};
    return kNames[std::size_t(law)];
}

/// Where a load presses on a single node [m].
inline std::optional<std::array<double, 2>> loadedPoint(Load load)
{
    switch (load) {
    case Load::point:
        return {{0.25, 0.375}};
    case Load::pointCentre:
        return {{0.5, 0.5}};
    case Load::pointCorner:
        return {{0.25, 0.25}};
    case Load::pointBeside:
        return {{0.375, 0.5}};
    case Load::pointOnEdge:
        return {{1, 0.5}};
    default:
        return std::nullopt;
    }
}

inline NodeField nodalForce(const PlateGrid& grid, Load load)
{
    if (const auto at = loadedPoint(load)) return pointLoad(grid, 1, (*at)[0], (*at)[1]);
    if (load == Load::uniform) return uniformLoad(grid, 1);
    if (load == Load::gaussian) return gaussianLoad(grid, 1, 0.25, 0.375, 0.05);
    if (load == Load::gaussianCentre) return gaussianLoad(grid, 1, 0.5, 0.5, 0.05);
    NodeField pressure(grid); // hydrostatic
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) pressure(i, j) = i * grid.spacingX;
    return gridLoad(grid, pressure);
}

inline const char* name(Load load)
{
    constexpr std::array kNames = {"uniform",     "gaussian",    "gaussianCentre", "point",      "hydrostatic",
                                   "pointCentre", "pointCorner", "pointBeside",    "pointOnEdge"};
    return kNames[std::size_t(load)];
}

inline PlateEdges edgesOf(Sides sides)
{
    using enum Edge;
    switch (sides) {
    case Sides::clamped:
        return {clamped, clamped, clamped, clamped};
    case Sides::supported:
        return {supported, supported, supported, supported};
    case Sides::bridge:
        return {free, free, supported, supported};
    case Sides::cantilever:
        return {clamped, free, free, free};
    }
    return {};
}

/// A plate of rigidity(x, z) [N m] on a rectangle.
template <class Rigidity>
Plate makePlate(int cellsX, int cellsZ, double sizeX, double sizeZ, const PlateEdges& edges, double poissonRatio,
                const Rigidity& rigidity)
{
    Plate plate;
    plate.grid         = {cellsX, cellsZ, sizeX / cellsX, sizeZ / cellsZ};
    plate.edges        = edges;
    plate.poissonRatio = poissonRatio;
    plate.rigidity     = NodeField(plate.grid);
    for (int i = 0; i <= cellsX; ++i)
        for (int j = 0; j <= cellsZ; ++j)
            plate.rigidity(i, j) = rigidity(i * plate.grid.spacingX, j * plate.grid.spacingZ);
    return plate;
}

inline Plate unitSquare(int cells, const PlateEdges& edges = {}, double poissonRatio = 0.3)
{
    return makePlate(cells, cells, 1, 1, edges, poissonRatio, [](double, double) { return 1.0; });
}

/// Deflections at some places on three grids, each twice as fine as the one before, beside their limits.
struct Refinement {
    std::vector<double>                limits; ///< [m]
    std::array<std::vector<double>, 3> values; ///< [m] coarse to fine

    void append(const Refinement& other, std::size_t k)
    {
        limits.push_back(other.limits[k]);
        for (std::size_t grid = 0; grid < values.size(); ++grid) values[grid].push_back(other.values[grid][k]);
    }

    /// The limit that second-order convergence of the two finer grids foretells.
    [[nodiscard]] double richardson(std::size_t k) const { return values[2][k] + (values[2][k] - values[1][k]) / 3; }

    /// Largest error of the extrapolated values over the largest limit [1].
    [[nodiscard]] double richardsonError() const
    {
        double most = 0;
        for (std::size_t k = 0; k < limits.size(); ++k) most = worse(most, richardson(k) - limits[k]);
        return most / size();
    }

    /// Largest error on one grid over the largest limit [1].
    [[nodiscard]] double error(std::size_t grid) const
    {
        double most = 0;
        for (std::size_t k = 0; k < limits.size(); ++k) most = worse(most, values[grid][k] - limits[k]);
        return most / size();
    }

    /// Order of the error in the spacing between a grid and the next finer one; 0 if the coarser one has no answer.
    [[nodiscard]] double order(std::size_t coarser) const
    {
        const double before = error(coarser);
        return std::isfinite(before) ? std::log2(before / error(coarser + 1)) : 0;
    }

    [[nodiscard]] double size() const { return largest(limits); }
};

} // namespace palp::reference
