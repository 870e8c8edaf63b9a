#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace palp {

/// Cubes over some thousand points, to search among only these. Built and searched in a fraction of a millisecond.
/// \thread one; allocates only if it has not had as many points or cubes before
class PointGrid {
public:
    /// Sorts the places into cubes.
    /// \param places  finite [m], at least one
    /// \param edge    of the cubes [m], >= 0; they are larger if they were too many. The radius of the searches suits.
    void build(std::span<const glm::dvec3> places, double edge);

    /// Calls visit(index of the place, squared distance [m^2]) for the places within `radius` [m] of `place`, in an
    /// order that depends on nothing but the places and theirs. A place for which `visit` returns true is taken out: no
    /// search finds it again until build().
    template <class Visit>
    void takeNear(const glm::dvec3& place, double radius, Visit&& visit)
    {
        eachCube(*this, place, radius, [&](Cube& cube) {
            for (std::uint32_t k = cube.begin; k < cube.end;) {
                const Entry& entry = entries_[k];
                const double d2    = squaredDistance(entry.place, place);
                if (d2 <= radius * radius && visit(std::size_t(entry.index), d2))
                    entries_[k] = entries_[--cube.end];
                else
                    ++k;
            }
        });
    }

    /// Does the same for all places in the cubes that the ball meets, also those outside of it: omitting these would
    /// cost more than it saves where nothing has to be done for them.
    template <class Visit>
    void around(const glm::dvec3& place, double radius, Visit&& visit) const
    {
        eachCube(*this, place, radius, [&](const Cube& cube) {
            for (std::uint32_t k = cube.begin; k < cube.end; ++k)
                visit(std::size_t(entries_[k].index), squaredDistance(entries_[k].place, place));
        });
    }

private:
    using Cells = std::array<int, 3>; ///< along each axis

    struct Entry {
        glm::dvec3    place; ///< [m]
        std::uint32_t index;
    };

    struct Cube {
        std::uint32_t begin = 0, end = 0; ///< in entries_
    };

    [[nodiscard]] Cells cellsOf(const glm::dvec3& place, double offset) const noexcept
    {
        const auto along = [&](int k) {
            const double cell = (place[k] + offset - low_[k]) * perMetre_;
            return int(std::clamp(cell, 0.0, double(cells_[std::size_t(k)] - 1)));
        };
        return {along(0), along(1), along(2)};
    }

    [[nodiscard]] static double squaredDistance(const glm::dvec3& a, const glm::dvec3& b) noexcept
    {
        const glm::dvec3 d = a - b;
        return d.x * d.x + d.y * d.y + d.z * d.z;
    }

    /// Visits the cubes around a place.
    /// \param grid  this one, const or not, as its cubes are for `visit`
    template <class Grid, class Visit>
    static void eachCube(Grid& grid, const glm::dvec3& place, double radius, const Visit& visit)
    {
        const Cells low = grid.cellsOf(place, -radius), high = grid.cellsOf(place, radius);
        for (int z = low[2]; z <= high[2]; ++z)
            for (int y = low[1]; y <= high[1]; ++y)
                for (int x = low[0]; x <= high[0]; ++x)
                    visit(grid.cubes_[std::size_t((z * grid.cells_[1] + y) * grid.cells_[0] + x)]);
    }

    glm::dvec3                 low_{};          ///< [m]
    double                     perMetre_ = 0;   ///< cubes per metre
    Cells                      cells_{1, 1, 1}; ///< cubes
    std::vector<Cube>          cubes_;
    std::vector<Entry>         entries_; ///< cube by cube
    std::vector<std::uint32_t> cubeAt_;  ///< of each place
};

} // namespace palp
