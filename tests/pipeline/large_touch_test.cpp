#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/core/quantity.h"
#include "engine/pipeline/deform.h"
#include "engine/pipeline/detail/shell_patch.h"
#include "engine/pipeline/patch_warnings.h"
#include "engine/pipeline/press.h"
#include "engine/plate/load.h"
#include "engine/plate/reference/reference_large_shell.h"

// Touches that press a sheet further than it is thick.

namespace palp {
namespace {

constexpr Material kSkin{.thickness = 1e-3, .poissonRatio = 0.45};
const PlateEdges   kSupported{Edge::supported, Edge::supported, Edge::supported, Edge::supported};

/// A sheet z = height(x, y), 30 mm to each side.
SoftObject sheet(const std::function<double(double, double)>& height)
{
    std::mt19937                           random(3);
    std::uniform_real_distribution<double> along(-40e-3, 40e-3);
    std::vector<glm::dvec3>                points;
    for (int n = 0; n < 6400; ++n) {
        const double x = along(random), y = along(random);
        points.emplace_back(x, y, height(x, y));
    }
    std::vector<double> moduli(points.size(), 1e6);
    return SoftObject(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus), kSkin);
}

SoftObject flat()
{
    return sheet([](double, double) { return 0; });
}

SoftObject dome()
{
    return sheet([](double x, double y) { return std::sqrt(80e-3 * 80e-3 - x * x - y * y) - 80e-3; });
}

Patch touched(const SoftObject& object, PatchSettings settings)
{
    PlateSolver host("host");
    settings.cells = 32;
    return deform(object, touchAt(object, {0, 0, 0}, glm::dvec3(0, 0, 1), 10e-3), settings, host);
}

const PatchSettings kPlate{.large = Large::on};
const PatchSettings kShell{.theory = Theory::shell, .large = Large::on, .edges = kSupported};

TEST(LargeTouch, SaysWhichForceStaysWithinItsLaw)
{
    const Patch patch = touched(dome(), kShell);
    // The middle of a dent is deeper than its mean under the finger, of which the law is.
    const double mean = patch.large->reach() / (patch.large->tangent.front() * mostResponse(patch)); // [m]
    const double most = patch.large->forceAt(mean);                                                  // [N]
    const auto   said = [&](double force) {
        const auto sentences = warnings(patch, kShell, force, kSkin);
        return std::ranges::any_of(sentences, [&](const std::string& s) {
            return s.find("press with less than " + formatQuantity(most, "N")) != std::string::npos;
        });
    };
    EXPECT_TRUE(said(1.01 * most));
    EXPECT_FALSE(said(0.99 * most));

    Patch stiffens      = patch;
    stiffens.stiffening = 200; // [1/m]
    const double more   = forceToDent(stiffens, mean);
    EXPECT_GT(more, 1.01 * most);
    EXPECT_NEAR(pressOf(stiffens, kSkin, more).load * mostResponse(stiffens) / patch.large->reach(), 1, 1e-3)
        << "what a shape of some steps interpolates";
}

TEST(LargeTouch, OffAndOnAgreeOnEverythingLinear)
{
    PatchSettings off = kShell;
    off.large         = Large::off;
    const Patch with = touched(dome(), kShell), without = touched(dome(), off);
    EXPECT_EQ(with.compliance, without.compliance);
    EXPECT_EQ(with.feltStiffness, without.feltStiffness);
    EXPECT_EQ(with.response.values(), without.response.values());
    EXPECT_FALSE(without.large);
    EXPECT_TRUE(depthLawOf(without).isSpring());
    EXPECT_DOUBLE_EQ(depthLawOf(with).tangent(0), with.feltStiffness); // the same quotient, otherwise rounded
}

TEST(LargeTouch, IsContactAndAllEquationsInSeries)
{
    for (const auto& [object, settings] : {std::pair{flat(), kPlate}, std::pair{dome(), kShell}}) {
        const Patch patch = touched(object, settings);
        ASSERT_TRUE(patch.large) << patch.linearBecause;
        const NodeField load = footprintLoad(patch.plate.grid, 1, patch.plate.grid.sizeX() / 2,
                                             patch.plate.grid.sizeZ() / 2, settings.footprintRadius);
        const DepthLaw  law  = depthLawOf(patch);
        const double    rest = 1 / patch.feltStiffness - dot(load, patch.response); // contact, and shear of a shell
        for (const LargeState& state :
             pressDeep(shellOf(patch), load, std::array{0.25e-3, 0.5e-3, 0.75e-3, 1e-3, 1.25e-3, 1.5e-3}))
            // The law of three shapes is right to 1.5 %, its knots to half a percent.
            EXPECT_NEAR(law.force(state.depth + state.force * rest) / state.force, 1, 0.02) << state.depth;
    }
}

TEST(LargeTouch, ADentIsDrawnAsDeepAsItIs)
{
    const Patch  patch = touched(flat(), kPlate);
    const double force = patch.large->forceAt(1e-3);
    const Press  press = pressOf(patch, kSkin, force);
    EXPECT_NEAR(press.load / patch.large->tangent.front(), 1e-3, 0.02e-3); // of knots
    EXPECT_LT(press.depth, 0.7 * force / patch.feltStiffness);             // it has hardened
}

TEST(LargeTouch, BeyondTwoThicknessesItIsNotTrusted)
{
    const Patch patch = touched(flat(), kPlate);
    const auto  said  = [&](double depth) {
        for (const std::string& line : warnings(patch, kPlate, patch.large->forceAt(depth), kSkin))
            if (line.find("twice the thickness") != std::string::npos) return true;
        return false;
    };
    EXPECT_FALSE(said(1.7e-3));
    EXPECT_TRUE(said(2.2e-3));
}

TEST(LargeTouch, SaysWhyItStaysLinear)
{
    PatchSettings contact = kPlate;
    contact.forceLaw      = ForceLaw::paper;
    const Patch patch     = touched(flat(), contact);
    EXPECT_FALSE(patch.large);
    EXPECT_NE(patch.linearBecause.find("does not feel the plate"), std::string::npos);
    EXPECT_TRUE(depthLawOf(patch).isSpring());
}

TEST(LargeTouch, OfATableItIsThatOfTheTouch)
{
    for (const auto& [object, settings] : {std::pair{flat(), kPlate}, std::pair{dome(), kShell}}) {
        PatchSettings fine = settings;
        fine.cells         = 64;
        PlateSolver            host("host");
        const FootprintLattice lattice = footprintLattice(object, fine, 3, host);
        const Contact          contact = touchAt(object, {0, 0, 0}, glm::dvec3(0, 0, 1), 10e-3);
        const Patch            one     = deform(object, contact, fine, host);
        const PatchWithTable   table   = deformWithTable(object, contact, fine, lattice, host);
        ASSERT_TRUE(one.large && table.patch.large);
        EXPECT_NEAR(table.patch.large->tangent.front() / one.large->tangent.front(), 1, 1e-4); // works of tables
        for (std::size_t n = 1; n < one.large->force.size(); ++n) // the grid is twice as coarse: measured 0.4 %
            EXPECT_NEAR(table.patch.large->force[n] / one.large->force[n], 1, 0.01) << n;
    }
}

} // namespace
} // namespace palp
