#include "engine/cloud/point_grid.h"

#include <cmath>

#include <glm/common.hpp>

namespace palp {
namespace {

/// Cubes along the longest side at most: as many as a disc of a thousand points needs; more would cost more to clear
/// than they save.
constexpr double kMostCells = 32;

} // namespace

std::array<int, 3> PointGrid::cellOf(const glm::dvec3& place) const noexcept
{
    std::array<int, 3> cell{};
    for (int k = 0; k < 3; ++k)
        cell[std::size_t(k)] = std::clamp(int((place[k] - low_[k]) * perMetre_), 0, cells_[std::size_t(k)] - 1);
    return cell;
}

void PointGrid::build(std::span<const glm::dvec3> places, double reach)
{
    places_         = places;
    glm::dvec3 high = places[0];
    low_            = places[0];
    for (const glm::dvec3& p : places) {
        low_ = glm::min(low_, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 size = high - low_;
    const double     edge = std::max(reach, std::max({size.x, size.y, size.z}) / kMostCells); // [m]
    perMetre_             = edge > 0 ? 1 / edge : 0;
    for (int k = 0; k < 3; ++k) cells_[std::size_t(k)] = int(std::min(size[k] * perMetre_, kMostCells)) + 1;

    grid_.assign(std::size_t(cells_[0]) * std::size_t(cells_[1]) * std::size_t(cells_[2]), {});
    cellAt_.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto [x, y, z] = cellOf(places[i]);
        cellAt_[i]           = std::uint32_t((z * cells_[1] + y) * cells_[0] + x);
        ++grid_[cellAt_[i]].end; // as a count
    }
    std::uint32_t next = 0;
    for (Cell& cell : grid_) {
        cell.begin = next;
        next += cell.end;
        cell.end = cell.begin;
    }
    order_.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) order_[grid_[cellAt_[i]].end++] = std::uint32_t(i);
}

} // namespace palp
