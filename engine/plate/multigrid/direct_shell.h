#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/plate/plate_solver.h"
#include "engine/plate/shell.h"

namespace palp {

struct HostKernels;

/// Lets the deflection of an object that ends in its window go on beyond its border as it does within: what resists
/// there by nothing but its share in the stresses moves as far as these want, to no good for whoever takes the
/// deflection for a surface. By it laws of large deflections were off by up to ninety times.
void goOnBeyondSheet(NodeField& deflection, const Shell& shell);

/// Solves for loads on an object that ends in its window by a factor of its whole matrix, on the host and in doubles.
/// Multigrid needs 25 to 200 steps for such shells, and some it does not solve: what lies beyond a border has next to
/// no rigidity, or it bridges gaps, and the sheet's thrusts cancel most of an answer.
///
/// A factor needs nothing beyond a border. Nodes there are left out, but for those that a term of the sheet's energy
/// reaches, and the terms that need others with them: the border is free, and nothing bridges a gap.
/// \thread one at a time
/// \source George 1973 (nested dissection); Duff & Reid 1983 (fronts); Vanderbei 1995: every order of elimination of a
///         matrix with a positive and a negative definite block has its factors, without pivoting
class DirectShell {
public:
    /// Returns whether it takes less time than multigrid: for objects that end in the window.
    [[nodiscard]] static bool pays(const Shell& shell);

    /// Divides the nodes and makes the factor: 0.1 s for a sheet of 10 000 nodes, on one core.
    /// \param footprints  that press on the piece of sheet to be solved for: another one may be held by nothing
    /// \param memory      of a factor that is not needed any more: new memory costs as much as a solve
    /// \param kernels     of an instruction set; null: the best
    /// \throws Error if whyUnsolvable(shell)
    DirectShell(const Shell& shell, std::span<const Footprint> footprints, std::vector<double> memory = {},
                const HostKernels* kernels = nullptr);
    ~DirectShell();
    DirectShell(DirectShell&&) noexcept;
    DirectShell& operator=(DirectShell&&) noexcept;

    [[nodiscard]] const Shell&        shell() const noexcept;
    [[nodiscard]] bool                has(std::span<const Footprint> footprints) const; ///< all on what it solves for
    [[nodiscard]] std::vector<double> takeMemory();                                     ///< no solve() after it

    /// \param footprints  forces on other pieces of the sheet have no effect
    /// \param whole      index of the load whose deflection is wanted, and of which the report is; beyond a border that
    ///                   goes on as at the border
    /// \param tolerance  of works [1]
    /// \return nothing if rounding leaves more, as a step of refinement tells it; the report has its share of the first
    ///         loads that were refined on this factor
    [[nodiscard]] std::optional<FootprintSolution> solve(std::span<const Footprint> footprints, std::size_t whole,
                                                         double tolerance);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace palp
