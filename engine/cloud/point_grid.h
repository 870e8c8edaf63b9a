#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace palp {

/// Cubes over some thousand points, for searches among only these. Built and searched in a fraction of a millisecond.
/// \thread one; allocates only where it has not had as many points or cubes before
class PointGrid {
public:
    /// \param places  finite [m], at least one; must live as long as they are searched
    /// \param reach   largest radius of a search [m], >= 0
    void build(std::span<const glm::dvec3> places, double reach);

    /// Calls visit(index of the place, squared distance [m^2]) for the places within `radius` [m] of one of them, in an
    /// order that depends on nothing but the places and theirs. A place for which `visit` says true is not found again
    /// until build(). \param radius  [m], at most the reach
    template <class Visit>
    void near(const glm::dvec3& place, double radius, Visit&& visit)
    {
        const std::array<int, 3> cell = cellOf(place);
        for (int z = std::max(cell[2] - 1, 0); z <= std::min(cell[2] + 1, cells_[2] - 1); ++z)
            for (int y = std::max(cell[1] - 1, 0); y <= std::min(cell[1] + 1, cells_[1] - 1); ++y)
                for (int x = std::max(cell[0] - 1, 0); x <= std::min(cell[0] + 1, cells_[0] - 1); ++x)
                    nearInCell(std::size_t((z * cells_[1] + y) * cells_[0] + x), place, radius * radius, visit);
    }

private:
    struct Cell {
        std::uint32_t begin = 0, end = 0; ///< in order_
    };

    [[nodiscard]] std::array<int, 3> cellOf(const glm::dvec3& place) const noexcept;

    template <class Visit>
    void nearInCell(std::size_t number, const glm::dvec3& place, double radius2, Visit&& visit)
    {
        Cell& cell = grid_[number];
        for (std::uint32_t k = cell.begin; k < cell.end;) {
            const std::uint32_t i  = order_[k];
            const glm::dvec3    d  = places_[i] - place;
            const double        d2 = d.x * d.x + d.y * d.y + d.z * d.z;
            if (d2 <= radius2 && visit(std::size_t(i), d2))
                order_[k] = order_[--cell.end];
            else
                ++k;
        }
    }

    std::span<const glm::dvec3> places_;
    glm::dvec3                  low_{};          ///< [m]
    double                      perMetre_ = 0;   ///< cubes per metre
    std::array<int, 3>          cells_{1, 1, 1}; ///< along each axis
    std::vector<Cell>           grid_;
    std::vector<std::uint32_t>  order_;  ///< indices of places, cube by cube
    std::vector<std::uint32_t>  cellAt_; ///< cube of each place
};

} // namespace palp
