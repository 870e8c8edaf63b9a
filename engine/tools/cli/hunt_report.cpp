#include "engine/tools/cli/hunt_report.h"

#include <cmath>
#include <cstdio>
#include <iostream>

#include "engine/core/counted.h"
#include "engine/core/quantity.h"

namespace palp {
namespace {

using study::Declaration;
using study::HuntScore;
using study::NoduleScore;

std::string percent(double share)
{
    return std::to_string(int(std::lround(100 * share))) + " %";
}

nlohmann::json placeOf(const glm::dvec3& p)
{
    return {p.x, p.y, p.z};
}

void printRow(const std::string& number, const std::string& radius, const std::string& modulus,
              const std::string& found, const std::string& off, const std::string& edge)
{
    std::printf("  %-7s %-8s %-9s %-9s %-9s %s\n", number.c_str(), radius.c_str(), modulus.c_str(), found.c_str(),
                off.c_str(), edge.c_str());
}

} // namespace

nlohmann::json jsonOf(const HuntScore& s)
{
    nlohmann::json nodules = nlohmann::json::array(), declared = nlohmann::json::array();
    for (const NoduleScore& n : s.nodules)
        nodules.push_back({{"centre_m", placeOf(n.nodule.centre)},
                           {"radius_m", n.nodule.radius},
                           {"modulus_Pa", n.nodule.modulus},
                           {"found", n.found},
                           {"time_s", n.found ? nlohmann::json(n.time) : nullptr},
                           {"distance_m", n.found ? nlohmann::json(n.distance) : nullptr},
                           {"edge_traced", n.edge}});
    for (const Declaration& d : s.declarations)
        declared.push_back(
            {{"time_s", d.time},
             {"place_m", placeOf(d.place)},
             {"nodule", d.nodule == Declaration::kNone ? nlohmann::json() : nlohmann::json(d.nodule + 1)},
             {"distance_m", d.distance},
             {"again", d.again}});
    return {{"nodules", nodules},
            {"declarations", declared},
            {"found", s.found},
            {"false_alarms", s.falseAlarms},
            {"declared_in_air", s.inAir},
            {"declarations_not_kept", s.unkept},
            {"duration_s", s.duration},
            {"contact_s", s.contact},
            {"force_mean_N", s.meanForce},
            {"force_peak_N", s.peakForce},
            {"impulse_N_s", s.impulse},
            {"too_hard_share", s.tooHard},
            {"coverage", s.coverage},
            {"mark", s.mark},
            {"mark_formula", HuntScore::kMarkFormula}};
}

void printText(const HuntScore& s, const study::Hunt& hunt)
{
    std::cout << "found " << s.found << " of " << counted(s.nodules.size(), "nodule") << ", "
              << counted(s.falseAlarms, "false alarm") << "; mark " << percent(s.mark) << " = "
              << HuntScore::kMarkFormula << "\n";
    std::cout.flush(); // the table is printed by the other library
    printRow("nodule", "radius", "modulus", "found at", "off by", "edge traced");
    for (std::size_t i = 0; i < s.nodules.size(); ++i) {
        const NoduleScore& n = s.nodules[i];
        printRow(std::to_string(i + 1), formatQuantity(n.nodule.radius, "m"), formatQuantity(n.nodule.modulus, "Pa"),
                 n.found ? formatQuantity(n.time, "s") : "missed", n.found ? formatQuantity(n.distance, "m") : "-",
                 percent(n.edge));
    }
    std::fflush(stdout);
    std::cout << "  force " << formatQuantity(s.meanForce, "N") << " on average in contact, "
              << formatQuantity(s.peakForce, "N") << " at most, impulse " << formatQuantity(s.impulse, "N s") << "; "
              << percent(s.tooHard) << " of the contact above " << formatQuantity(hunt.tooHard, "N") << "\n"
              << "  in contact for " << formatQuantity(s.contact, "s") << " of " << formatQuantity(s.duration, "s")
              << "; " << percent(s.coverage) << " of the ground felt\n";
    if (s.inAir > 0) std::cout << "  " << s.inAir << " declared without touching, and not scored as a place\n";
    if (s.declarations.empty())
        std::cout << "  nothing was declared: press a button of the device over a nodule (M in the window, a column "
                     "\"buttons\" in a hand's file)\n";
}

} // namespace palp
