#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "engine/plate/reference/plate_matrix.h"

namespace palp::bench {

/// A sparse direct solver, used as in a loop. Its constructor makes the symbolic analysis, once for a grid; then it
/// factorises numbers and solves for loads.
/// \thread one
class DirectSolver {
public:
    virtual ~DirectSolver() = default;

    [[nodiscard]] virtual std::string name() const = 0;

    /// Factorises a matrix of the same pattern.
    /// \throws Error if it is not positive definite
    virtual void factorise(const PlateMatrix& matrix) = 0;

    /// Solves with the last factors: right side [N] to deflection [m], by unknown; several right sides, one after the
    /// other, are solved at once.
    virtual void solve(std::span<const double> right, std::span<double> answer) = 0;

    /// Returns the most memory that it has held at once [byte]; empty if the library does not report it.
    [[nodiscard]] virtual std::optional<std::size_t> peakBytes() const = 0;
};

/// Makes a solver by Eigen::SimplicialLDLT, minimum degree order.
[[nodiscard]] std::unique_ptr<DirectSolver> eigenSolver(const PlateMatrix& matrix);

[[nodiscard]] std::string eigenVersion(); ///< "Eigen 3.4.0"

/// A matrix and the best direct solver that was found.
struct Direct {
    PlateMatrix                   matrix;
    std::unique_ptr<DirectSolver> solver;

    /// Assembles the values of the matrix and factorises it.
    void factorise(const Plate& plate)
    {
        matrix.assemble(plate);
        solver->factorise(matrix);
    }
    [[nodiscard]] NodeField solve(const NodeField& force);
};

} // namespace palp::bench
