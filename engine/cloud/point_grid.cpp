#include "engine/cloud/point_grid.h"

#include <cmath>

#include <glm/common.hpp>

namespace palp {
namespace {

/// Returns how many cubes along a side the points of a disc need, of two spacings each; a sphere's need a third of
/// that.
int alongFor(std::size_t points)
{
    constexpr double kFewest = 32, kMost = 128;
    return int(std::clamp(std::sqrt(double(points)) / 2, kFewest, kMost));
}

} // namespace

void PointGrid::build(std::span<const glm::dvec3> places, double edge, int mostAlong)
{
    glm::dvec3 high = places[0];
    low_            = places[0];
    for (const glm::dvec3& p : places) {
        low_ = glm::min(low_, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 size = high - low_;
    if (mostAlong <= 0) mostAlong = alongFor(places.size());
    const double larger = std::max(edge, std::max({size.x, size.y, size.z}) / mostAlong); // [m]
    perMetre_           = larger > 0 ? 1 / larger : 0;
    for (int k = 0; k < 3; ++k) cells_[std::size_t(k)] = int(std::min(size[k] * perMetre_, double(mostAlong))) + 1;

    cubes_.assign(std::size_t(cells_[0]) * std::size_t(cells_[1]) * std::size_t(cells_[2]), {});
    cubeAt_.resize(places.size());
    filled_.assign(wordsOfRow() * std::size_t(cells_[1]) * std::size_t(cells_[2]), 0);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto [x, y, z] = cellsOf(places[i], 0);
        const int row        = z * cells_[1] + y;
        cubeAt_[i]           = std::uint32_t(row * cells_[0] + x);
        filled_[std::size_t(row) * wordsOfRow() + std::size_t(x / kBits)] |= Word(1) << (x % kBits);
        ++cubes_[cubeAt_[i]].end; // as a count
    }
    std::uint32_t next = 0;
    for (Cube& cube : cubes_) {
        cube.begin = next;
        next += cube.end;
        cube.end = cube.begin;
    }
    entries_.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) entries_[cubes_[cubeAt_[i]].end++] = {places[i], std::uint32_t(i)};
}

} // namespace palp
