#include "engine/force/homogeneous_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

namespace palp {
namespace {

constexpr double kCell = 3e-3; // [m]

std::vector<HomogeneousLaw::Site> someSites()
{
    std::mt19937                           random(5);
    std::uniform_real_distribution<double> place(0, 0.03);
    std::vector<HomogeneousLaw::Site>      sites;
    for (int n = 0; n < 400; ++n) {
        const glm::dvec3 point(place(random), place(random), 0.2 * place(random));
        sites.push_back({point, -6 + 40 * point.x, 8 - 30 * point.y, 100 + 1000 * point.z});
    }
    return sites;
}

TEST(HomogeneousLaw, IsTheWeightedMeanOfAllSitesWithinOneCell)
{
    const auto           sites = someSites();
    const HomogeneousLaw law(sites, kCell, true);
    for (const HomogeneousLaw::Site& at : sites) {
        const glm::dvec3 place   = at.point + glm::dvec3(0.4e-3, -0.3e-3, 0.2e-3);
        double           weights = 0, compliance = 0, contact = 0, stiffening = 0;
        for (const HomogeneousLaw::Site& site : sites) {
            const glm::dvec3 away   = glm::abs(glm::floor(site.point / kCell) - glm::floor(place / kCell));
            const double     far    = glm::distance(site.point, place) / (1.5 * kCell);
            const double     weight = far < 1 ? std::pow(1 - far * far, 2) : 0;
            if (far * 1.5 > 1 && (away.x > 1 || away.y > 1 || away.z > 1)) continue; // which cubes it lies in decides
            weights += weight;
            compliance += weight * site.lnCompliance;
            contact += weight * site.lnContactStiffness;
            stiffening += weight * site.stiffening;
        }
        const auto found = law.at(place);
        ASSERT_TRUE(found.has_value());
        // Sites beyond one cell count or not by the cubes, whose corner is the law's own: at most 0.31 of a weight
        // each.
        EXPECT_NEAR(found->lnCompliance, compliance / weights, 0.02) << "of 1.2 over the object";
        EXPECT_NEAR(found->lnContactStiffness, contact / weights, 0.015) << "of 0.9";
        EXPECT_NEAR(found->stiffening.value(), stiffening / weights, 1) << "of 6";
        EXPECT_TRUE(found->clamped) << "it is no table's";
    }
}

TEST(HomogeneousLaw, ANearSiteCountsMoreThanAFarOne)
{
    const HomogeneousLaw law({{{0, 0, 0}, -6, 8, 0}, {{kCell, 0, 0}, -5, 9, 0}}, kCell);
    const auto           weight = [](double cells) { return std::pow(1 - cells * cells / 2.25, 2); };
    const double         share  = weight(0.8) / (weight(0.2) + weight(0.8));
    EXPECT_NEAR(law.at({0.2 * kCell, 0, 0})->lnCompliance, -6 + share, 1e-12) << "rounding";
    EXPECT_NEAR(law.at({0.2 * kCell, 0, 0})->lnContactStiffness, 8 + share, 1e-12) << "rounding";
    EXPECT_FALSE(law.at({0, 0, 0})->stiffening.has_value()) << "it is the scene's";
}

TEST(HomogeneousLaw, KnowsNothingWhereThereIsNoSite)
{
    const HomogeneousLaw law({{{0, 0, 0}, -6, 8, 0}}, kCell);
    EXPECT_TRUE(law.at({0.9 * kCell, 0, 0}).has_value());
    EXPECT_FALSE(law.at({3 * kCell, 0, 0}).has_value());
    EXPECT_FALSE(law.at({std::nan(""), 0, 0}).has_value());
}

} // namespace
} // namespace palp
