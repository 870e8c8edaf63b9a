#include "engine/perception/perception.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/spatial_law.h"
#include "engine/plate/load.h"
#include "engine/plate/plate_solver.h"

namespace palp {
namespace {

/// A contact that passes a stiff wart: the deflection under it, and the score of who compares it with a plate without
/// one, for Weber fractions 0.07, 0.15, 0.22.
///
/// Unit square, clamped, Poisson's ratio 0.2, D = 1 + (contrast - 1) exp(-r^2 / (2 0.1^2)) about a place `distance`
/// beside the middle, where a Gaussian of deviation 0.05 presses with 1 N.
/// \source an independent prototype: a spectral Ritz solution in double precision, not finite differences
struct Scanned {
    double contrast, distance, deflection, ratio, right[3];
};
constexpr Scanned kScan[] = {{1.25, 0, 4.837791056e-03, 1.065413, {0.7362, 0.6201, 0.5851}},
                             {1.25, 0.2, 5.029937275e-03, 1.024713, {0.5961, 0.5469, 0.5330}},
                             {1.5, 0.1, 4.701946042e-03, 1.096194, {0.8201, 0.6712, 0.6223}},
                             {2, 0, 4.177818276e-03, 1.233717, {0.9819, 0.8446, 0.7619}},
                             {2, 0.15, 4.552204148e-03, 1.132252, {0.8922, 0.7256, 0.6632}},
                             {2, 0.4, 4.937490236e-03, 1.043900, {0.6658, 0.5821, 0.5579}},
                             {10, 0, 2.249929886e-03, 2.290846, {1.0000, 1.0000, 0.9975}},
                             {10, 0.3, 3.927642042e-03, 1.312300, {0.9966, 0.9052, 0.8217}},
                             {10, 0.4, 3.985238033e-03, 1.293334, {0.9948, 0.8928, 0.8085}}};

/// Deflection under the contact [m].
double deflectionOf(double contrast, double distance)
{
    constexpr int    kCells = 128, kMiddle = kCells / 2;
    const PlateGrid  grid{kCells, kCells, 1.0 / kCells, 1.0 / kCells};
    const SpatialLaw wart{.kind    = SpatialLaw::Kind::gaussian,
                          .from    = 1,
                          .to      = contrast,
                          .centres = {{0.5 + distance, 0, 0.5}},
                          .width   = 0.1};
    Plate            plate{grid, {}, 0.2, 0, NodeField(grid)};
    for (int i = 0; i < grid.nodesX(); ++i)
        for (int j = 0; j < grid.nodesZ(); ++j) plate.rigidity(i, j) = wart({i * grid.spacingX, 0, j * grid.spacingZ});
    PlateSolver solver("host");
    return solver.solve(plate, gaussianLoad(grid, 1, 0.5, 0.5, 0.05), 1e-6).deflection(kMiddle, kMiddle);
}

TEST(Perception, AgreesWithAnIndependentScanPastAWart)
{
    constexpr double kGrid = 1e-3; // relative: second order, 0.02 to 0.06 % at 128 cells; the sums of the table differ
    const double     plain = deflectionOf(1, 0);
    for (const Scanned& s : kScan) {
        const double deflection = deflectionOf(s.contrast, s.distance);
        EXPECT_NEAR(deflection / s.deflection, 1, kGrid) << s.contrast << " at " << s.distance;
        EXPECT_NEAR(plain / deflection / s.ratio, 1, kGrid) << s.contrast << " at " << s.distance;
        for (std::size_t n = 0; n < kWeberFractions.size(); ++n) {
            const double steps = noticeableSteps(plain, deflection, kWeberFractions[n]);
            // p changes by at most 0.27 per step, a step is ln(1 + W) = 0.07 to 0.2 of the ratio's logarithm, and that
            // is good to 1e-3: 4e-3; measured 8e-4.
            EXPECT_NEAR(rightAnswers(steps), s.right[n], 2e-3) << s.contrast << " at " << s.distance;
        }
    }
}

TEST(Perception, OneStepIsToldInThreeOfFourTrialsAndNoneIsGuessed)
{
    EXPECT_EQ(rightAnswers(0), 0.5);
    EXPECT_NEAR(rightAnswers(1), 0.75, 1e-12) << "the constant has 17 digits";
    for (const double weber : kWeberFractions) {
        EXPECT_NEAR(noticeableSteps(1 + weber, 1, weber), 1, 1e-12) << "rounding of two logarithms";
        EXPECT_NEAR(noticeableSteps(1, 1 + weber, weber), 1, 1e-12) << "whichever comes first";
    }
}

TEST(Perception, TheLargestRangeWithinALengthIsThatOfAllPairs)
{
    std::vector<double> along, values;
    for (int n = 0; n < 200; ++n) { // to and fro, with steps of its own
        along.push_back(std::sin(0.07 * n));
        values.push_back(std::cos(0.31 * n) + 0.01 * n);
    }
    for (const double within : {0.0, 0.05, 0.3, std::numeric_limits<double>::infinity()}) {
        double all = 0;
        for (std::size_t a = 0; a < along.size(); ++a)
            for (std::size_t b = 0; b < along.size(); ++b)
                if (std::abs(along[a] - along[b]) <= within) all = std::max(all, values[a] - values[b]);
        EXPECT_EQ(largestRange(along, values, within), all) << within;
    }
    EXPECT_EQ(largestRange({}, {}, 1), 0);
}

} // namespace
} // namespace palp
