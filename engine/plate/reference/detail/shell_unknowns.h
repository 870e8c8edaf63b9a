#pragma once
#include <span>
#include <vector>

#include "engine/plate/shell.h"

namespace palp {

/// The most nodes of a shell that is factorised: its factor has about four times the entries of a plate's.
inline constexpr std::size_t kMostFactorisedNodes = 513 * 513;

inline constexpr int kHeldUnknown = -1; ///< number of a node that is not an unknown

/// A part of an entry of the matrix; parts of the same entry add up.
struct ShellEntry {
    int    at[2];    ///< row, column
    double part = 0; ///< [N/m]

    [[nodiscard]] int    row() const noexcept { return at[0]; }
    [[nodiscard]] int    col() const noexcept { return at[1]; }
    [[nodiscard]] double value() const noexcept { return part; }
};
using ShellEntries = std::vector<ShellEntry>;

/// The unknowns of both fields of a shell, w first, and the second derivative of its energy in them.
struct ShellUnknowns {
    PlateGrid              grid;
    std::vector<int>       ofW, ofPhi;      ///< number of each node's unknown, or kHeldUnknown
    int                    firstThrust = 0; ///< number of the unknown of the first of the thrusts, which come last
    int                    count       = 0;
    double                 phiUnit = 1; ///< phi over the unknown [N]: makes both fields metres and both operators alike
    std::vector<NodeField> thrusts;     ///< [1]
    ShellEntries           entries;     ///< of the matrix, both halves

    /// \throws Error naming what is wrong, if whyUnsolvable(shell), or beyond kMostFactorisedNodes
    explicit ShellUnknowns(const Shell& shell);

    /// Returns a field of unknowns; 0 where the nodes are held.
    [[nodiscard]] NodeField spread(std::span<const double> x, const std::vector<int>& numberOf, double unit) const;
    [[nodiscard]] NodeField deflection(std::span<const double> x) const { return spread(x, ofW, 1); }
    [[nodiscard]] NodeField stressFunction(std::span<const double> x) const; ///< with the thrusts

    /// Returns the right side of forces at the nodes [N].
    [[nodiscard]] std::vector<double> rightSide(const NodeField& nodalForce) const;
};

} // namespace palp
