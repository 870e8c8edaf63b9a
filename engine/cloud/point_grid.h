#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
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
    /// \param mostAlong  most cubes along the longest side; where it is 0 as many as the points need that lie on a
    ///                   surface: more cost more to clear than they save
    void build(std::span<const glm::dvec3> places, double edge, int mostAlong = 0);

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

    /// Appends the indices of the places within `radius` [m] of `place`. Only before any is taken out.
    void findNear(const glm::dvec3& place, double radius, std::vector<std::uint32_t>& found) const
    {
        const Cells  low = cellsOf(place, -radius), high = cellsOf(place, radius);
        std::size_t  count   = found.size();
        const double radius2 = radius * radius;
        const double x = place.x, y = place.y, z = place.z;
        for (int k = low[2]; k <= high[2]; ++k)
            for (int j = low[1]; j <= high[1]; ++j) {
                // The cubes of a row follow each other, and so do their places.
                const auto          row   = std::size_t((k * cells_[1] + j) * cells_[0]);
                const std::uint32_t begin = cubes_[row + std::size_t(low[0])].begin;
                const std::uint32_t end   = cubes_[row + std::size_t(high[0])].end;
                if (begin == end) continue;
                found.resize(count + (end - begin));
                // Every index is written, and counted if it is wanted: a branch that nobody can foresee costs more.
                std::uint32_t* to = found.data() + count;
                for (const Entry *e = entries_.data() + begin, *last = entries_.data() + end; e != last; ++e) {
                    const double dx = e->place.x - x, dy = e->place.y - y, dz = e->place.z - z;
                    *to = e->index;
                    to += dx * dx + dy * dy + dz * dz <= radius2;
                }
                count = std::size_t(to - found.data());
            }
        found.resize(count);
    }

private:
    using Cells                = std::array<int, 3>; ///< along each axis
    using Word                 = std::uint64_t;
    static constexpr int kBits = 64;

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

    /// Visits the cubes around a place in which there is anything.
    /// \param grid  this one, const or not, as its cubes are for `visit`
    template <class Grid, class Visit>
    static void eachCube(Grid& grid, const glm::dvec3& place, double radius, const Visit& visit)
    {
        const Cells low = grid.cellsOf(place, -radius), high = grid.cellsOf(place, radius);
        for (int z = low[2]; z <= high[2]; ++z)
            for (int y = low[1]; y <= high[1]; ++y) {
                const auto row    = std::size_t(z * grid.cells_[1] + y);
                auto*      filled = grid.filled_.data() + row * grid.wordsOfRow();
                for (int x = low[0]; x <= high[0]; ++x) {
                    const Word left = filled[x / kBits] >> (x % kBits);
                    x               = left == 0 ? x | (kBits - 1) : x + std::countr_zero(left);
                    if (left == 0 || x > high[0]) continue;
                    auto& cube = grid.cubes_[row * std::size_t(grid.cells_[0]) + std::size_t(x)];
                    visit(cube);
                    if constexpr (!std::is_const_v<Grid>)
                        if (cube.begin == cube.end) filled[x / kBits] &= ~(Word(1) << (x % kBits));
                }
            }
    }

    [[nodiscard]] std::size_t wordsOfRow() const noexcept { return std::size_t(cells_[0] + kBits - 1) / kBits; }

    glm::dvec3                 low_{};          ///< [m]
    double                     perMetre_ = 0;   ///< cubes per metre
    Cells                      cells_{1, 1, 1}; ///< cubes
    std::vector<Cube>          cubes_;
    std::vector<Word>          filled_;  ///< row by row along x, a bit for each cube: whether anything is left in it
    std::vector<Entry>         entries_; ///< cube by cube
    std::vector<std::uint32_t> cubeAt_;  ///< of each place
};

} // namespace palp
