#include "engine/chart/compatible_curvature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Sparse>
#include <Eigen/SparseCholesky>

namespace palp {
namespace {

constexpr int kSpan = 4; ///< splines that are not 0 at a place, along an axis

/// The splines along an axis, and where they are not 0.
struct Axis {
    double cell    = 0; ///< [m]
    double spacing = 0; ///< of the splines [m]
    int    first = 0, last = 0;

    [[nodiscard]] int splines() const { return int((last - first) * cell / spacing) + kSpan; }

    struct At {
        int                       first = 0; ///< of the splines
        std::array<double, kSpan> value{}, slope{}, second{};
    };
    /// Returns the cubic splines at a node with their derivatives [1], [1/m], [1/m^2].
    [[nodiscard]] At at(int node) const
    {
        const double t = (node - first) * cell / spacing;
        const int    n = std::min(int(t), splines() - kSpan);
        const double u = t - n, v = 1 - u;
        At           of{n,
              {v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6, (3 * v * v * v - 6 * v * v + 4) / 6, u * u * u / 6},
              {-v * v / 2, (3 * u * u - 4 * u) / 2, (4 * v - 3 * v * v) / 2, u * u / 2},
              {v, 3 * u - 2, 3 * v - 2, u}};
        for (double& slope : of.slope) slope /= spacing;
        for (double& second : of.second) second /= spacing * spacing;
        return of;
    }
};

/// The nodes that hold the sheet, with some around, and the splines over them.
struct Splines {
    Axis alongX, alongZ;

    Splines(const CurvatureField& field, const PlateGrid& grid, const NodeField& covered)
    {
        constexpr int kAround = 6; // nodes beyond the border that its fields reach
        constexpr int kMost   = 64;
        int           lowX = grid.cellsX, highX = 0, lowZ = grid.cellsZ, highZ = 0;
        for (int i = 0; i <= grid.cellsX; ++i)
            for (int j = 0; j <= grid.cellsZ; ++j) {
                if (!(covered(i, j) > 0)) continue;
                lowX = std::min(lowX, i), highX = std::max(highX, i);
                lowZ = std::min(lowZ, j), highZ = std::max(highZ, j);
            }
        alongX.cell  = grid.spacingX;
        alongZ.cell  = grid.spacingZ;
        alongX.first = std::max(0, lowX - kAround);
        alongX.last  = std::min(grid.cellsX, highX + kAround);
        alongZ.first = std::max(0, lowZ - kAround);
        alongZ.last  = std::min(grid.cellsZ, highZ + kAround);
        const double longest =
            std::max((alongX.last - alongX.first) * alongX.cell, (alongZ.last - alongZ.first) * alongZ.cell);
        alongX.spacing = alongZ.spacing =
            std::max({field.radius / 2, 2 * grid.spacingX, 2 * grid.spacingZ, longest / kMost});
    }

    [[nodiscard]] int count() const { return alongX.splines() * alongZ.splines(); }
    [[nodiscard]] int index(const Axis::At& x, const Axis::At& z, int k) const
    {
        return (x.first + k / kSpan) * alongZ.splines() + z.first + k % kSpan;
    }
};

/// What the splines at a node add to the second derivatives of the height [1/m^2].
struct Bends {
    std::array<double, std::size_t(kSpan) * kSpan> xx{}, zz{}, xz{};

    Bends(const Axis::At& x, const Axis::At& z)
    {
        for (std::size_t k = 0; k < xx.size(); ++k) {
            xx[k] = x.second[k / kSpan] * z.value[k % kSpan];
            zz[k] = x.value[k / kSpan] * z.second[k % kSpan];
            xz[k] = x.slope[k / kSpan] * z.slope[k % kSpan];
        }
    }
};

/// Returns what each spline counts in the nearest height [m].
Eigen::VectorXd nearest(const Splines& splines, const CurvatureField& field, const NodeField& covered)
{
    constexpr int       kWide   = 2 * kSpan - 1; // splines that share a place with one, along an axis
    constexpr double    kBeyond = 1e-3;          // counts of the field that goes on beyond the border [1]
    constexpr double    kLoose  = 1e-9;          // of a height that no tensor tells, such as a plane [1]
    const Axis &        ax = splines.alongX, &az = splines.alongZ;
    const int           many = splines.count(), each = std::max(1, int(ax.spacing / (3 * std::max(ax.cell, az.cell))));
    std::vector<double> shared(std::size_t(many) * kWide * kWide, 0.0);
    Eigen::VectorXd     right = Eigen::VectorXd::Zero(many);
    for (int i = ax.first; i <= ax.last; i += each)
        for (int j = az.first; j <= az.last; j += each) {
            const Axis::At x = ax.at(i), z = az.at(j);
            const Bends    of(x, z);
            const double   counts = std::max(covered(i, j), kBeyond);
            for (int p = 0; p < kSpan * kSpan; ++p) {
                const auto a   = std::size_t(p);
                const int  row = splines.index(x, z, p);
                right[row] +=
                    counts * (of.xx[a] * field.x(i, j) + of.zz[a] * field.z(i, j) + 2 * of.xz[a] * field.xz(i, j));
                for (int q = 0; q < kSpan * kSpan; ++q) {
                    const auto b    = std::size_t(q);
                    const int  away = (q / kSpan - p / kSpan + kSpan - 1) * kWide + q % kSpan - p % kSpan + kSpan - 1;
                    shared[std::size_t(row) * kWide * kWide + std::size_t(away)] +=
                        counts * (of.xx[a] * of.xx[b] + of.zz[a] * of.zz[b] + 2 * of.xz[a] * of.xz[b]);
                }
            }
        }
    std::vector<Eigen::Triplet<double>> entries;
    const double                        most = *std::ranges::max_element(shared);
    for (int row = 0; row < many; ++row) {
        entries.emplace_back(row, row, kLoose * most);
        for (int away = 0; away < kWide * kWide; ++away) {
            const double value  = shared[std::size_t(row) * kWide * kWide + std::size_t(away)];
            const int    column = row + (away / kWide - kSpan + 1) * az.splines() + away % kWide - kSpan + 1;
            if (value != 0) entries.emplace_back(row, column, value);
        }
    }
    Eigen::SparseMatrix<double> matrix(many, many);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
}

} // namespace

void makeCompatible(CurvatureField& field, const PlateGrid& grid, const NodeField& covered)
{
    const Splines         splines(field, grid, covered);
    const Eigen::VectorXd height = nearest(splines, field, covered);
    if (!height.allFinite()) return;
    const Axis &x = splines.alongX, &z = splines.alongZ;
    for (int i = x.first; i <= x.last; ++i)
        for (int j = z.first; j <= z.last; ++j) {
            const Axis::At atX = x.at(i), atZ = z.at(j);
            const Bends    of(atX, atZ);
            field.x(i, j) = field.z(i, j) = field.xz(i, j) = 0;
            for (int k = 0; k < kSpan * kSpan; ++k) {
                const double counts = height[splines.index(atX, atZ, k)];
                field.x(i, j) += counts * of.xx[std::size_t(k)];
                field.z(i, j) += counts * of.zz[std::size_t(k)];
                field.xz(i, j) += counts * of.xz[std::size_t(k)];
            }
        }
    // Farther out it stays as it is there: a step would be a load.
    for (NodeField* values : {&field.x, &field.z, &field.xz})
        for (int i = 0; i <= grid.cellsX; ++i)
            for (int j = 0; j <= grid.cellsZ; ++j)
                (*values)(i, j) = (*values)(std::clamp(i, x.first, x.last), std::clamp(j, z.first, z.last));
}

} // namespace palp
