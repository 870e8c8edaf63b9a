#include "engine/body/detail/shell_triangle.h"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace palp {
namespace {

constexpr double kModulus = 2e5, kPoisson = 0.3, kThickness = 1e-3; // [Pa], [1], [m]

/// A triangle in no special place, whose sides are 4 to 9 mm long.
constexpr std::array<glm::dvec3, 3> kSkew{glm::dvec3(1e-3, 2e-3, -1e-3), glm::dvec3(8e-3, 4e-3, 2e-3),
                                          glm::dvec3(3e-3, 7e-3, 4e-3)};

using Matrix = Eigen::Matrix<double, 18, 18>;

Matrix matrixOf(const std::array<glm::dvec3, 3>& corners, double poissonRatio = kPoisson)
{
    const TriangleStiffness of = shellTriangle(corners, kModulus, poissonRatio, kThickness);
    Matrix                  matrix;
    for (int a = 0; a < 18; ++a)
        for (int b = 0; b < 18; ++b) matrix(a, b) = of[std::size_t(a)][std::size_t(b)];
    return matrix;
}

TEST(ShellTriangle, IsSymmetricAndMovesWithoutForceAsARigidBodyAlone)
{
    const Matrix matrix = matrixOf(kSkew);
    // Rounding of doubles, in sums of some hundred products.
    EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-13 * matrix.norm());
    for (int way = 0; way < 6; ++way) {
        glm::dvec3 moved{}, turned{};
        (way < 3 ? moved : turned)[way % 3] = way < 3 ? 1e-3 : 1;
        Eigen::Matrix<double, 18, 1> rigid;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 at = moved + glm::cross(turned, kSkew[std::size_t(k)]);
            for (int axis = 0; axis < 3; ++axis) rigid[6 * k + axis] = at[axis], rigid[6 * k + 3 + axis] = turned[axis];
        }
        EXPECT_LT((matrix * rigid).norm(), 1e-12 * matrix.norm() * rigid.norm()) << way;
    }
    // What does not change its volume, too: Felippa's beta_0 would be 0 there.
    for (const double nu : {kPoisson, 0.4999}) {
        const Eigen::SelfAdjointEigenSolver<Matrix> modes(matrixOf(kSkew, nu));
        // The unit of a turn is a length of some millimetres: the softest mode is 3e-8 of the stiffest.
        EXPECT_GT(modes.eigenvalues()[6], 1e3 * std::abs(modes.eigenvalues()[5]));
        EXPECT_GT(modes.eigenvalues()[6], 0) << nu;
    }
}

/// A flat patch of nine nodes and eight triangles that are not alike, turned in space.
struct PatchOfTriangles {
    std::vector<glm::dvec3>                 nodes;
    std::vector<std::array<std::size_t, 3>> triangles;
    glm::dvec3                              east, north, normal;

    PatchOfTriangles()
    {
        east   = glm::normalize(glm::dvec3(1, 2, 2));
        normal = glm::normalize(glm::cross(east, glm::dvec3(0, 1, -0.5)));
        north  = glm::cross(normal, east);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const bool inside = i == 1 && j == 1;
                nodes.push_back((5e-3 * i + (inside ? 0.8e-3 : 0)) * east + (5e-3 * j - (inside ? 1.1e-3 : 0)) * north);
            }
        for (std::size_t i = 0; i < 2; ++i)
            for (std::size_t j = 0; j < 2; ++j) {
                const std::size_t at = 3 * i + j;
                triangles.push_back({at, at + 3, at + 4});
                triangles.push_back({at, at + 4, at + 1});
            }
    }

    /// Returns energy and forces on the node within, of a displacement and turns of all nodes.
    template <class Move>
    std::pair<double, double> energyAndForce(const Move& move) const
    {
        Eigen::VectorXd all(6 * Eigen::Index(nodes.size())), forces = Eigen::VectorXd::Zero(all.size());
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            const auto [moved, turned] = move(glm::dot(nodes[n], east), glm::dot(nodes[n], north));
            for (int axis = 0; axis < 3; ++axis) {
                all[Eigen::Index(6 * n) + axis]     = moved[axis];
                all[Eigen::Index(6 * n) + 3 + axis] = turned[axis];
            }
        }
        double stiffest = 0;
        for (const auto& of : triangles) {
            const Matrix                 matrix = matrixOf({nodes[of[0]], nodes[of[1]], nodes[of[2]]});
            Eigen::Matrix<double, 18, 1> own;
            for (int a = 0; a < 18; ++a) own[a] = all[Eigen::Index(6 * of[std::size_t(a / 6)]) + a % 6];
            const Eigen::Matrix<double, 18, 1> force = matrix * own;
            for (int a = 0; a < 18; ++a) forces[Eigen::Index(6 * of[std::size_t(a / 6)]) + a % 6] += force[a];
            stiffest = std::max(stiffest, force.norm());
        }
        return {all.dot(forces) / 2, forces.segment<6>(6 * 4).norm() / stiffest};
    }
};

TEST(ShellTriangle, StretchesEvenlyAsASheetDoes)
{
    const PatchOfTriangles patch;
    constexpr double       ex = 1e-3, ey = -4e-4, g = 7e-4; // strains, and the angle of shear [1]
    const auto [energy, force] = patch.energyAndForce([&](double x, double y) {
        const double u = ex * x + 0.8 * g * y, v = ey * y + 0.2 * g * x; // turned by half of the difference
        return std::pair(u * patch.east + v * patch.north, (0.2 - 0.8) / 2 * g * patch.normal);
    });
    const double E = kModulus / (1 - kPoisson * kPoisson), area = 10e-3 * 10e-3;
    const double exact = area * kThickness / 2 *
                         (E * (ex * ex + ey * ey + 2 * kPoisson * ex * ey) + kModulus / (2 * (1 + kPoisson)) * g * g);
    EXPECT_NEAR(energy / exact, 1, 1e-12); // both are polynomials, and exact: rounding
    EXPECT_LT(force, 1e-12) << "the node within is in balance";
}

TEST(ShellTriangle, BendsEvenlyAsAPlateDoes)
{
    const PatchOfTriangles patch;
    constexpr double       kx = 2, ky = -1, kxy = 0.7; // w'' [1/m]
    const auto [energy, force] = patch.energyAndForce([&](double x, double y) {
        const double w = (kx * x * x + ky * y * y) / 2 + kxy * x * y;
        return std::pair(w * patch.normal, (ky * y + kxy * x) * patch.east - (kx * x + kxy * y) * patch.north);
    });
    const double D = kModulus * std::pow(kThickness, 3) / (12 * (1 - kPoisson * kPoisson)), area = 10e-3 * 10e-3;
    const double exact = area * D / 2 * (kx * kx + ky * ky + 2 * kPoisson * kx * ky + 2 * (1 - kPoisson) * kxy * kxy);
    EXPECT_NEAR(energy / exact, 1, 1e-12);
    EXPECT_LT(force, 1e-11);
}

TEST(ShellTriangle, TwoBendInTheirPlaneAsABarDoesHoweverSlender)
{
    for (const double slender : {1.0, 3.0, 10.0}) {
        const double                    a = 5e-3 * slender, b = 5e-3, bend = 2; // [m], [m], [1/m]
        const std::array<glm::dvec3, 4> at{glm::dvec3(0, -b / 2, 0), {a, -b / 2, 0}, {a, b / 2, 0}, {0, b / 2, 0}};
        double                          energy = 0;
        for (const auto& of :
             {std::array<std::size_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}}) { // both diagonals
            Eigen::Matrix<double, 18, 1> move = Eigen::Matrix<double, 18, 1>::Zero();
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 p = at[of[std::size_t(k)]];
                move[6 * k]        = -bend * p.x * p.y;
                move[6 * k + 1]    = bend * (p.x * p.x + kPoisson * p.y * p.y) / 2;
                move[6 * k + 5]    = bend * p.x;
            }
            energy += 0.5 * move.dot(matrixOf({at[of[0]], at[of[1]], at[of[2]]}) * move) / 2;
        }
        const double exact = kModulus * kThickness * std::pow(b, 3) / 12 * bend * bend * a / 2;
        EXPECT_NEAR(energy / exact, 1, 1e-9) << slender << ": what the triangle was made for, Felippa 2003";
    }
}

/// Displacement over force in the middle of a clamped square, over a^2/D.
double clampedSquare(int cells)
{
    constexpr double side  = 0.1;
    const int        nodes = cells + 1;
    const auto placeOf = [&](int n) { return glm::dvec3(side * (n / nodes) / cells, side * (n % nodes) / cells, 0); };
    const auto unknown = [&](int n, int k) { // of w and its slopes within; nothing moves in the plane
        const int i = n / nodes, j = n % nodes;
        if (i == 0 || j == 0 || i == cells || j == cells || k < 2 || k == 5) return -1;
        return 3 * ((i - 1) * (cells - 1) + j - 1) + k - 2;
    };
    std::vector<Eigen::Triplet<double>> entries;
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
            const int at = i * nodes + j, far = at + nodes;
            // Diagonals that run to and fro, as seen from the middle all alike.
            const bool turns = (i < cells / 2) == (j < cells / 2);
            using Corners    = std::array<int, 3>;
            for (const Corners& of : turns ? std::array{Corners{at, far, at + 1}, Corners{far, far + 1, at + 1}}
                                           : std::array{Corners{at, far, far + 1}, Corners{at, far + 1, at + 1}}) {
                const Matrix matrix = matrixOf({placeOf(of[0]), placeOf(of[1]), placeOf(of[2])});
                for (int a = 0; a < 18; ++a)
                    for (int b = 0; b < 18; ++b) {
                        const int row    = unknown(of[std::size_t(a / 6)], a % 6),
                                  column = unknown(of[std::size_t(b / 6)], b % 6);
                        if (row >= 0 && column >= 0) entries.emplace_back(row, column, matrix(a, b));
                    }
            }
        }
    const int                   count = 3 * (cells - 1) * (cells - 1);
    Eigen::SparseMatrix<double> matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const int       middle  = unknown((nodes * nodes - 1) / 2, 2);
    Eigen::VectorXd force   = Eigen::VectorXd::Zero(count);
    force[middle]           = 1;
    const Eigen::VectorXd w = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(force);
    return w[middle] * kModulus * std::pow(kThickness, 3) / (12 * (1 - kPoisson * kPoisson)) / (side * side);
}

TEST(ShellTriangle, AClampedSquareConvergesInTheSecondOrder)
{
    constexpr double kExact =
        5.6120e-3; // Timoshenko and Woinowsky-Krieger 1959, table 37: 0.00560; Taylor and Govindjee 2002
    const double coarse = clampedSquare(8) / kExact - 1, fine = clampedSquare(16) / kExact - 1,
                 finest = clampedSquare(32) / kExact - 1;
    EXPECT_LT(std::abs(finest), 6e-3) << "5.3 % with 8 cells, and then a third of it with twice as many";
    // A point force has a logarithm in its moments, which takes some off a ratio of four.
    EXPECT_GT(coarse / fine, 2.8);
    EXPECT_GT(fine / finest, 2.8);
}

} // namespace
} // namespace palp
