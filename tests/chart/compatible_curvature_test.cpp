#include "engine/chart/compatible_curvature.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "tests/support/errors.h"

namespace palp {
namespace {

constexpr double kSize  = 80e-3; // [m]
constexpr int    kCells = 96;

using Number = std::function<double(double x, double z)>; // of places from the middle [m]

NodeField fieldOf(const Number& number)
{
    const PlateGrid grid{kCells, kCells, kSize / kCells, kSize / kCells};
    NodeField       field(grid);
    for (int i = 0; i <= kCells; ++i)
        for (int j = 0; j <= kCells; ++j)
            field(i, j) = number(i * grid.spacingX - kSize / 2, j * grid.spacingZ - kSize / 2);
    return field;
}

CurvatureField made(CurvatureField field, const Number& covered)
{
    field.radius = 6e-3;
    makeCompatible(field, {kCells, kCells, kSize / kCells, kSize / kCells}, fieldOf(covered));
    return field;
}

const Number kDisc = [](double x, double z) { return std::hypot(x, z) < 30e-3 ? 1.0 : 0.0; };
const Number kNone = [](double, double) { return 0.0; };

double largestDifference(const NodeField& a, const NodeField& b, const NodeField& covered)
{
    double most = 0;
    for (std::size_t n = 0; n < a.values().size(); ++n)
        if (covered.values()[n] > 0) most = worse(most, a.values()[n] - b.values()[n]);
    return most;
}

/// Waves of 24 mm, which are eight splines long: cubic splines have the second derivative to (h p)^2 / 12, 5 %.
TEST(CompatibleCurvature, LeavesThatOfAHeightAsItIs)
{
    const double   p = 2 * std::acos(-1.0) / 24e-3;
    CurvatureField waves{fieldOf([&](double x, double z) { return 100 * 0.64 * std::cos(p * (0.8 * x + 0.6 * z)); }),
                         fieldOf([&](double x, double z) { return 100 * 0.36 * std::cos(p * (0.8 * x + 0.6 * z)); }),
                         fieldOf([&](double x, double z) { return 100 * 0.48 * std::cos(p * (0.8 * x + 0.6 * z)); })};
    const auto     found = made(waves, kDisc);
    EXPECT_LT(largestDifference(found.x, waves.x, fieldOf(kDisc)), 0.05 * 64);
    EXPECT_LT(largestDifference(found.z, waves.z, fieldOf(kDisc)), 0.05 * 64);
    EXPECT_LT(largestDifference(found.xz, waves.xz, fieldOf(kDisc)), 0.05 * 64);
    CurvatureField even{fieldOf([](double, double) { return 20; }), fieldOf([](double, double) { return -7; }),
                        fieldOf([](double, double) { return 3; })};
    const auto     same = made(even, kDisc);
    EXPECT_LT(largestDifference(same.x, even.x, fieldOf(kDisc)), 2e-4 * 20) << "but for what holds a plane";
    EXPECT_LT(largestDifference(same.z, even.z, fieldOf(kDisc)), 2e-4 * 20);
    EXPECT_LT(largestDifference(same.xz, even.xz, fieldOf(kDisc)), 2e-4 * 20);
}

/// Of kx = a z^2 there is no surface. The nearest one has k = d2 of some height, so that its kx changes along z as kxz
/// does along x; and no other height is nearer, so that what was taken off does no work with any of them.
TEST(CompatibleCurvature, IsTheNearestThatASurfaceCanHave)
{
    const double   a = 4e4; // [1/m^3]
    CurvatureField torn{fieldOf([&](double, double z) { return a * z * z; }), fieldOf(kNone), fieldOf(kNone)};
    const auto     found   = made(torn, kDisc);
    const auto     covered = fieldOf(kDisc);
    const double   step    = 2 * kSize / kCells;
    double         off = 0, change = 0, with = 0, own = 0;
    for (int i = 30; i <= kCells - 30; ++i)
        for (int j = 30; j <= kCells - 30; ++j) {
            off += std::abs((found.x(i, j + 1) - found.x(i, j - 1)) / step -
                            (found.xz(i + 1, j) - found.xz(i - 1, j)) / step);
            change += std::abs((torn.x(i, j + 1) - torn.x(i, j - 1)) / step);
        }
    EXPECT_LT(off, 0.01 * change);
    const Number square = [](double x, double z) { return x * x - z * z; }; // of the height x^4/12 - x^2 z^2/2
    const auto   rest = fieldOf(square), cross = fieldOf([](double x, double z) { return -2 * x * z; });
    const auto   minus = fieldOf([](double x, double) { return -x * x; });
    for (std::size_t n = 0; n < covered.values().size(); ++n) {
        const double counts = covered.values()[n];
        const double dx = torn.x.values()[n] - found.x.values()[n], dz = torn.z.values()[n] - found.z.values()[n];
        const double dxz = torn.xz.values()[n] - found.xz.values()[n];
        with += counts * (dx * rest.values()[n] + dz * minus.values()[n] + 2 * dxz * cross.values()[n]);
        own += counts * std::abs(dx * rest.values()[n]);
    }
    EXPECT_LT(std::abs(with), 0.02 * own)
        << "the splines do not have that height exactly, and the void counts a little";
    EXPECT_GT(largestDifference(found.x, torn.x, covered), 0.1 * a * 30e-3 * 30e-3) << "then nothing is shown";
}

/// A step of the curvature is a load: at the side of the window's part that is solved it made laws of large deflections
/// fall by a tenth.
TEST(CompatibleCurvature, GoesOnBeyondTheBorderWithoutAStep)
{
    const double   a = 4e4; // [1/m^3]
    CurvatureField torn{fieldOf([&](double, double z) { return a * z * z; }), fieldOf(kNone), fieldOf(kNone)};
    const auto     found = made(torn, kDisc);
    double         most  = 0;
    for (int i = 1; i <= kCells; ++i)
        for (int j = 0; j <= kCells; ++j)
            most = worse(worse(most, found.x(i, j) - found.x(i - 1, j)), found.x(j, i) - found.x(j, i - 1));
    const double along = a * 2 * 33e-3 * kSize / kCells; // what the given field changes from node to node at the border
    EXPECT_LT(most, 3 * along) << "beyond, the nearest height is bent back";
}

} // namespace
} // namespace palp
