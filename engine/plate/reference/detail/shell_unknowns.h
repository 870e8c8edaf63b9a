#pragma once
#include <vector>

#include <Eigen/SparseCholesky>

#include "engine/plate/shell.h"

namespace palp {

/// The most nodes of a shell that is factorised: its factor has about four times the entries of a plate's.
inline constexpr std::size_t kMostFactorisedNodes = 513 * 513;

inline constexpr int kHeldUnknown = -1; ///< number of a node that is not an unknown

using ShellMatrix  = Eigen::SparseMatrix<double>;
using ShellFactors = Eigen::SimplicialLDLT<ShellMatrix, Eigen::Lower, Eigen::AMDOrdering<int>>;
using ShellEntries = std::vector<Eigen::Triplet<double>>;

/// The unknowns of both fields of a shell, w first, and the second derivative of its energy in them.
struct ShellUnknowns {
    PlateGrid        grid;
    std::vector<int> ofW, ofPhi; ///< number of each node's unknown, or kHeldUnknown
    int              count   = 0;
    double           phiUnit = 1; ///< phi over the unknown [N]: makes both fields metres and both operators alike
    ShellEntries     entries;     ///< of the matrix, both halves

    /// 	hrows Error naming what is wrong, if whyUnsolvable(shell), or beyond kMostFactorisedNodes
    explicit ShellUnknowns(const Shell& shell);

    /// Returns a field of unknowns; 0 where the nodes are held.
    [[nodiscard]] NodeField spread(const Eigen::VectorXd& x, const std::vector<int>& numberOf, double unit) const;
    [[nodiscard]] NodeField deflection(const Eigen::VectorXd& x) const { return spread(x, ofW, 1); }
    [[nodiscard]] NodeField stressFunction(const Eigen::VectorXd& x) const { return spread(x, ofPhi, phiUnit); }

    /// Returns the right side of forces at the nodes [N].
    [[nodiscard]] Eigen::VectorXd rightSide(const NodeField& nodalForce) const;

    [[nodiscard]] ShellMatrix matrixOf(const ShellEntries& from) const;
};

} // namespace palp
