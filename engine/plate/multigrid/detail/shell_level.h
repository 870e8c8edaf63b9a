#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "engine/plate/multigrid/detail/grid_hierarchy.h"
#include "engine/plate/shell.h"

namespace palp {

/// Two fields at the nodes of a level, deflection and Airy's function, with a rim of zeros two nodes wide, so that no
/// stencil has to look where it is. A number of field f, node (i, j) is at [(at(i, j) * 2 + f) * loads + load].
struct ShellLayout {
    static constexpr int kRim = 2;

    int cellsX = 0, cellsZ = 0;

    [[nodiscard]] std::ptrdiff_t stride() const noexcept { return cellsZ + 1 + 2 * kRim; }
    [[nodiscard]] std::ptrdiff_t at(int i, int j) const noexcept { return (i + kRim) * stride() + j + kRim; }
    [[nodiscard]] std::size_t    nodes() const noexcept { return std::size_t((cellsX + 1 + 2 * kRim) * stride()); }
};

/// The entries of both rows of a node. Columns follow kPlateSteps and kCouplingSteps; those of held nodes are 0.
struct ShellRow {
    static constexpr std::size_t kPlateEntries = 13, kCouplingEntries = 9;

    std::array<double, kPlateEntries>    w{}, f{};   ///< A, and C, whose sign is opposite in the matrix
    std::array<double, kCouplingEntries> wf{}, fw{}; ///< B, and its transpose
};

/// Where a column of a row lies, seen from its node.
struct NodeStep {
    int i = 0, j = 0;
};
inline constexpr std::array<NodeStep, ShellRow::kPlateEntries> kPlateSteps{
    {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {-1, 1}, {1, -1}, {1, 1}, {-2, 0}, {2, 0}, {0, -2}, {0, 2}}};
inline constexpr std::array<NodeStep, ShellRow::kCouplingEntries> kCouplingSteps{
    {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {-1, 1}, {1, -1}, {1, 1}}};

/// What the relaxation of a node multiplies residuals with; see compute_shaders/shared/shell_relax.h.
struct ShellNodeInverse {
    double ww = 0, wf = 0, ff = 0;
};

/// One level of the multigrid of a shell, assembled: a map is used for many steps and loads, and forming the moments anew
/// in each of them would cost four times what reading the entries does.
struct ShellLevel {
    ShellLayout                   layout;
    shared::PlateLevel            bending{}, stress{};
    std::vector<ShellRow>         rows;                            ///< of the nodes, the last index along z fastest
    std::vector<ShellNodeInverse> inverses;                        ///< the same
    std::vector<float> tableX, tableZ, stressTableX, stressTableZ; ///< to the next coarser level; see transfer_table.h
};

/// Makes all levels of a shell, the finest first. Rigidity and compliance are coarsened by geometric means, which makes
/// one the inverse of the other on each level if it is on the finest; curvatures by arithmetic ones.
[[nodiscard]] std::vector<ShellLevel> shellLevels(const Shell& shell);

/// Factors of the coarsest level's matrix, both fields together. It is quasi-definite: A > 0 and C > 0, so that L D L'
/// exists for every order of the unknowns.
class ShellCoarseSolver {
public:
    explicit ShellCoarseSolver(const ShellLevel& level);

    /// Solves for all loads: x := K^-1 b, in the level's layout.
    void solve(const double* b, double* x, int loads) const;

private:
    [[nodiscard]] int unknownOf(int i, int j, int field) const noexcept;

    ShellLayout         layout_;
    int                 unknowns_ = 0, halfBand_ = 0;
    std::vector<double> factors_; ///< column by column: the inverse pivot, then L below it
};

} // namespace palp
