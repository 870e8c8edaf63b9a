#include "engine/plate/curved_bending.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/SparseCholesky>

namespace palp {
namespace {

/// A symmetric tensor in the plane.
struct Tensor {
    double xx = 0, zz = 0, xz = 0;
};

/// Returns the moments of unit rigidity, or the forces of unit stiffness, that go with curvatures or strains.
Tensor elastic(const Tensor& of, double nu)
{
    return {of.xx + nu * of.zz, of.zz + nu * of.xx, (1 - nu) * of.xz};
}

double product(const Tensor& a, const Tensor& b)
{
    return a.xx * b.xx + a.zz * b.zz + 2 * a.xz * b.xz;
}

/// What a move of one of a cell's four corners, along x or z, strains the cell by at a place in it.
using CornerStrains = std::array<Tensor, 8>;

/// \param a, b  the place in the cell, from 0 to 1
CornerStrains cornerStrains(double a, double b, double sizeX, double sizeZ)
{
    CornerStrains strains;
    for (std::size_t corner = 0; corner < 4; ++corner) {
        const double x = corner & 2 ? a : 1 - a, z = corner & 1 ? b : 1 - b;
        const double alongX = (corner & 2 ? z : -z) / sizeX, alongZ = (corner & 1 ? x : -x) / sizeZ;
        strains[2 * corner]     = {alongX, 0, alongZ / 2};
        strains[2 * corner + 1] = {0, alongZ, alongX / 2};
    }
    return strains;
}

using CellStiffness = std::array<std::array<double, 8>, 8>; ///< by moves of its corners

/// Returns how a cell of unit stiffness resists, the mean over it: by four places, which are exact, but to shear by its
/// middle, because such cells shear where a strip bends in its plane and would hold it.
CellStiffness cellStiffness(const PlateGrid& grid, double nu)
{
    CellStiffness       stiffness{};
    const CornerStrains middle = cornerStrains(0.5, 0.5, grid.spacingX, grid.spacingZ);
    const double        gauss  = std::sqrt(1.0 / 12);
    for (const double a : {0.5 - gauss, 0.5 + gauss})
        for (const double b : {0.5 - gauss, 0.5 + gauss}) {
            CornerStrains strains = cornerStrains(a, b, grid.spacingX, grid.spacingZ);
            for (std::size_t m = 0; m < 8; ++m) strains[m].xz = middle[m].xz;
            for (std::size_t m = 0; m < 8; ++m)
                for (std::size_t n = 0; n < 8; ++n) stiffness[m][n] += product(elastic(strains[m], nu), strains[n]) / 4;
        }
    return stiffness;
}

/// Returns the means of numbers of cells over those around.
std::vector<double> meansAround(const std::vector<double>& of, const PlateGrid& grid)
{
    constexpr int       kAround = 4; // cells to each side
    std::vector<double> along(of.size()), means(of.size());
    const auto          at   = [&](int i, int j) { return std::size_t(i) * std::size_t(grid.cellsZ) + std::size_t(j); };
    const auto          mean = [&](int middle, int cells, const auto& value) {
        const int first = std::max(middle - kAround, 0), last = std::min(middle + kAround, cells - 1);
        double    sum = 0;
        for (int n = first; n <= last; ++n) sum += value(n);
        return sum / (last - first + 1);
    };
    for (int i = 0; i < grid.cellsX; ++i)
        for (int j = 0; j < grid.cellsZ; ++j)
            along[at(i, j)] = mean(j, grid.cellsZ, [&](int n) { return of[at(i, n)]; });
    for (int i = 0; i < grid.cellsX; ++i)
        for (int j = 0; j < grid.cellsZ; ++j)
            means[at(i, j)] = mean(i, grid.cellsX, [&](int n) { return along[at(n, j)]; });
    return means;
}

} // namespace

struct CurvedBending::Impl {
    static constexpr int kCells = 48; ///< along each side, at most

    const Shell&     shell;
    const PlateGrid& fine;
    const int        stepX, stepZ; ///< cells of the plate's grid in one of these
    const PlateGrid  grid;
    NodeField        kx, kz, kxz; ///< curvature at the nodes [1/m]

    std::vector<double> share;           ///< that counts of each cell [1]
    bool                isSound = false; ///< something is held, and the matrix has its factors

    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;

    explicit Impl(const Shell& given);

    /// Calls visit(i, j, cell) for each node within the sides of the plate's grid.
    template <class Visit>
    void eachNode(const Visit& visit) const
    {
        for (int i = 1; i < fine.cellsX; ++i)
            for (int j = 1; j < fine.cellsZ; ++j)
                visit(i, j, std::size_t((i - 1) / stepX) * std::size_t(grid.cellsZ) + std::size_t((j - 1) / stepZ));
    }

    [[nodiscard]] std::array<int, 4> corners(int cell) const noexcept
    {
        const int first = cell / grid.cellsZ * grid.nodesZ() + cell % grid.cellsZ;
        return {first, first + 1, first + grid.nodesZ(), first + grid.nodesZ() + 1};
    }

    [[nodiscard]] bool   isHeld(int i, int j) const;
    void                 findCurvature();
    [[nodiscard]] double workOf(const NodeField& w) const;
};

/// Whether a side holds the node or one beside it, or the ground is so firm that the sheet does not bend from one node
/// to the next.
bool CurvedBending::Impl::isHeld(int i, int j) const
{
    const double area = fine.spacingX * fine.spacingZ;
    const int    a    = i == 1 ? 0 : i + 1 == fine.cellsX ? fine.cellsX : i;
    const int    b    = j == 1 ? 0 : j + 1 == fine.cellsZ ? fine.cellsZ : j;
    return palp::isHeld(shell.bending, a, b) ||
           foundationAt(shell.bending, i, j) * area * area > shell.bending.rigidity(i, j);
}

void CurvedBending::Impl::findCurvature()
{
    const auto between = [&](const NodeField& of, int i, int j) {
        const int a = std::min(i * stepX, fine.cellsX - 1), b = std::min(j * stepZ, fine.cellsZ - 1);
        return (of(a, b) + of(a + 1, b) + of(a, b + 1) + of(a + 1, b + 1)) / 4;
    };
    for (int i = 0; i <= grid.cellsX; ++i)
        for (int j = 0; j <= grid.cellsZ; ++j) {
            kx(i, j)  = between(shell.curvatureX, i, j);
            kz(i, j)  = between(shell.curvatureZ, i, j);
            kxz(i, j) = between(shell.curvatureXZ, i, j);
        }
    // Where the curvature turns from one side to the other it is small, but not its slope: the cells around tell.
    std::vector<double> both(share.size()), square = both; // |k1 k2|, and the mean of k1 and k2 squared [1/m^2]
    for (std::size_t cell = 0; cell < share.size(); ++cell) {
        Tensor mean;
        for (const int node : corners(int(cell))) {
            mean.xx += kx.values()[std::size_t(node)] / 4;
            mean.zz += kz.values()[std::size_t(node)] / 4;
            mean.xz += kxz.values()[std::size_t(node)] / 4;
        }
        both[cell]   = std::abs(mean.xx * mean.zz - mean.xz * mean.xz);
        square[cell] = (mean.xx + mean.zz) * (mean.xx + mean.zz) / 4;
    }
    both   = meansAround(both, grid);
    square = meansAround(square, grid);
    for (std::size_t cell = 0; cell < share.size(); ++cell)
        share[cell] = both[cell] < square[cell] ? 1 - std::pow(both[cell] / square[cell], 2) : 0;
}

CurvedBending::Impl::Impl(const Shell& given)
    : shell(given), fine(given.bending.grid), stepX((fine.cellsX + kCells - 1) / kCells),
      stepZ((fine.cellsZ + kCells - 1) / kCells), grid{(fine.cellsX + stepX - 2) / stepX,
                                                       (fine.cellsZ + stepZ - 2) / stepZ, stepX * fine.spacingX,
                                                       stepZ * fine.spacingZ},
      kx(grid), kz(grid), kxz(grid), share(std::size_t(grid.cellsX) * std::size_t(grid.cellsZ))
{
    constexpr double kFirm = 1e3, kHardly = 1e-9; // of what is held and of what hangs on nothing, over the sheet [1]
    findCurvature();
    if (std::ranges::all_of(share, [](double of) { return of == 0; })) return;
    std::vector<double> sheet(share.size()), held = sheet;
    eachNode([&](int i, int j, std::size_t cell) {
        const double stiff = shell.bending.rigidity(i, j);
        sheet[cell] += stiff;
        if (isHeld(i, j)) held[cell] += stiff;
    });
    // What nothing holds may move as a whole, and no curvature tells how far.
    if (std::ranges::all_of(held, [](double of) { return of == 0; })) return;
    const CellStiffness                 element = cellStiffness(grid, shell.bending.poissonRatio);
    const double                        perArea = 1 / (grid.spacingX * grid.spacingZ);
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t cell = 0; cell < sheet.size(); ++cell) {
        const std::array<int, 4> corner = corners(int(cell));
        const double             firm   = (kFirm * held[cell] + kHardly * sheet[cell]) * perArea;
        for (std::size_t m = 0; m < 8; ++m) {
            entries.emplace_back(2 * corner[m / 2] + int(m % 2), 2 * corner[m / 2] + int(m % 2), firm);
            for (std::size_t n = 0; n < 8; ++n)
                entries.emplace_back(2 * corner[m / 2] + int(m % 2), 2 * corner[n / 2] + int(n % 2),
                                     sheet[cell] * element[m][n]);
        }
    }
    const auto                  unknowns = Eigen::Index(2 * grid.nodes());
    Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    factors.compute(matrix);
    isSound = factors.info() == Eigen::Success && (factors.vectorD().array() > 0).all();
}

double CurvedBending::Impl::workOf(const NodeField& w) const
{
    const double nu = shell.bending.poissonRatio, perX = 1 / (fine.spacingX * fine.spacingX);
    const double perZ = 1 / (fine.spacingZ * fine.spacingZ), perXZ = 1 / (4 * fine.spacingX * fine.spacingZ);
    // Sums over the nodes of each cell, over the area of one [N m].
    std::vector<Tensor> moments(std::size_t(grid.cellsX) * std::size_t(grid.cellsZ)), shrunk = moments;
    eachNode([&](int i, int j, std::size_t cell) {
        const double here = w(i, j), stiff = shell.bending.rigidity(i, j), lower = stiff * here;
        Tensor &     m = moments[cell], &s = shrunk[cell];
        m.xx += stiff * (w(i + 1, j) - 2 * here + w(i - 1, j)) * perX;
        m.zz += stiff * (w(i, j + 1) - 2 * here + w(i, j - 1)) * perZ;
        m.xz += stiff * (w(i + 1, j + 1) - w(i + 1, j - 1) - w(i - 1, j + 1) + w(i - 1, j - 1)) * perXZ;
        s.xx += lower * shell.curvatureX(i, j);
        s.zz += lower * shell.curvatureZ(i, j);
        s.xz += lower * shell.curvatureXZ(i, j);
    });
    const CornerStrains middle = cornerStrains(0.5, 0.5, grid.spacingX, grid.spacingZ);
    Eigen::VectorXd     right = Eigen::VectorXd::Zero(Eigen::Index(2 * grid.nodes())), turned = right;
    for (std::size_t cell = 0; cell < moments.size(); ++cell) {
        const Tensor bent = elastic(moments[cell], nu), forces = elastic(shrunk[cell], nu);
        const auto   corner = corners(int(cell));
        for (std::size_t m = 0; m < 4; ++m) {
            const int         node = corner[m];
            const std::size_t n    = std::size_t(node);
            const double      ofX  = share[cell] * product(bent, middle[2 * m]);
            const double      ofZ  = share[cell] * product(bent, middle[2 * m + 1]);
            right[2 * node] += product(forces, middle[2 * m]);
            right[2 * node + 1] += product(forces, middle[2 * m + 1]);
            turned[2 * node] += kx.values()[n] * ofX + kxz.values()[n] * ofZ;
            turned[2 * node + 1] += kxz.values()[n] * ofX + kz.values()[n] * ofZ;
        }
    }
    const double work = turned.dot(factors.solve(right)) * fine.spacingX * fine.spacingZ;
    return std::isfinite(work) ? work : 0;
}

CurvedBending::CurvedBending(const Shell& shell)
{
    if (shell.stretched.values().empty()) return;
    auto impl = std::make_unique<const Impl>(shell);
    if (impl->isSound) impl_ = std::move(impl);
}

CurvedBending::~CurvedBending() = default;

double CurvedBending::workOf(const NodeField& w) const
{
    return impl_ ? impl_->workOf(w) : 0;
}

double givesWay(const FootprintResponse& response) noexcept
{
    constexpr double kSofter = 0.5, kStiffer = 1.5; // [1]
    if (!(response.work > 0)) return 1;
    return std::exp(-std::clamp(2 * response.curved / response.work, -kSofter, kStiffer));
}

} // namespace palp
