#include "engine/tools/fit/felt_fit.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "engine/perception/felt_map.h"
#include "engine/session/scene.h"
#include "tests/perception/thin_slab.h"
#include "tests/session/sheet_session.h"

namespace palp::fit {
namespace {

/// A sheet of 2000 points whose modulus rises from 0.2 to 0.8 MPa across, and the map that is felt on it.
struct SlowSheet {
    Scene         scene  = sheetScene(R"({"law": "exponential", "from": 0.2e6, "to": 0.8e6, "axis": "x"})");
    SoftObject    object = thinned();
    PlateSolver   solver{"host"};
    const FeltMap map = feltMap(object, scene.patch, 400, solver);

    SoftObject thinned()
    {
        scene.points = 2000;
        return loadObject(scene).object;
    }
    std::vector<double> measured(double noise, double factor = 1, std::uint64_t seed = 11) const
    {
        std::mt19937_64                  random(seed);
        std::normal_distribution<double> normal(0, noise);
        std::vector<double>              felt = map.atPoints;
        for (double& value : felt) value *= factor * std::exp(normal(random));
        return felt;
    }
    FeltFit fit(const std::vector<double>& felt)
    {
        return fitFeltMap(object.repainted(std::vector<double>(object.size(), kDefaultModulus)), felt,
                          {scene.patch, 400, 15, {}}, solver);
    }
};

/// Returns the median and the root mean square of ln(fitted / true), away from the sheet's sides.
std::pair<double, double> errors(const SlowSheet& sheet, const FeltFit& fit)
{
    constexpr double    kSide  = 0.6; // of half the sheet: windows farther out reach beyond it [1]
    const Bounds&       bounds = sheet.object.cloud().bounds();
    std::vector<double> logs;
    for (std::size_t n = 0; n < sheet.object.size(); ++n) {
        const glm::dvec3 p    = sheet.object.positions()[n] - bounds.centre();
        const glm::dvec3 half = 0.5 * (bounds.high - bounds.low);
        if (std::abs(p.x) < kSide * half.x && std::abs(p.y) < kSide * half.y)
            logs.push_back(std::log(fit.object.cloud().stiffness()[n] / sheet.object.cloud().stiffness()[n]));
    }
    double squares = 0;
    for (const double value : logs) squares += value * value;
    const auto middle = logs.begin() + std::ptrdiff_t(logs.size() / 2);
    std::nth_element(logs.begin(), middle, logs.end());
    return {*middle, std::sqrt(squares / double(logs.size()))};
}

TEST(FeltFit, AnExactMapGivesTheObjectBackWhereItVariesSlowly)
{
    SlowSheet     sheet;
    const FeltFit fit          = sheet.fit(sheet.measured(0));
    const auto [middle, error] = errors(sheet, fit);

    EXPECT_LT(fit.unsettled, 2e-3);
    EXPECT_LE(fit.steps, 10) << "an error loses two thirds in a step";
    EXPECT_LT(error, 0.02);
    EXPECT_LT(fit.rest, 5e-3) << "nothing is left of a map that an object made";
}

TEST(FeltFit, ANoisyMapGivesItBackToFivePerCentAndDoesNotFollowTheNoise)
{
    SlowSheet sheet;
    for (const std::uint64_t seed : {11, 12, 13}) {
        const FeltFit fit          = sheet.fit(sheet.measured(0.10, 1, seed));
        const auto [middle, error] = errors(sheet, fit);

        EXPECT_LT(error, 0.05) << seed;
        // The median size of noise of deviation 0.1 is 0.067: what is left is the noise.
        EXPECT_NEAR(fit.rest, 0.067, 0.012) << seed;
        EXPECT_EQ(fit.residual.size(), sheet.object.size());
    }
}

TEST(FeltFit, AMapThatIsTwiceAsStiffNeedsAModulusThatIsMoreThanTwiceAsHigh)
{
    SlowSheet     sheet;
    const FeltFit fit          = sheet.fit(sheet.measured(0, 2));
    const auto [middle, error] = errors(sheet, fit);

    EXPECT_LT(fit.rest, 0.01);
    EXPECT_GT(middle, std::log(2.0)) << "the plate on its foundation feels like the root of its modulus";
    EXPECT_LT(middle, std::log(4.5));
}

/// What was felt on one face is no matter of the other's, though both lie within a fingertip.
TEST(FeltFit, TheFacesOfAThinBodyAreFittedApart)
{
    const ThinSlab      slab;
    const SoftObject    object = ThinSlab::object();
    PlateSolver         solver("host");
    const FeltMap       map = feltMap(object, slab.settings, 400, solver);
    const FeltFit       fit = fitFeltMap(ThinSlab::object(true), map.atPoints, {slab.settings, 400, 15, {}}, solver);
    std::vector<double> upper, lower; // [Pa]
    for (std::size_t n = 0; n < object.size(); ++n)
        if (ThinSlab::isInside(object.positions()[n]))
            (object.positions()[n].z > 0 ? upper : lower).push_back(fit.object.cloud().stiffness()[n]);
    for (std::vector<double>* const face : {&upper, &lower}) std::ranges::sort(*face);
    EXPECT_NEAR(upper[upper.size() / 2] / ThinSlab::kUpper, 1, 0.1);
    EXPECT_NEAR(lower[lower.size() / 2] / ThinSlab::kLower, 1, 0.1) << "together they would be 0.4 MPa";
    EXPECT_LT(fit.rest, 0.02);
}

TEST(FeltFit, OneOddPointIsLeftAsResidual)
{
    SlowSheet           sheet;
    std::vector<double> felt = sheet.measured(0);
    const auto          at   = sheet.object.positions();
    std::size_t         odd  = 0; // the point nearest to the middle
    for (std::size_t n = 0; n < at.size(); ++n)
        if (std::hypot(at[n].x, at[n].y) < std::hypot(at[odd].x, at[odd].y)) odd = n;
    felt[odd] *= 3;
    const FeltFit fit = sheet.fit(felt);

    EXPECT_LT(fit.residual[odd], -0.55) << "a third of what was measured, but for what the mean takes up";
    EXPECT_LT(fit.object.cloud().stiffness()[odd] / sheet.object.cloud().stiffness()[odd], 1.6);
}

} // namespace
} // namespace palp::fit
