// Linked into palpate_peers only, which is never installed: parts of CHOLMOD are under the GPL.
#include "engine/tools/bench/cholmod_solver.h"

#include <algorithm>
#include <filesystem>

#include <dlfcn.h>
#include <suitesparse/cholmod.h>

#include "engine/core/contract.h"

namespace palp::bench {
namespace {

class CholmodSolver final : public DirectSolver {
public:
    explicit CholmodSolver(const PlateMatrix& m) : row_(m.row().begin(), m.row().end())
    {
        cholmod_start(&common_);
        common_.print              = 0;
        common_.nmethods           = 3; // CHOLMOD tries all and keeps the one with the fewest operations
        common_.method[0].ordering = CHOLMOD_AMD;
        common_.method[1].ordering = CHOLMOD_METIS;
        common_.method[2].ordering = CHOLMOD_NESDIS;
        columnStart_.assign(m.columnStart().begin(), m.columnStart().end());

        auto&      matrix = matrix_;
        const auto n      = std::size_t(m.unknowns());
        matrix            = {};
        matrix.nrow = matrix.ncol = n;
        matrix.nzmax              = row_.size();
        matrix.p                  = columnStart_.data();
        matrix.i                  = row_.data();
        matrix.stype              = -1; // lower triangle
        matrix.itype              = CHOLMOD_INT;
        matrix.xtype              = CHOLMOD_REAL;
        matrix.dtype              = CHOLMOD_DOUBLE;
        matrix.sorted = matrix.packed = 1;
        use(m);
        factor_ = cholmod_analyze(&matrix_, &common_);
        if (!factor_) throw Error("CHOLMOD: the analysis failed");
        right_ = cholmod_allocate_dense(n, 1, n, CHOLMOD_REAL, &common_);
    }

    ~CholmodSolver() override
    {
        for (cholmod_dense** dense : {&right_, &answer_, &y_, &e_})
            if (*dense) cholmod_free_dense(dense, &common_);
        if (factor_) cholmod_free_factor(&factor_, &common_);
        cholmod_finish(&common_);
    }
    CholmodSolver(const CholmodSolver&)            = delete;
    CholmodSolver& operator=(const CholmodSolver&) = delete;

    [[nodiscard]] std::string name() const override { return "CHOLMOD"; }

    void factorise(const PlateMatrix& m) override
    {
        use(m);
        if (!cholmod_factorize(&matrix_, factor_, &common_) || common_.status != CHOLMOD_OK)
            throw Error("CHOLMOD: the plate's matrix cannot be factorised (status " + std::to_string(common_.status) +
                        ")");
    }

    void solve(std::span<const double> right, std::span<double> answer) override
    {
        const std::size_t columns = right.size() / matrix_.nrow;
        if (right_->ncol != columns) {
            cholmod_free_dense(&right_, &common_);
            right_ = cholmod_allocate_dense(matrix_.nrow, columns, matrix_.nrow, CHOLMOD_REAL, &common_);
        }
        std::copy(right.begin(), right.end(), static_cast<double*>(right_->x));
        // This form of the solve keeps its work space from call to call.
        if (!cholmod_solve2(CHOLMOD_A, factor_, right_, nullptr, &answer_, nullptr, &y_, &e_, &common_))
            throw Error("CHOLMOD: the solve failed");
        const auto* x = static_cast<const double*>(answer_->x);
        std::copy(x, x + answer.size(), answer.begin());
    }

    [[nodiscard]] std::optional<std::size_t> peakBytes() const override { return common_.memory_usage; }

private:
    /// Points CHOLMOD at the values, which it reads in place.
    void use(const PlateMatrix& m)
    {
        PALP_EXPECT(m.row().size() == row_.size(), "a matrix of another pattern");
        matrix_.x = const_cast<double*>(m.value().data());
    }

    std::vector<int> columnStart_, row_;
    cholmod_common   common_{};
    cholmod_sparse   matrix_{};
    cholmod_factor*  factor_ = nullptr;
    cholmod_dense *  right_ = nullptr, *answer_ = nullptr, *y_ = nullptr, *e_ = nullptr;
};

} // namespace

std::unique_ptr<DirectSolver> cholmodSolver(const PlateMatrix& matrix)
{
    return std::make_unique<CholmodSolver>(matrix);
}

std::string cholmodVersion()
{
    int version[3];
    cholmod_version(version);
    std::string text =
        "CHOLMOD " + std::to_string(version[0]) + "." + std::to_string(version[1]) + "." + std::to_string(version[2]);
    Dl_info blas{};
    if (void* symbol = dlsym(RTLD_DEFAULT, "dgemm_"); symbol && dladdr(symbol, &blas) && blas.dli_fname) {
        std::error_code ignored;
        const auto      path = std::filesystem::canonical(blas.dli_fname, ignored).string();
        text += ", BLAS " + (path.empty() ? std::string(blas.dli_fname) : path);
        if (path.find("/blas/") != std::string::npos)
            text += " (the reference BLAS, several times slower than OpenBLAS: install libopenblas0-serial)";
    }
    return text;
}

} // namespace palp::bench
