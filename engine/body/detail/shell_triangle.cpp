#include "engine/body/detail/shell_triangle.h"

#include <algorithm>

#include <Eigen/Dense>
#include <glm/geometric.hpp>

namespace palp {
namespace {

using Matrix3  = Eigen::Matrix3d;
using Matrix9  = Eigen::Matrix<double, 9, 9>;
using Matrix39 = Eigen::Matrix<double, 3, 9>;

/// A triangle in its own plane.
struct Flat {
    std::array<double, 3> x{}, y{}; ///< of the corners [m]
    double                area = 0; ///< [m^2]

    [[nodiscard]] double dx(int to, int from) const { return x[std::size_t(to)] - x[std::size_t(from)]; }
    [[nodiscard]] double dy(int to, int from) const { return y[std::size_t(to)] - y[std::size_t(from)]; }
    [[nodiscard]] double square(int a, int b) const { return dx(a, b) * dx(a, b) + dy(a, b) * dy(a, b); } ///< [m^2]
};

/// Returns stresses over strains in a plane [Pa].
Matrix3 planeStress(double modulus, double nu)
{
    Matrix3 of;
    of << 1, nu, 0, nu, 1, 0, 0, 0, (1 - nu) / 2;
    return modulus / (1 - nu * nu) * of;
}

/// Returns the membrane's stiffness, of u, v and the turn in the plane of each corner. Names are Felippa's, and so are
/// the numbers of corners, less one.
Matrix9 membrane(const Flat& of, const Matrix3& E, double nu, double thickness)
{
    constexpr double            kAlpha       = 1.5;
    constexpr double            kBetas[3][3] = {{1, 2, 1}, {0, 1, -1}, {-1, -1, -2}};
    const double                beta0 = std::max((1 - 4 * nu * nu) / 2, 0.01), A = of.area;
    Eigen::Matrix<double, 9, 3> L;
    for (int k = 0; k < 3; ++k) {
        const int    next = (k + 1) % 3, last = (k + 2) % 3;
        const double y = of.dy(next, last), x = of.dx(last, next); // y23, x32
        L.row(3 * k) << y, 0, x;
        L.row(3 * k + 1) << 0, x, y;
        const double x13 = of.dx(last, k), x12 = of.dx(k, next), y13 = of.dy(k, last), y21 = of.dy(next, k); // x31
        L.row(3 * k + 2) << y * (y13 - y21), x * (x13 - x12), 2 * (x13 * y13 - x12 * y21);
        L.row(3 * k + 2) *= kAlpha / 6;
    }
    L *= thickness / 2;
    const Matrix9 basic = L * E * L.transpose() / (A * thickness);

    Matrix39 turns; // of the corners, less the triangle's own
    for (int row = 0; row < 3; ++row)
        for (int k = 0; k < 3; ++k) {
            turns(row, 3 * k)     = of.dx((k + 2) % 3, (k + 1) % 3);
            turns(row, 3 * k + 1) = of.dy((k + 2) % 3, (k + 1) % 3);
            turns(row, 3 * k + 2) = row == k ? 4 * A : 0;
        }
    turns /= 4 * A;
    // Strains along the sides 21, 32 and 13.
    const double l21 = of.square(1, 0), l32 = of.square(2, 1), l13 = of.square(0, 2);
    const auto   y = [&](int a, int b) { return of.dy(a - 1, b - 1); };
    const auto   x = [&](int a, int b) { return of.dx(a - 1, b - 1); };
    Matrix3      Te;
    Te << y(2, 3) * y(1, 3) * l21, y(3, 1) * y(2, 1) * l32, y(1, 2) * y(3, 2) * l13, //
        x(2, 3) * x(1, 3) * l21, x(3, 1) * x(2, 1) * l32, x(1, 2) * x(3, 2) * l13,   //
        (y(2, 3) * x(3, 1) + x(3, 2) * y(1, 3)) * l21, (y(3, 1) * x(1, 2) + x(1, 3) * y(2, 1)) * l32,
        (y(1, 2) * x(2, 3) + x(2, 1) * y(3, 2)) * l13;
    Te /= 4 * A * A;
    const Matrix3 natural = Te.transpose() * E * Te;
    const auto    Q       = [&](const int(&rows)[3], int shift) { // which beta stands first in a row, by rows of betas
        Matrix3      q;
        const double lengths[] = {l21, l32, l13};
        for (int side = 0; side < 3; ++side)
            for (int k = 0; k < 3; ++k) q(side, k) = kBetas[rows[side]][(k + shift) % 3] / lengths[side];
        return Matrix3(2 * A / 3 * q);
    };
    const Matrix3 Q1 = Q({0, 1, 2}, 0), Q2 = Q({2, 0, 1}, 2), Q3 = Q({1, 2, 0}, 1);
    const Matrix3 Q4 = (Q1 + Q2) / 2, Q5 = (Q2 + Q3) / 2, Q6 = (Q3 + Q1) / 2;
    const Matrix3 higher =
        A * thickness * (Q4.transpose() * natural * Q4 + Q5.transpose() * natural * Q5 + Q6.transpose() * natural * Q6);
    return basic + 0.75 * beta0 * turns.transpose() * higher * turns;
}

/// Returns the stiffness of bending, of w and the turns about x and y of each corner.
Matrix9 bending(const Flat& of, const Matrix3& D)
{
    Eigen::Matrix<double, 6, 9> slopeX = Eigen::Matrix<double, 6, 9>::Zero(), slopeY = slopeX; // of corners, of sides
    for (int k = 0; k < 3; ++k) {
        slopeX(k, 3 * k + 2) = -1;
        slopeY(k, 3 * k + 1) = 1;
    }
    for (int k = 0; k < 3; ++k) { // the middle of the side from corner k to the next
        const int                   next    = (k + 1) % 3;
        const double                length2 = of.square(k, next), sx2 = of.dx(next, k), sy2 = of.dy(next, k);
        Eigen::Matrix<double, 1, 9> along = Eigen::Matrix<double, 1, 9>::Zero(); // times the length
        along(3 * next)                   = 1.5;
        along(3 * k)                      = -1.5;
        for (const int end : {k, next}) along -= 0.25 * (sx2 * slopeX.row(end) + sy2 * slopeY.row(end));
        const Eigen::Matrix<double, 1, 9> across =
            (-sy2 * (slopeX.row(k) + slopeX.row(next)) + sx2 * (slopeY.row(k) + slopeY.row(next))) / 2;
        slopeX.row(3 + k) = (sx2 * along - sy2 * across) / length2;
        slopeY.row(3 + k) = (sy2 * along + sx2 * across) / length2;
    }
    const std::array<double, 3> bx{of.dy(1, 2), of.dy(2, 0), of.dy(0, 1)}, by{of.dx(2, 1), of.dx(0, 2), of.dx(1, 0)};
    Matrix9                     stiffness = Matrix9::Zero();
    for (int side = 0; side < 3; ++side) { // in the middles of the sides, which is exact
        std::array<double, 3> share{};
        share[std::size_t(side)] = share[std::size_t((side + 1) % 3)] = 0.5;
        Eigen::Matrix<double, 1, 6> alongX, alongY; // derivatives of the quadratic shape functions, times 2 A
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next      = (k + 1) % 3;
            alongX[Eigen::Index(k)]     = (4 * share[k] - 1) * bx[k];
            alongY[Eigen::Index(k)]     = (4 * share[k] - 1) * by[k];
            alongX[Eigen::Index(3 + k)] = 4 * (share[k] * bx[next] + share[next] * bx[k]);
            alongY[Eigen::Index(3 + k)] = 4 * (share[k] * by[next] + share[next] * by[k]);
        }
        Matrix39 curvature;
        curvature << alongX * slopeX, alongY * slopeY, alongX * slopeY + alongY * slopeX;
        curvature /= 2 * of.area;
        stiffness += of.area / 3 * curvature.transpose() * D * curvature;
    }
    return stiffness;
}

} // namespace

TriangleStiffness shellTriangle(const std::array<glm::dvec3, 3>& corners, double modulus, double poissonRatio,
                                double thickness)
{
    const glm::dvec3 along = corners[1] - corners[0], other = corners[2] - corners[0];
    const glm::dvec3 east = glm::normalize(along), normal = glm::normalize(glm::cross(along, other));
    const glm::dvec3 north = glm::cross(normal, east);
    Flat             flat;
    for (std::size_t k = 0; k < 3; ++k) {
        flat.x[k] = glm::dot(corners[k] - corners[0], east);
        flat.y[k] = glm::dot(corners[k] - corners[0], north);
    }
    flat.area         = glm::length(glm::cross(along, other)) / 2;
    const Matrix3 E   = planeStress(modulus, poissonRatio);
    const Matrix9 in  = membrane(flat, E, poissonRatio, thickness);
    const Matrix9 out = bending(flat, thickness * thickness * thickness / 12 * E);
    Matrix3       axes; // rows: the triangle's own
    axes << east.x, east.y, east.z, north.x, north.y, north.z, normal.x, normal.y, normal.z;
    constexpr int                 kIn[] = {0, 1, 5}, kOut[] = {2, 3, 4}; // of a corner's six freedoms
    Eigen::Matrix<double, 18, 18> own = Eigen::Matrix<double, 18, 18>::Zero();
    for (int a = 0; a < 9; ++a)
        for (int b = 0; b < 9; ++b) {
            own(6 * (a / 3) + kIn[a % 3], 6 * (b / 3) + kIn[b % 3])   = in(a, b);
            own(6 * (a / 3) + kOut[a % 3], 6 * (b / 3) + kOut[b % 3]) = out(a, b);
        }
    TriangleStiffness world;
    for (int a = 0; a < 6; ++a)
        for (int b = 0; b < 6; ++b) {
            const Matrix3 turned = axes.transpose() * own.block<3, 3>(3 * a, 3 * b) * axes;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) world[std::size_t(3 * a + i)][std::size_t(3 * b + j)] = turned(i, j);
        }
    return world;
}

} // namespace palp
