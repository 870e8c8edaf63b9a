#include <algorithm>

#include <Eigen/SparseCholesky>

#include "engine/core/contract.h"
#include "engine/tools/bench/direct_solver.h"

namespace palp::bench {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

class EigenSolver final : public DirectSolver {
public:
    explicit EigenSolver(const PlateMatrix& m)
        : matrix_(Eigen::Map<const Matrix>(m.unknowns(), m.unknowns(), Eigen::Index(m.row().size()),
                                           m.columnStart().data(), m.row().data(), m.value().data()))
    {
        factors_.analyzePattern(matrix_);
    }

    [[nodiscard]] std::string name() const override { return "Eigen SimplicialLDLT"; }

    void factorise(const PlateMatrix& m) override
    {
        std::copy(m.value().begin(), m.value().end(), matrix_.valuePtr()); // same pattern: nothing else changes
        factors_.factorize(matrix_);
        if (factors_.info() != Eigen::Success) throw Error("Eigen: the plate's matrix is not positive definite");
    }

    void solve(std::span<const double> right, std::span<double> answer) override
    {
        const Eigen::Index unknowns = matrix_.rows(), columns = Eigen::Index(right.size()) / unknowns;
        Eigen::Map<Eigen::MatrixXd>(answer.data(), unknowns, columns) =
            factors_.solve(Eigen::Map<const Eigen::MatrixXd>(right.data(), unknowns, columns));
    }

    [[nodiscard]] std::optional<std::size_t> peakBytes() const override { return {}; }

private:
    Matrix                                                               matrix_;
    Eigen::SimplicialLDLT<Matrix, Eigen::Lower, Eigen::AMDOrdering<int>> factors_;
};

} // namespace

std::unique_ptr<DirectSolver> eigenSolver(const PlateMatrix& matrix)
{
    return std::make_unique<EigenSolver>(matrix);
}

std::string eigenVersion()
{
    return "Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) + "." +
           std::to_string(EIGEN_MINOR_VERSION);
}

NodeField Direct::solve(const NodeField& force)
{
    std::vector<double> right(std::size_t(matrix.unknowns())), answer(right.size());
    matrix.gather(force, right);
    solver->solve(right, answer);
    return matrix.spread(answer);
}

} // namespace palp::bench
