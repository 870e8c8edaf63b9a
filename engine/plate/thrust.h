#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "engine/core/grid.h"
#include "engine/plate/shell.h"

namespace palp {

/// A load on both fields of a shell: what its energy loses as they move.
struct ShellLoad {
    NodeField onW;   ///< of a deflection [N]
    NodeField onPhi; ///< of Airy's function [1]
};

/// Returns what a deflection [m] and a stress function [N m] leave of a load, f - K x; on held nodes the reaction.
[[nodiscard]] ShellLoad leftOf(const Shell& shell, const ShellLoad& load, const NodeField& w, const NodeField& phi);

/// The fields of thrust of a shell, without the numbers y [N m] that go with them: with K its matrix for w and psi,
/// and f the forces,
///
///     K x + U y = f,     U' x - G y = 0     x = K^-1 f - K^-1 U y,     (G + U' K^-1 U) y = U' K^-1 f
///
/// so that one more solution for each field tells for all forces how much each of them thrusts.
class Thrusts {
public:
    /// \pre whyUnsolvable(shell) is empty
    explicit Thrusts(const Shell& shell);

    /// Returns U, a load for each field [1/(N m)].
    [[nodiscard]] std::span<const ShellLoad> loads() const noexcept { return loads_; }
    /// Returns an entry of G: what a field stretches the membrane by under the forces of another [1/(N m)].
    [[nodiscard]] double own(std::size_t a, std::size_t b) const noexcept { return own_[a * loads_.size() + b]; }

    /// Returns the numbers y [N m].
    /// \param ofLoads  rows of U' K^-1 U, which rounding and a solver may have left less than symmetric [1/(N m)]
    /// \param right    U' K^-1 f [1]
    [[nodiscard]] std::vector<double> numbers(std::span<const double> ofLoads, std::span<const double> right) const;

private:
    std::vector<ShellLoad> loads_;
    std::vector<double>    own_; ///< rows of G
};

} // namespace palp
