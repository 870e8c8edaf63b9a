#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/contact/contact.h"
#include "engine/core/contract.h"
#include "engine/pipeline/deform.h"
#include "engine/pipeline/homogeneous_sites.h"
#include "engine/session/scene.h"
#include "tests/support/temporary_folder.h"

// Tissue below the sheet: nodules and volumes of moduli.

namespace palp {
namespace {

/// A ball in the tissue below a sheet, and what it does to the felt stiffness.
struct Solid {
    double sheet;      ///< thickness [mm]
    double skin, fat;  ///< moduli [kPa]
    double finger;     ///< radius [mm]
    double tissue;     ///< thickness [mm]
    double foundation; ///< with which the touch without a nodule feels like the solid [MPa/m]
    double radius;     ///< of the nodule [mm]
    double top;        ///< of the nodule below the sheet [mm]
    double ratio;      ///< of its modulus to the tissue's [1]
    double truth;      ///< felt stiffness over that without the nodule [1]
};

// clang-format off
/// Computed by CalculiX 2.20 with solids/nodule_solids.py, mesh error 0.4 %.
constexpr Solid kSolids[] = {
    {2, 300, 20, 2.4, 15, 3.409, 5, 1, 50, 1.7046},
    {2, 300, 20, 2.4, 15, 3.409, 2.5, 1, 50, 1.1520},
    {2, 300, 20, 2.4, 15, 3.409, 5, 3, 50, 1.3115},
    {2, 300, 20, 2.4, 15, 3.409, 5, 5, 50, 1.1871},
    {2, 300, 20, 2.4, 15, 3.409, 7, 1, 5, 1.5935},
    {2, 300, 20, 2.4, 15, 3.409, 5, 1, 0.1, 0.8014},
    {2, 300, 20, 2.4, 15, 3.409, 5, 3, 0.1, 0.8714},
    {4, 300, 20, 2.4, 15, 3.429, 5, 1, 50, 1.2748},
    {4, 300, 20, 2.4, 15, 3.429, 2.5, 1, 50, 1.0481},
    {4, 300, 20, 2.4, 15, 3.429, 5, 3, 50, 1.1593},
    {4, 300, 20, 2.4, 15, 3.429, 5, 5, 50, 1.1157},
    {4, 300, 20, 2.4, 15, 3.429, 7, 1, 5, 1.2806},
    {4, 300, 20, 2.4, 15, 3.429, 5, 1, 0.1, 0.9116},
    {4, 300, 20, 2.4, 15, 3.429, 5, 3, 0.1, 0.9331},
    {1.5, 100, 10, 2.4, 15, 2.162, 5, 1, 50, 1.9510},
    {1.5, 100, 10, 2.4, 15, 2.162, 2.5, 1, 50, 1.2484},
    {1.5, 100, 10, 2.4, 15, 2.162, 5, 3, 50, 1.3494},
    {1.5, 100, 10, 2.4, 15, 2.162, 5, 5, 50, 1.1851},
    {1.5, 100, 10, 2.4, 15, 2.162, 7, 1, 5, 1.7288},
    {1.5, 100, 10, 2.4, 15, 2.162, 5, 1, 0.1, 0.7266},
    {1.5, 100, 10, 2.4, 15, 2.162, 5, 3, 0.1, 0.8448},
    {2, 300, 20, 4, 15, 3.326, 5, 1, 50, 1.7888},
    {2, 300, 20, 4, 15, 3.326, 2.5, 1, 50, 1.1504},
    {2, 300, 20, 4, 15, 3.326, 5, 3, 50, 1.3695},
    {2, 300, 20, 4, 15, 3.326, 5, 5, 50, 1.2264},
    {2, 300, 20, 4, 15, 3.326, 7, 1, 5, 1.6980},
    {2, 300, 20, 4, 15, 3.326, 5, 1, 0.1, 0.7872},
    {2, 300, 20, 4, 15, 3.326, 5, 3, 0.1, 0.8562},
    {2, 300, 20, 4, 25, 2.688, 5, 1, 50, 1.5660},
    {2, 300, 20, 4, 25, 2.688, 2.5, 1, 50, 1.1270},
    {2, 300, 20, 4, 25, 2.688, 5, 3, 50, 1.2464},
    {2, 300, 20, 4, 25, 2.688, 5, 5, 50, 1.1359},
    {2, 300, 20, 4, 25, 2.688, 7, 1, 5, 1.5117},
    {2, 300, 20, 4, 25, 2.688, 5, 1, 0.1, 0.8166},
    {2, 300, 20, 4, 25, 2.688, 5, 3, 0.1, 0.8807},
    {4, 300, 20, 4, 15, 2.734, 5, 1, 50, 1.3267},
    {4, 300, 20, 4, 15, 2.734, 2.5, 1, 50, 1.0529},
    {4, 300, 20, 4, 15, 2.734, 5, 3, 50, 1.1932},
    {4, 300, 20, 4, 15, 2.734, 5, 5, 50, 1.1414},
    {4, 300, 20, 4, 15, 2.734, 7, 1, 5, 1.3436},
    {4, 300, 20, 4, 15, 2.734, 5, 1, 0.1, 0.8987},
    {4, 300, 20, 4, 15, 2.734, 5, 3, 0.1, 0.9217},
    {4, 300, 20, 4, 25, 1.935, 5, 1, 50, 1.2206},
    {4, 300, 20, 4, 25, 1.935, 2.5, 1, 50, 1.0421},
    {4, 300, 20, 4, 25, 1.935, 5, 3, 50, 1.1171},
    {4, 300, 20, 4, 25, 1.935, 5, 5, 50, 1.0764},
    {4, 300, 20, 4, 25, 1.935, 7, 1, 5, 1.2287},
    {4, 300, 20, 4, 25, 1.935, 5, 1, 0.1, 0.9218},
    {4, 300, 20, 4, 25, 1.935, 5, 3, 0.1, 0.9414},
    {1.5, 100, 10, 4, 15, 2.022, 5, 1, 50, 2.0851},
    {1.5, 100, 10, 4, 15, 2.022, 2.5, 1, 50, 1.2378},
    {1.5, 100, 10, 4, 15, 2.022, 5, 3, 50, 1.4370},
    {1.5, 100, 10, 4, 15, 2.022, 5, 5, 50, 1.2382},
    {1.5, 100, 10, 4, 15, 2.022, 7, 1, 5, 1.8836},
    {1.5, 100, 10, 4, 15, 2.022, 5, 1, 0.1, 0.7090},
    {1.5, 100, 10, 4, 15, 2.022, 5, 3, 0.1, 0.8229},
    {1.5, 100, 10, 4, 25, 1.735, 5, 1, 50, 1.8077},
    {1.5, 100, 10, 4, 25, 1.735, 2.5, 1, 50, 1.2064},
    {1.5, 100, 10, 4, 25, 1.735, 5, 3, 50, 1.3104},
    {1.5, 100, 10, 4, 25, 1.735, 5, 5, 50, 1.1543},
    {1.5, 100, 10, 4, 25, 1.735, 7, 1, 5, 1.6827},
    {1.5, 100, 10, 4, 25, 1.735, 5, 1, 0.1, 0.7379},
    {1.5, 100, 10, 4, 25, 1.735, 5, 3, 0.1, 0.8468},
    {2, 300, 20, 6, 15, 3.223, 5, 1, 50, 1.7747},
    {2, 300, 20, 6, 15, 3.223, 2.5, 1, 50, 1.1316},
    {2, 300, 20, 6, 15, 3.223, 5, 3, 50, 1.4120},
    {2, 300, 20, 6, 15, 3.223, 5, 5, 50, 1.2653},
    {2, 300, 20, 6, 15, 3.223, 7, 1, 5, 1.7518},
    {2, 300, 20, 6, 15, 3.223, 5, 1, 0.1, 0.7833},
    {2, 300, 20, 6, 15, 3.223, 5, 3, 0.1, 0.8457},
    {4, 300, 20, 6, 15, 2.687, 5, 1, 50, 1.3469},
    {4, 300, 20, 6, 15, 2.687, 2.5, 1, 50, 1.0519},
    {4, 300, 20, 6, 15, 2.687, 5, 3, 50, 1.2161},
    {4, 300, 20, 6, 15, 2.687, 5, 5, 50, 1.1618},
    {4, 300, 20, 6, 15, 2.687, 7, 1, 5, 1.3829},
    {4, 300, 20, 6, 15, 2.687, 5, 1, 0.1, 0.8916},
    {4, 300, 20, 6, 15, 2.687, 5, 3, 0.1, 0.9139},
    {1.5, 100, 10, 6, 15, 1.839, 5, 1, 50, 2.0195},
    {1.5, 100, 10, 6, 15, 1.839, 2.5, 1, 50, 1.1921},
    {1.5, 100, 10, 6, 15, 1.839, 5, 3, 50, 1.5012},
    {1.5, 100, 10, 6, 15, 1.839, 5, 5, 50, 1.2942},
    {1.5, 100, 10, 6, 15, 1.839, 7, 1, 5, 1.9430},
    {1.5, 100, 10, 6, 15, 1.839, 5, 1, 0.1, 0.7100},
    {1.5, 100, 10, 6, 15, 1.839, 5, 3, 0.1, 0.8092},
};
/// The same, of solids to which nothing was fitted.
constexpr Solid kHeldOut[] = {
    {3, 200, 30, 3.6, 20, 4.312, 4, 2, 20, 1.1668},
    {1.2, 500, 15, 3, 12, 3.15, 3, 0.8, 100, 1.4861},
    {2.5, 150, 5, 5, 30, 0.4834, 8, 4, 10, 1.2694},
    {2, 300, 20, 4, 15, 3.326, 4, 1.6, 0.3, 0.9048},
};
// clang-format on

std::string number(double value)
{
    return std::to_string(value);
}

std::string belowOf(const Solid& s)
{
    return R"({"depth": ")" + number(s.tissue) + R"( mm", "modulus": ")" + number(s.fat) +
           R"( kPa", "nodules": [{"at": [0, 0, 0], "depth": ")" + number(s.sheet + s.top + s.radius) +
           R"( mm", "radius": ")" + number(s.radius) + R"( mm", "modulus": ")" + number(s.fat * s.ratio) +
           R"( kPa"}]})";
}

/// A sheet of the solid's skin, with `below` in its tissue.
Scene sceneOf(const Solid& s, const std::string& below)
{
    return parseScene(R"({"cloud": "sample:sheet", "points": 60000, "poisson": 0.45, "window": "60 mm", "cells": 64})",
                      "a test", ".",
                      {.flags = {{"thickness", number(s.sheet) + " mm"},
                                 {"stiffness", "constant:value=" + number(1e3 * s.skin)},
                                 {"foundation", number(s.foundation) + " MPa/m"},
                                 {"footprint_radius", number(s.finger) + " mm"},
                                 {"below", below}}});
}

double feltOn(const SoftObject& object, const Scene& scene, const glm::dvec3& place = {0, 0, 0})
{
    PlateSolver solver("host");
    return deform(object, touchAt(object, place, glm::dvec3(0, 0, 1), 0.5), scene.patch, solver).feltStiffness;
}

/// Sheets without a nodule, one for each skin, finger and tissue, and the felt stiffness over them.
double contrastOf(const Solid& s)
{
    static std::optional<SoftObject> sheet; // the last one
    static Scene                     plain;
    static double                    felt = 0;
    if (const Scene wanted = sceneOf(s, "none"); !sheet || sceneJson(wanted) != sceneJson(plain)) {
        plain = wanted;
        sheet = loadObject(plain).object;
        felt  = feltOn(*sheet, plain);
    }
    const Scene scene = sceneOf(s, belowOf(s));
    return feltOn(onTissue(*sheet, scene), scene) / felt;
}

/// The bars are the worst and the root mean square of the fit, 0.10 and 0.042, and what a random sheet adds,
/// whose points are 0.6 mm apart.
TEST(Below, ANoduleIsFeltAsInASolid)
{
    double squares = 0;
    for (const Solid& s : kSolids) {
        const double off = std::log(contrastOf(s) / s.truth);
        EXPECT_LT(std::abs(off), 0.13) << s.sheet << " mm of skin, finger " << s.finger << " mm, tissue " << s.tissue
                                       << " mm, nodule " << s.radius << " mm, " << s.top << " mm deep, x " << s.ratio
                                       << ": " << contrastOf(s) << " for " << s.truth;
        squares += off * off;
    }
    EXPECT_LT(std::sqrt(squares / double(std::size(kSolids))), 0.055);
}

TEST(Below, ANoduleIsFeltAsInSolidsToWhichNothingWasFitted)
{
    for (const Solid& s : kHeldOut) EXPECT_NEAR(std::log(contrastOf(s) / s.truth), 0, 0.15) << s.sheet << " mm";
}

TEST(Below, ANoduleIsFeltAboveItAlone)
{
    const Solid&     s      = kSolids[0];
    const Scene      scene  = sceneOf(s, belowOf(s));
    const SoftObject object = loadObject(scene).object;
    const double     plain  = feltOn(object.withFoundation({}), scene, {30e-3, 0, 0});
    EXPECT_NEAR(feltOn(object, scene, {30e-3, 0, 0}) / plain, 1, 1e-3) << "six radii away";
}

class BelowVolume : public testing::Test {
protected:
    /// Moduli over 60 x 60 x 30 mm about the origin, every 2 mm along z, uniform along x and y.
    template <class Modulus>
    std::string volumeOf(const Modulus& modulus, const std::string& low = "-0.03", const std::string& more = "") const
    {
        constexpr int kLayers = 31;
        std::string   header  = "{'descr': '<f8', 'fortran_order': True, 'shape': (2, 2, 31), }";
        header.resize(117, ' ');
        std::string bytes = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n";
        for (int k = 0; k < kLayers; ++k)
            for (int n = 0; n < 4; ++n) {
                const double value = modulus(-30e-3 + 1e-3 * k);
                bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
            }
        static_cast<void>(folder_.write("fat.npy", bytes));
        return R"({"depth": "15 mm", "modulus": "20 kPa", "volume": {"law": "grid", "file": ")" +
               (folder_ / "fat.npy").string() + R"(", "origin": [-0.1, -0.1, )" + low +
               R"(], "spacing": [0.2, 0.2, 1e-3])" + more + "}}";
    }

    /// Shape of the foundation at the middle of a sheet that lies at z = 0 with its tissue below.
    template <class Modulus>
    double shapeOf(const Modulus& modulus) const
    {
        const SoftObject object = loadObject(sceneOf(kSolids[0], volumeOf(modulus))).object;
        return object.foundationShape()[object.index().nearest({0, 0, 0}, 1).front().point];
    }

    TemporaryFolder folder_;
};

TEST_F(BelowVolume, ComesBackFromTheTextOfItsScene)
{
    std::string below = volumeOf([](double) { return 2e4; });
    below.pop_back();
    const Scene scene =
        sceneOf(kSolids[0], below + R"(, "nodules": [{"at": "1mm,0,2mm", "depth": 8e-3, "radius": "5 mm",
                                                                    "modulus": "1 MPa"}]})");
    const Scene again = parseScene(sceneJson(scene), "again", ".");

    EXPECT_EQ(again.below.tissue.depth, 15e-3);
    EXPECT_EQ(again.below.tissue.modulus, 2e4);
    ASSERT_EQ(again.below.tissue.nodules.size(), 1u);
    EXPECT_EQ(again.below.tissue.nodules[0], (BuriedNodule{{1e-3, 0, 2e-3}, 8e-3, 5e-3, 1e6}));
    EXPECT_EQ(belowJson(again.below), belowJson(scene.below));
    EXPECT_FALSE(haveSameCloud(scene, sceneOf(kSolids[0], "none")));
}

TEST_F(BelowVolume, OfEvenTissueChangesNothingButTheScale)
{
    EXPECT_NEAR(shapeOf([](double) { return 20e3; }), 1, 1e-12) << "rounding";
    EXPECT_NEAR(shapeOf([](double) { return 50e3; }), 2.5, 1e-12) << "rounding";
}

TEST_F(BelowVolume, CountsMostNearTheSkin)
{
    const auto softFrom = [](double from, double to) {
        return [=](double z) { return z < -from && z > -to ? 5e3 : 20e3; };
    };
    const double near = shapeOf(softFrom(3e-3, 7e-3)), deep = shapeOf(softFrom(12e-3, 16e-3));
    EXPECT_LT(near, 0.6);
    EXPECT_GT(deep, 0.75);
    EXPECT_LT(deep, 1);
}

TEST_F(BelowVolume, OfLayersIsTheirSeriesByTheEnergyOfEvenTissue)
{
    // Sheet of 2 mm, so the tissue is from -2 to -17 mm; stiff below -9.5 mm, half way between two values of the file.
    const double q = 0.45 / (2e-3 + 2.4e-3 / 2), H = 15e-3, edge = 7.5e-3;
    const auto   left  = [&](double z) { return 2 * q * (H - z) + std::sinh(2 * q * (H - z)); };
    const double above = 1 - left(edge) / left(0), expected = 1 / (above + (1 - above) / 10);
    EXPECT_NEAR(shapeOf([](double z) { return z < -9.5e-3 ? 200e3 : 20e3; }), expected, 0.02 * expected)
        << "the file's values go from one to the other within a millimetre";
}

TEST_F(BelowVolume, WithoutAValueIsRefusedByPlace)
{
    std::string below = volumeOf([](double) { return 20e3; });
    below.replace(below.find("15 mm"), 5, "40 mm");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(loadObject(sceneOf(kSolids[0], below))); }),
                      {"below", "the tissue below point 0", "fat.npy"}));
}

/// The sheet's points have no normals, so that only the volume knows on which side of it the tissue lies.
TEST_F(BelowVolume, LiesOnTheSideWhereMoreWasMeasured)
{
    const auto shapes = [](const std::string& below) {
        const SoftObject object = loadObject(sceneOf(kSolids[0], below)).object;
        return std::ranges::minmax(object.foundationShape());
    };
    const auto even          = [](double) { return 50e3; };
    const auto [least, most] = shapes(volumeOf(even, "-0.03", R"(, "outside": 2e3)"));
    EXPECT_NEAR(least, 2.5, 1e-6) << "what is said of elsewhere was not measured";
    EXPECT_NEAR(most, 2.5, 1e-6) << "the file has floats";
    const auto [same, asMuch] = shapes(volumeOf(even, "-0.015", R"(, "outside": 5e4)"));
    EXPECT_NEAR(same, 2.5, 1e-6) << "both sides are alike";
    EXPECT_NEAR(asMuch, 2.5, 1e-6);
    const std::string both =
        volumeOf([](double z) { return z < -15e-3 ? 50e3 : 2e3; }, "-0.015", R"(, "outside": 5e4)");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(loadObject(sceneOf(kSolids[0], both))); }),
                      {"fat.npy", "on which side of the tissue below point 0", "normals or faces"}));
}

/// Under a dome whose points have no normals a nodule lies inside, at every place.
TEST_F(BelowVolume, ANoduleLiesInsideADomeWithoutNormals)
{
    constexpr int    kPoints = 12000;
    constexpr double kRadius = 50e-3; // [m]
    std::string      points;
    for (int n = 0; n < kPoints; ++n) {
        const double z = 1 - (n + 0.5) / kPoints, angle = n * std::numbers::pi * (1 + std::sqrt(5.0));
        const double r = std::sqrt(1 - z * z);
        points += number(1e3 * kRadius * r * std::cos(angle)) + " " + number(1e3 * kRadius * r * std::sin(angle)) +
                  " " + number(1e3 * kRadius * z) + "\n";
    }
    const std::string   cloud = folder_.write("dome.xyz", points).string();
    std::vector<double> largest;
    for (int n = 0; n < 8; ++n) {
        const double      z = 0.95 - 0.08 * n, r = std::sqrt(1 - z * z), angle = 2.4 * n;
        const std::string at = number(1e3 * kRadius * r * std::cos(angle)) + "mm," +
                               number(1e3 * kRadius * r * std::sin(angle)) + "mm," + number(1e3 * kRadius * z) + "mm";
        const SoftObject object = loadObject(parseScene(R"({"cloud": ")" + cloud +
                                                            R"(", "length_unit": "mm", "stiffness": {"law": "constant",
                "value": 3e5}, "thickness": "2 mm", "foundation": "1 MPa/m", "below": {"depth": "15 mm", "modulus":
                "20 kPa", "nodules": [{"at": ")" + at + R"(", "depth": "8.5 mm", "radius": "3.5 mm", "modulus":
                "1 MPa"}]}})",
                                                        "a test", "."))
                                      .object;
        double sum = 0; // what the nodule adds, which is more where columns draw together
        for (const double shape : object.foundationShape()) sum += shape - 1;
        largest.push_back(sum);
    }
    const auto [least, most] = std::ranges::minmax(largest);
    EXPECT_GT(least, 0);
    EXPECT_LT(most / least, 1.1) << "above the dome it is under 1.4 to 2 times as few points";
}

TEST(Below, TheFirstTouchAndTheTableKnowTheNodule)
{
    const Solid&     s      = kSolids[21]; // felt 1.8 times as stiff
    const Scene      scene  = sceneOf(s, belowOf(s));
    const SoftObject object = loadObject(scene).object;
    PlateSolver      solver("host");
    const auto       lattice = footprintLattice(object, scene.patch, 3, solver);
    const Contact    contact = touchAt(object, {0, 0, 0}, glm::dvec3(0, 0, 1), 0.5);
    const double     table   = deformWithTable(object, contact, scene.patch, lattice, solver, {}).patch.compliance;
    const double     touch   = deform(object, contact, scene.patch, solver).compliance;
    EXPECT_NEAR(table / touch, 1, 1e-3) << "both are solved to 1e-4";

    const HomogeneousLaw first = homogeneousLaw(object, lattice, scene.patch);
    const auto           at    = first.at(contact.point);
    EXPECT_NEAR(std::exp(at->lnCompliance) / touch, 1, 0.25) << "as good as beside a wart: right to 15 %, and a jump";
}

TEST(Below, WhatLeavesTheRangeOfTheSolidsIsSaid)
{
    const auto said = [](const std::string& keys, const std::string& nodule, const char* depth = "15 mm") {
        const Scene scene = parseScene(R"({"cloud": "sample:sheet", "foundation": "3.3 MPa/m", )" + keys +
                                           R"(, "below": {"depth": ")" + depth + R"(", "modulus": "20 kPa")" +
                                           (nodule.empty() ? "" : R"(, "nodules": [)" + nodule + "]") + "}}",
                                       "scene", ".");
        return beyondComparedTissue(scene);
    };
    const std::string known  = R"("thickness": "2 mm", "footprint_radius": "4 mm")";
    const std::string nodule = R"({"at": [0, 0, 0], "depth": "8 mm", "radius": "5 mm", "modulus": "1 MPa"})";
    EXPECT_TRUE(said(known, nodule).empty()) << said(known, nodule).front();
    EXPECT_TRUE(said(known, "").empty()) << "without a nodule there is nothing to guess";
    EXPECT_TRUE(said(R"("thickness": "1 mm", "footprint_radius": "9 mm")", "").empty());

    const auto one = [&](const std::vector<std::string>& found, const char* words) {
        ASSERT_EQ(found.size(), 1U) << words;
        EXPECT_NE(found[0].find(words), std::string::npos) << found[0];
    };
    one(said(R"("thickness": "2 mm", "footprint_radius": "7 mm")", nodule), "fingertip's radius is 7.00 mm");
    one(said(R"("thickness": "1.4 mm", "footprint_radius": "4 mm")", nodule), "sheet over the tissue is 1.40 mm");
    one(said(known, nodule, "30 mm"), "depth of the tissue is 30.0 mm");
    one(said(known, R"({"at": [0, 0, 0], "depth": "8 mm", "radius": "2 mm", "modulus": "1 MPa"})"),
        "radius of nodule 1");
    one(said(known, nodule + R"(, {"at": [0, 0, 0], "depth": "13 mm", "radius": "5 mm", "modulus": "1 MPa"})"),
        "top of nodule 2 is 6.00 mm, and solids were computed for 1.00 mm to 5.00 mm");
    one(said(known, R"({"at": [0, 0, 0], "depth": "8 mm", "radius": "5 mm", "modulus": "1.1 MPa"})"), "is 55.0");
}

TEST(Below, WhatIsWrongIsSaidInOneSentence)
{
    const auto refused = [](const std::string& below, std::initializer_list<const char*> words) {
        const std::string said =
            refusalOf([&] { static_cast<void>(loadObject(sceneOf(kSolids[0], below)).object.size()); });
        EXPECT_NE(said, "") << below;
        for (const char* word : words) EXPECT_NE(said.find(word), std::string::npos) << said;
    };
    const auto nodule = [](const std::string& with) {
        return R"({"depth": "15 mm", "modulus": 2e4, "nodules": [{)" + with + "}]}";
    };
    refused("[]", {"below", "object"});
    refused(R"({"modulus": 2e4})", {"\"depth\"", "missing"});
    refused(R"({"depth": "15 N", "modulus": 2e4})", {"depth", "15 N"});
    refused(R"({"depth": 0, "modulus": 2e4})", {"depth", "from 1e-5 to 1 m"});
    refused(R"({"depth": 0.01, "modulus": -2})", {"modulus", "-2"});
    refused(R"({"depth": 0.01, "modulus": 2e4, "nodule": []})", {"\"nodule\"", "did you mean", "nodules"});
    refused(R"({"depth": 0.01, "modulus": 2e4, "nodules": []})", {"nodules", "1 to 64"});
    refused(R"({"depth": 0.01, "modulus": 2e4, "nodules": [7]})", {"nodule 1", "object"});
    refused(R"({"depth": 0.01, "modulus": 2e4, "volume": "linear:from=1,to=2"})", {"volume", "grid"});
    refused(nodule(R"("at": [0,0,0], "radius": 5e-3, "modulus": 1e6)"), {"nodule 1", "depth", "missing"});
    refused(nodule(R"("at": [0,0,0], "depth": 8e-3, "radius": 5e-3, "modulus": 1e6, "modulos": 1)"),
            {"nodule 1", "unknown key \"modulos\""});
    refused(nodule(R"("at": [0,0,0], "depth": 5e-3, "radius": 5e-3, "modulus": 1e6)"),
            {"nodule 1", "underside at 2.00 mm", "from 0 m to 10.0 mm"});
    refused(nodule(R"("at": [0,0,0], "depth": 14e-3, "radius": 5e-3, "modulus": 1e6)"),
            {"nodule 1", "17.0 mm", "19.0 mm"});
    refused(nodule(R"("at": [0,0,0.05], "depth": 8e-3, "radius": 5e-3, "modulus": 1e6)"), {"nodule 1", "50.0 mm"});

    Scene none            = sceneOf(kSolids[0], belowOf(kSolids[0]));
    none.patch.foundation = 0;
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(loadObject(none)); }), {"below", "foundation above 0"}));
}

TEST(Below, BoundsAreTakenAndWhatLiesBeyondThemIsRefused)
{
    const auto read = [](const std::string& depth, const std::string& modulus) {
        return refusalOf([&] {
            static_cast<void>(parseBelow(R"({"depth": )" + depth + R"(, "modulus": )" + modulus + "}", "a test"));
        });
    };
    EXPECT_EQ(read("1e-5", "1"), "");
    EXPECT_EQ(read("1", "1e12"), "");
    for (const char* depth : {"0.99e-5", "1.01"}) EXPECT_TRUE(holds(read(depth, "1"), {"\"depth\"", "1e-5 to 1 m"}));
    for (const char* modulus : {"0.99", "1.01e12"})
        EXPECT_TRUE(holds(read("1", modulus), {"\"modulus\"", "1 to 1e12 Pa"}));
}

TEST(Below, ALawThatHasACommentIsWrittenWithoutIt)
{
    const SceneBelow below =
        parseBelow(R"({"foundation": "{\"law\": \"constant\", /* even */ \"value\": 2e6}"})", "a test");
    EXPECT_EQ(belowJson(below), R"({"foundation":{"law":"constant","value":2000000.0}})");
}

/// A sheet whose foundation is 2 MPa/m by itself, by a law, or point by point.
Scene onFoundation(const std::string& foundation, const std::string& below, const std::string& cloud = "sample:sheet")
{
    return parseScene(R"({"poisson": 0.45, "window": "60 mm", "cells": 64, "thickness": "3 mm"})", "a test", ".",
                      {.flags = {{"cloud", cloud}, {"foundation", foundation + " MPa/m"}, {"below", below}}});
}

TEST(Below, ListsWithinListsAreLeftToTheReaderWhoRefusesThem)
{
    const std::string below = R"({"volume": )" + std::string(200'000, '[') + std::string(200'000, ']') + "}";
    EXPECT_EQ(belowWithFileIn(below, "/a"), below) << "the library of JSON prints by recursion";
}

TEST(Below, ALawOfTheFoundationIsFeltAsItsValue)
{
    const Scene  plain = onFoundation("2", "none");
    const double felt  = feltOn(loadObject(plain).object, plain);
    for (const char* unit : {"2", "0.7", "5"}) { // whatever the scene's own foundation is
        const Scene even = onFoundation(unit, R"({"foundation": {"law": "constant", "value": 2e6}})");
        EXPECT_NEAR(feltOn(loadObject(even).object, even) / felt, 1, 1e-4) << unit << ": the solver's tolerance";
    }
    const Scene  rising = onFoundation("2", R"({"foundation": "linear:from=1e6,to=8e6,axis=x"})");
    const auto   object = loadObject(rising).object;
    const double soft = feltOn(object, rising, {-30e-3, 0, 0}), firm = feltOn(object, rising, {30e-3, 0, 0});
    EXPECT_GT(firm, 1.3 * soft);
    EXPECT_NEAR(*std::ranges::min_element(object.foundationShape()), 0.5, 0.01);
    EXPECT_NEAR(*std::ranges::max_element(object.foundationShape()), 4, 0.05);

    const Scene again = parseScene(sceneJson(rising), "again", ".");
    EXPECT_EQ(belowJson(again.below), belowJson(rising.below));
    EXPECT_FALSE(haveSameCloud(rising, onFoundation("3", R"({"foundation": "linear:from=1e6,to=8e6,axis=x"})")));
    EXPECT_TRUE(holds(refusalOf([] { static_cast<void>(onFoundation("2", R"({"foundation": "soft"})")); }),
                      {"below", "foundation", "soft"}));
    EXPECT_TRUE(holds(refusalOf([] { static_cast<void>(onFoundation("2", R"({"foundation": "soft", "depth": 1})")); }),
                      {"unknown key \"depth\"", "known keys: foundation"}));
}

TEST(Below, TheFoundationOfAFileIsFeltWhereTheSceneSaysOwn)
{
    const TemporaryFolder folder;
    std::string           rows = "x,y,z,stiffness,foundation\n";
    for (int i = -60; i < 60; ++i)
        for (int j = -60; j < 60; ++j)
            rows +=
                std::to_string(i * 1e-3) + "," + std::to_string(j * 1e-3) + ",0,3e5," + (i < 0 ? "5e5" : "2e7") + "\n";
    const std::string file = folder.write("half.csv", rows).string();
    const Scene       own = onFoundation("2", "own", file), none = onFoundation("0.5", "none", file);
    const auto        half = loadObject(own).object, even = loadObject(none).object;
    ASSERT_EQ(half.foundationShape().size(), 14400u);
    EXPECT_TRUE(even.foundationShape().empty());
    EXPECT_NEAR(feltOn(half, own, {-28e-3, 0, 0}) / feltOn(even, none, {-28e-3, 0, 0}), 1, 0.02)
        << "far from the firm half";
    EXPECT_GT(feltOn(half, own, {28e-3, 0, 0}), 2 * feltOn(half, own, {-28e-3, 0, 0}));
    EXPECT_EQ(sceneJson(parseScene(sceneJson(own), "again", ".")), sceneJson(own));
    EXPECT_TRUE(holds(refusalOf([] { static_cast<void>(loadObject(onFoundation("2", "own"))); }),
                      {"below", "property foundation", "found none"}));
    const auto bad = folder.write("bad.csv", "x,y,z,foundation\n0,0,0,1e6\n1,0,0,0\n");
    EXPECT_TRUE(holds(refusalOf([&] { static_cast<void>(readCloud(bad)); }),
                      {"line 3", "foundation from 1 to 1e15 Pa/m", "found \"foundation\" 0"}));
}

} // namespace
} // namespace palp
