#include "tests/pipeline/calculix_shells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "engine/pipeline/deform.h"
#include "tests/pipeline/calculix_large.h"
#include "tests/pipeline/force_at.h"

// What whole objects feel like by CalculiX and by a touch of their points; calculix_shells.py has the objects.

namespace palp {
namespace {

constexpr double kModulus = 1e6, kSpacing = 0.5e-3; ///< [Pa], [m] spots of 4 mm are smoothed by it

using Where = std::function<bool(const glm::dvec3& place)>;

/// A surface x, y -> place, and its modulus.
struct Object {
    std::function<glm::dvec3(double, double)> place;
    double                                    sizeX = 0, sizeY = 0; ///< about, along both [m]
    double                                    spot = 1, off = 0;    ///< times stiffer [1], beside the touch [m]
    double                                    window = 40e-3;       ///< [m]; 0: as its dents ask for
    double                                    slope  = 0;           ///< of the modulus along x, over its mean [1/m]
    glm::dvec3                                touch{};              ///< [m]; 0: where the surface is at x = y = 0
    glm::dvec3                                outward{0, 0, 1};
    Where inside{}, held{}; ///< what there is of it; what holds it, in a window that spans it
};

std::function<glm::dvec3(double, double)> cap(const glm::dvec3& halfAxes, double tilt = 0)
{
    return [=](double x, double y) { // an azimuthal map that keeps areas on the sphere, to 100 degrees
        constexpr double kReach = 1.54;
        x *= kReach;
        y *= kReach;
        if (std::hypot(x, y) > kReach) x = std::nan("");
        const double rest = std::sqrt(1 - (x * x + y * y) / 4), a = x * rest, c = 1 - (x * x + y * y) / 2;
        return halfAxes *
               glm::dvec3(a * std::cos(tilt) + c * std::sin(tilt), y * rest, c * std::cos(tilt) - a * std::sin(tilt));
    };
}

std::function<glm::dvec3(double, double)> turned(const std::function<double(double)>& radius)
{
    return [=](double x, double y) {
        const double r = radius(40e-3 * y), angle = std::numbers::pi * x;
        return glm::dvec3(r * std::sin(angle), 40e-3 * y, r * std::cos(angle));
    };
}

std::function<glm::dvec3(double, double)> flat(double size)
{
    return [=](double x, double y) { return glm::dvec3(size / 2 * x, size / 2 * y, 0); };
}

/// Objects that are held at their border, which no window spans.
Object curvedObject(std::string_view name)
{
    const glm::dvec3 round(50e-3), axes(60e-3, 45e-3, 35e-3);
    if (name == "sphere")
        return {cap(round), 0.154, 0.154, 1, 0, 60e-3}; // 8 lengths of the thickest, as of the spots and the shoulder
    // Unlike curvatures reach farther: 12 to 20 lengths.
    if (name == "ellipsoid") return {cap(axes), 0.184, 0.138, 1, 0, 100e-3};
    if (name == "side") return {cap({axes.x, axes.z, axes.y}), 0.184, 0.138, 1, 0, 0};
    if (name == "cigar") return {cap({80e-3, 30e-3, 30e-3}), 0.2, 0.138, 1, 0, 0};
    if (name == "slope") return {cap(axes), 0.184, 0.138, 1, 0, 100e-3, 1 / 66e-3};
    if (name == "wart_under") return {cap(round), 0.154, 0.154, 10, 0, 60e-3};
    if (name == "wart_beside") return {cap(round), 0.154, 0.154, 10, 8e-3};
    if (name == "soft_spot") return {cap(round), 0.154, 0.154, 0.2};
    Object shoulder{cap(axes, std::numbers::pi / 4), 0.184, 0.138, 1, 0, 60e-3};
    shoulder.outward = glm::normalize(shoulder.place(0, 0) / (axes * axes));
    return shoulder;
}

/// Objects that are held at their ends, which the window spans.
Object heldObject(std::string_view name)
{
    // What is not curved both ways is held at its ends, which the window has to span.
    if (name == "tube") return {turned([](double) { return 40e-3; }), 0.25, 0.08, 1, 0, 80e-3};
    if (name == "waist")
        return {turned([](double y) { return 120e-3 - std::sqrt(80e-3 * 80e-3 - y * y); }), 0.25, 0.08, 1, 0, 80e-3};
    if (name == "sheet") return {flat(40e-3), 0.04, 0.04};
    constexpr double kWave = 2 * std::numbers::pi / 60e-3, kCrest = 25e-3; // [1/m], [m]
    return {[](double x, double y) {
                return glm::dvec3(30e-3 * x, 30e-3 * y, std::cos(kWave * 30e-3 * x) / (kCrest * kWave * kWave));
            },
            0.062,
            0.06,
            1,
            0,
            61e-3}; // 62.2 along the surface, 60 across
}

/// Sheets from support to support.
struct Between {
    std::string_view name;
    double           length, width; ///< [m]
    double           along, across; ///< curvatures [1/m]
};
constexpr std::array<Between, 6> kBetween{{{"band", 80e-3, 30e-3, 0, 0},
                                           {"arch", 80e-3, 30e-3, 5, 0},
                                           {"low_arch", 80e-3, 30e-3, 1.5, 0},
                                           {"vault", 60e-3, 80e-3, 8, 0},
                                           {"saddle", 70e-3, 50e-3, 6, -6},
                                           {"bridge", 70e-3, 70e-3, 8.33, 8.33}}};

bool isBetween(std::string_view name)
{
    return std::ranges::find(kBetween, name, &Between::name) != kBetween.end();
}

/// Objects with borders of their own, in a window that spans them.
Object wholeObject(std::string_view name)
{
    const auto from = [](const glm::dvec3& p) { return std::hypot(p.x, p.y); };
    if (name.starts_with("drum")) {
        Object drum{flat(130e-3), 0.13, 0.13, name == "drum" ? 1.0 : 10.0, 8e-3};
        drum.held = [](const glm::dvec3& p) { return std::max(std::abs(p.x), std::abs(p.y)) > 60e-3; };
        return drum;
    }
    if (name == "lobe") {
        Object lobe{flat(120e-3), 0.12, 0.12};
        lobe.touch  = {40e-3, 0, 0};
        lobe.held   = [](const glm::dvec3& p) { return p.x < 0; };
        lobe.inside = [](const glm::dvec3& p) {
            const double share = std::max(p.x, 0.0) / 60e-3;
            return p.x > -10e-3 && std::abs(p.y) < 25e-3 * std::sqrt(1 - 0.96 * share * share);
        };
        return lobe;
    }
    if (const auto between = std::ranges::find(kBetween, name, &Between::name); between != kBetween.end()) {
        const Between    of    = *between;
        constexpr double kHeld = 7e-3; // beyond either end [m]
        Object           arch{[=](double x, double y) {
                        x *= of.length / 2 + kHeld;
                        y *= of.width / 2;
                        return glm::dvec3(x, y, -(of.along * x * x + of.across * y * y) / 2);
                    },
                    of.length + 2 * kHeld, of.width};
        arch.held = [=](const glm::dvec3& p) { return std::abs(p.x) > of.length / 2; };
        return arch;
    }
    const double bend = name == "disc" ? 0 : name == "dish" ? 10 : 5; // [1/m]
    const auto   high = [=](double r) { return bend > 0 ? (std::sqrt(1 - bend * bend * r * r) - 1) / bend : 0; };
    Object bowl{[=](double x, double y) { return glm::dvec3(40e-3 * x, 40e-3 * y, high(40e-3 * std::hypot(x, y))); },
                0.08, 0.08};
    bowl.touch   = {24e-3, 0, high(24e-3)};
    bowl.outward = {24e-3 * bend, 0, std::sqrt(1 - std::pow(24e-3 * bend, 2))};
    bowl.inside  = [=](const glm::dvec3& p) { return from(p) < 40e-3; };
    bowl.held    = [=](const glm::dvec3& p) { return from(p) < 8e-3; };
    return bowl;
}

/// How an object of the table is compared.
enum class Kind {
    curved, ///< both ways alike: a window of some eight lengths is enough
    held,   ///< the window's edges are the object's
    whole   ///< the window spans the object, which has borders of its own
};

Kind kindOf(std::string_view name)
{
    for (const std::string_view held : {"tube", "waist", "ridge", "sheet"})
        if (name == held) return Kind::held;
    for (const std::string_view whole : {"drum", "drum_wart", "lobe", "disc", "shallow_dish", "dish"})
        if (name == whole) return Kind::whole;
    return isBetween(name) ? Kind::whole : Kind::curved;
}

Object objectNamed(std::string_view name)
{
    Object object = kindOf(name) == Kind::curved ? curvedObject(name)
                    : kindOf(name) == Kind::held ? heldObject(name)
                                                 : wholeObject(name);
    if (object.touch == glm::dvec3(0)) object.touch = object.place(0, 0);
    return object;
}

double modulusAt(const Object& object, const glm::dvec3& p)
{
    const double squared = (p.x - object.off) * (p.x - object.off) + p.y * p.y;
    return kModulus * (1 + object.slope * p.x + (object.spot - 1) * std::exp(-squared / (2 * 4e-3 * 4e-3)));
}

SoftObject cloudOf(const Object& object, double thickness)
{
    std::mt19937                           random(7);
    std::uniform_real_distribution<double> along(-1, 1);
    std::vector<glm::dvec3>                points;
    std::vector<double>                    moduli, held;
    const auto                             count = std::size_t(object.sizeX * object.sizeY / (kSpacing * kSpacing));
    for (std::size_t n = 0; n < count; ++n) {
        const double     x = along(random), y = along(random);
        const glm::dvec3 p = object.place(x, y);
        if (std::isnan(p.x) || (object.inside && !object.inside(p))) continue;
        points.push_back(p);
        moduli.push_back(modulusAt(object, p));
        if (object.held) held.push_back(object.held(p));
    }
    SoftObject soft(PointCloud(std::move(points), std::move(moduli), StiffnessKind::modulus),
                    {.thickness = thickness, .poissonRatio = 0.45});
    return object.held ? std::move(soft).withHeld(std::move(held)) : soft;
}

PatchSettings settingsOf(const Object& object, Theory theory, Edge edge)
{
    PatchSettings settings{.window = object.window, .theory = theory};
    settings.edges = {edge, edge, edge, edge};
    if (object.window > 50e-3) settings.cells = 128;
    if (object.window == 0) settings.window = 40e-3, settings.windowOf = WindowOf::dent;
    return settings;
}

/// 1/c of a touch [N/m].
double feltBy(Theory theory, Edge edge, const CalculixShell& of)
{
    const Object     object   = objectNamed(of.name);
    const SoftObject cloud    = cloudOf(object, of.thickness);
    PatchSettings    settings = settingsOf(object, theory, edge);
    if (object.held) settings.windowOf = WindowOf::object;
    PlateSolver host("host");
    return 1 / deform(cloud, touchAt(cloud, object.touch, object.outward, 10e-3), settings, host).compliance;
}

TEST(CalculixShells, TheirMeshesAreFineEnough)
{
    for (const CalculixShell& of : kCalculixShells) EXPECT_LT(std::abs(of.meshError), 0.005) << of.name;
}

TEST(CalculixShells, WhatIsCurvedBothWaysIsFeltAsStiffAsItIs)
{
    for (const CalculixShell& of : kCalculixShells) {
        if (kindOf(of.name) != Kind::curved) continue;
        const double felt = feltBy(Theory::shell, Edge::supported, of) / of.stiffness - 1;
        const double flat = feltBy(Theory::plate, Edge::clamped, of) / of.stiffness - 1;
        // Measured: spheres -1.0 to 0.1 %, ellipsoids 0.5 to 0.9, slope 1.5, at the shoulder 2.5 and 4.5, spots -3 to
        // 2; in the windows that their dents ask for the side of an ellipsoid 2.4 and 1.8, that of a cigar, which is
        // much steeper than shallow shells, 5.1 and 1.7, of which fits of its curvature make 1; with fewer cells and
        // narrower windows these were 4.8, 3.6, 7.6 and 3.6. Without what the whole body gives way by, and with the squeeze
        // left out, it was 3 to 4, 3 to 5, 6 to 10 and 2 to 9; with the window's sides along the principal directions
        // ellipsoids were 1.3 to 1.6.
        std::printf("  %s, %.0f mm: shell %+.1f %%, flat plate %+.1f %%\n", std::string(of.name).c_str(),
                    1e3 * of.thickness, 100 * felt, 100 * flat);
        const double most = of.name == "sphere" ? 0.03 : of.name == "cigar" ? 0.06 : 0.05;
        EXPECT_LT(std::abs(felt), most) << of.name << ", " << of.thickness << " m";
        EXPECT_GT(std::abs(flat), 0.2) << of.name << ": then nothing is shown";
    }
}

/// A sphere that is clamped 78 degrees from its far end, by calculix_bodies.py beside this: CalculiX 2.20, CAX8R of
/// l/32 about the pole, three through the thickness, a pressure (1 - r^2/a^2)^2 of a = l, half on either face; times E
/// R it depends on h/R alone.
TEST(CalculixBodies, GiveWayAsAWhole)
{
    struct Sphere {
        double thickness, length, compliance; ///< over R, over R, times E R [1]
    };
    constexpr double kRadius = 50e-3; // [m]
    for (const Sphere& of :
         {Sphere{0.01, 0.0568554, 3145.18}, Sphere{0.02, 0.0804057, 804.254}, Sphere{0.04, 0.113711, 208.865}}) {
        const Object     object   = objectNamed("sphere");
        const SoftObject cloud    = cloudOf(object, of.thickness * kRadius);
        PatchSettings    settings = settingsOf(object, Theory::shell, Edge::supported);
        settings.footprintRadius  = of.length * kRadius;
        PlateSolver  host("host");
        const Patch  patch = deform(cloud, touchAt(cloud, object.touch, object.outward, 10e-3), settings, host);
        const double exact = of.compliance / (kModulus * kRadius); // [m/N]
        EXPECT_NEAR(patch.compliance / exact, 1, 0.015)            // 1.1 % at h/R 0.04: shear counts to the first order
            << of.thickness;
        EXPECT_LT((patch.compliance - patch.bodyCompliance) / exact, 0.985) << "then the body is not seen";
        EXPECT_LT(*discretisationError(patch, settings, host), 0.01) << "the body is on no grid";

        settings.edges = {Edge::clamped, Edge::supported, Edge::supported, Edge::supported};
        EXPECT_LT(deform(cloud, patch.contact, settings, host).compliance, patch.compliance - patch.bodyCompliance)
            << "a window that is held is no part of a body";
        settings.edges      = {Edge::supported, Edge::supported, Edge::supported, Edge::supported};
        settings.foundation = 1e3 * kModulus * of.thickness / kRadius; // as stiff as a thousand such membranes [Pa/m]
        EXPECT_LT(deform(cloud, patch.contact, settings, host).bodyCompliance, 2e-3 * patch.bodyCompliance);
    }
}

TEST(CalculixBodies, ACapIsHeldAtItsRim)
{
    const Object object = objectNamed("sphere");
    Object       cap    = object;
    cap.inside          = [](const glm::dvec3& p) { return p.z > 40e-3; }; // 37 degrees
    PlateSolver host("host");
    for (const Object* of : std::initializer_list<const Object*>{&object, &cap}) {
        const SoftObject cloud    = cloudOf(*of, 1e-3);
        PatchSettings    settings = settingsOf(*of, Theory::shell, Edge::supported);
        settings.window           = 40e-3;
        const Patch patch         = deform(cloud, touchAt(cloud, of->touch, of->outward, 10e-3), settings, host);
        EXPECT_EQ(patch.bodyCompliance > 0, of == &object);
    }
}

/// In the window that an object gets where nobody names one, which its supports are beyond.
TEST(CalculixShells, WhatIsNotLiesInTheRangeThatATouchStates)
{
    PlateSolver host("host");
    for (const CalculixShell& of : kCalculixShells) {
        if (kindOf(of.name) != Kind::held || of.name == "sheet") continue;
        const Object     object   = objectNamed(of.name);
        const SoftObject cloud    = cloudOf(object, of.thickness);
        PatchSettings    settings = settingsOf(object, Theory::shell, Edge::supported);
        settings.window           = 40e-3;
        const Patch patch         = deform(cloud, touchAt(cloud, object.touch, object.outward, 10e-3), settings, host);
        const auto  range         = supportRange(cloud, patch, settings, host).value();
        EXPECT_LT(range.least, of.stiffness) << of.name << ", supported in this window: " << range.supported;
        EXPECT_GT(range.least, 0.25 * of.stiffness) << of.name << ": a range that says something";
        EXPECT_GT(range.clamped, of.stiffness) << of.name;
    }
}

TEST(CalculixShells, WhatIsNotIsFeltByClampedEdgesOfAWindowThatSpansIt)
{
    for (const CalculixShell& of : kCalculixShells) {
        if (kindOf(of.name) != Kind::held || of.name == "sheet") continue;
        EXPECT_NEAR(feltBy(Theory::shell, Edge::clamped, of) / of.stiffness, 1.03, 0.05)
            << of.name << ": held so, -1.1 to 7 % off; the tube's window spans its length and not what is around";
    }
}

TEST(CalculixShells, AFlatSheetInItsOwnFrameIsAClampedPlate)
{
    const CalculixShell& of = *std::ranges::find(kCalculixShells, "sheet", &CalculixShell::name);
    EXPECT_NEAR(feltBy(Theory::shell, Edge::clamped, of) / of.stiffness, 1, 0.02) << "measured 1.1 %";
}

TEST(CalculixShells, WhatHasBordersOfItsOwnBendsAboutWhatHoldsIt)
{
    for (const CalculixShell& of : kCalculixShells) {
        if (kindOf(of.name) != Kind::whole || of.name.ends_with("dish") || isBetween(of.name)) continue;
        const double felt = feltBy(Theory::plate, Edge::clamped, of) / of.stiffness - 1;
        std::printf("  %s, %g mm: %+.1f %%\n", std::string(of.name).c_str(), 1e3 * of.thickness, 100 * felt);
        EXPECT_LT(std::abs(felt), 0.05) << "a plate has no shear, of which the disc on its stem has most: " << of.name
                                        << ", " << of.thickness << " m";
    }
}

/// Without the forces from one support to the other they were felt 10 to 81 % too soft.
TEST(CalculixShells, WhatSpansFromSupportToSupportThrusts)
{
    for (const CalculixShell& of : kCalculixShells) {
        if (!isBetween(of.name)) continue;
        const double felt = feltBy(Theory::shell, Edge::clamped, of) / of.stiffness - 1;
        std::printf("  %s: %+.1f %%\n", std::string(of.name).c_str(), 100 * felt);
        EXPECT_NEAR(felt, 0, 0.02) << of.name;
    }
}

TEST(CalculixShells, ADishBendsAboutItsStemAsAShell)
{
    for (const CalculixShell& of : kCalculixShells) {
        if (!of.name.ends_with("dish")) continue;
        const double felt = feltBy(Theory::shell, Edge::clamped, of) / of.stiffness - 1;
        const double flat = feltBy(Theory::plate, Edge::clamped, of) / of.stiffness - 1;
        std::printf("  %s: %+.1f %%, flat %+.0f %%\n", std::string(of.name).c_str(), 100 * felt, 100 * flat);
        EXPECT_NEAR(felt, 0, 0.03) << of.name;
        EXPECT_LT(flat, -0.1) << of.name << ": then nothing is shown";
    }
}

/// In windows of 40 mm or less about the contact, beyond which a coarse shell of the whole object says the rest.
TEST(CalculixShells, WhatIsHeldIsFeltThroughWindowsThatAreCutFromItToo)
{
    PlateSolver host("host");
    for (const CalculixShell& of : kCalculixShells) {
        if (kindOf(of.name) != Kind::whole) continue;
        const Object     object   = objectNamed(of.name);
        const SoftObject cloud    = cloudOf(object, of.thickness);
        PatchSettings    settings = settingsOf(object, Theory::shell, Edge::supported);
        settings.windowOf         = WindowOf::dent;
        settings.window           = 40e-3;
        const Patch patch         = deform(cloud, touchAt(cloud, object.touch, object.outward, 10e-3), settings, host);
        std::printf("  %s, %.0f mm: window %.0f mm, cut from the body %+.1f %%\n", std::string(of.name).c_str(),
                    1e3 * of.thickness, 1e3 * patch.window.grid.sizeX(),
                    100 * (1 / patch.compliance / of.stiffness - 1));
        EXPECT_TRUE(patch.body) << of.name;
        EXPECT_NEAR(1 / patch.compliance / of.stiffness, 1, 0.05) << of.name;
    }
}

TEST(CalculixPresses, AreFeltUpToOneAndAHalfThicknesses)
{
    for (const CalculixPress& of : kCalculixPresses) {
        ASSERT_LT(std::abs(of.meshError), 0.02) << of.name;
        const Object     object   = objectNamed(of.name);
        const SoftObject cloud    = cloudOf(object, of.thickness);
        const Edge       edge     = of.name == "sheet" ? Edge::clamped : Edge::supported;
        PatchSettings    settings = settingsOf(object, Theory::shell, edge);
        settings.large            = Large::on;
        if (object.held) settings.windowOf = WindowOf::object;
        PlateSolver host("host");
        const Patch patch = deform(cloud, touchAt(cloud, object.touch, object.outward, 10e-3), settings, host);
        ASSERT_TRUE(patch.large) << of.name << patch.linearBecause;
        double deepest = 0;
        for (std::size_t n = 0; n < of.depths.size(); ++n) {
            const double depth = of.depths[n], force = of.force * double(n + 1) / double(of.depths.size());
            if (depth > 1.55 * of.thickness) break;
            // Measured: sheet 0.7 %, spheres -0.3 to 4.1, ellipsoid 2, spots of stiffness -3 to 4.2, band 0.8,
            // low arch -2.1.
            EXPECT_NEAR(forceAt(patch, depth) / force, 1, 0.05)
                << of.name << ", " << of.thickness << " m, " << depth << " m deep";
            deepest = depth / patch.compliance / force - 1; // of the linear law
        }
        EXPECT_GT(std::abs(deepest), 0.35) << of.name << ": then nothing is shown";
    }
}

} // namespace
} // namespace palp
