#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/plate/footprint.h"
#include "engine/plate/host/host_kernels.h"
#include "engine/plate/host/shell_view.h"
#include "engine/plate/multigrid/detail/grid_hierarchy.h"
#include "engine/plate/shell.h"
#include "engine/plate/thrust.h"

namespace palp {

/// Returns how many numbers a field of one load has, of both its unknowns and with the empty rows.
[[nodiscard]] std::size_t numbersOf(const ShellLayout& layout) noexcept;

/// Returns the place of a node's number in a field of one load.
/// \param field  0: w, 1: phi
[[nodiscard]] std::ptrdiff_t placeIn(const ShellLayout& layout, int i, int j, int field) noexcept;

/// One level of the multigrid of a shell, assembled: a map is used for many steps and loads.
struct ShellLevel {
    ShellLayout                       layout{};
    shared::PlateLevel                bending{}, stress{};
    std::vector<float>                entries; ///< see ShellLayout; the cycle's
    std::vector<double>               exact;   ///< the same in doubles, of the finest level and the coarsest one
    std::array<std::vector<float>, 4> tables;  ///< to the next coarser level: w along x, phi, w along z, phi

    /// Returns a coefficient in doubles.
    [[nodiscard]] double exactAt(int plane, int i, int j) const noexcept;
};

/// A part of a load on an unknown.
struct PlacedForce {
    std::ptrdiff_t place; ///< in a field
    double         force; ///< of any unit
};
using PlacedLoad = std::vector<PlacedForce>;

/// Returns the parts of a load on unknown nodes.
[[nodiscard]] PlacedLoad placed(const ShellLevel& level, const Footprint& load);
/// Returns the parts of a load on both fields.
/// \param phiUnit  phi over its unknown [N]
[[nodiscard]] PlacedLoad placed(const ShellLevel& level, const ShellLoad& load, double phiUnit);

/// Makes all levels of a shell, the finest first, in the memory of those of another one. Rigidity and compliance are
/// coarsened by geometric means, which makes one the inverse of the other on each level if it is on the finest;
/// curvatures by arithmetic ones.
void makeLevels(const Shell& shell, const HostKernels& kernels, std::vector<ShellLevel>& levels);

/// Factors of the coarsest level's matrix, both fields together. It is quasi-definite: A > 0 and C > 0, so that L D L'
/// exists for every order of the unknowns.
class ShellCoarseSolver {
public:
    /// Makes the factors; before, there is nothing to solve with.
    void factorise(const ShellLevel& level, const HostKernels& kernels);

    /// Returns what the factors are of.
    [[nodiscard]] std::span<const std::ptrdiff_t> places() const noexcept { return places_; }
    [[nodiscard]] std::span<const double>         factors() const noexcept { return factors_; }
    [[nodiscard]] int                             halfBand() const noexcept { return halfBand_; }

    /// Solves for one load, or eight: x := K^-1 b, with the kernels for as many.
    void solve(const HostKernels& kernels, const float* b, float* x) const;

private:
    [[nodiscard]] int numberOf(const ShellLayout& layout, int i, int j, int field) const noexcept;
    void              number(const ShellLevel& level);
    void              collect(const ShellLevel& level);

    std::vector<int>            unknowns_; ///< by node, w before phi: its number in the order of elimination, or -1
    std::vector<std::ptrdiff_t> places_;   ///< of unknowns in a field
    int                         halfBand_ = 0;
    std::vector<double>         factors_; ///< column by column: the inverse pivot, then L below it
};

} // namespace palp
