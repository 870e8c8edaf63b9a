#include "engine/tools/cli/session_report.h"

#include <iostream>

#include "engine/core/counted.h"
#include "engine/core/quantity.h"
#include "engine/session/force_state.h"

namespace palp {
namespace {

nlohmann::json durations(const DurationHistogram& of)
{
    return {{"count", of.count()},
            {"p50_s", of.quantile(0.5)},
            {"p99_s", of.quantile(0.99)},
            {"p99.9_s", of.quantile(0.999)},
            {"max_s", of.most()}};
}

/// Returns what the governor's engagement took from the forces, as a sentence.
std::string onComingOn(const SessionSummary& s)
{
    return "in " + std::to_string(s.comingOn) +
           " of the ticks in contact the force was coming on, from nothing to all in 1.5 s, and less than the object "
           "gives; " +
           (s.mostWholeForce > 0 ? "all of it was at most " + formatQuantity(s.mostWholeForce, "N")
                                 : "all of it was never felt: take more --seconds");
}

std::string onGovernor(const SessionSummary& s)
{
    return std::string("the governor stopped the force: ") + name(s.fault);
}

std::string onDevice(const SessionSummary& s)
{
    const char* const what =
        isFinal(s.deviceFault) ? "the device was lost, which ended the session: " : "the device reported a fault: ";
    return what + std::string(name(s.deviceFault)) + ": " +
           (s.deviceWords.empty() ? std::string(meaningOf(s.deviceFault)) : s.deviceWords);
}

} // namespace

nlohmann::json jsonOf(const SessionSummary& s)
{
    return {{"ticks", s.ticks},
            {"contact_ticks", s.contactTicks},
            {"patches", s.patches},
            {"failed_patches", s.failedPatches},
            {"stale_ticks", s.staleTicks},
            {"ticks_with_old_table", s.oldTable},
            {"ticks_beyond_table", s.beyondTable},
            {"ticks_beyond_theory", s.beyondTheory},
            {"ticks_without_patch", s.patchless},
            {"ticks_without_force", s.forceless},
            {"why_without_force", s.forceless > 0 ? nlohmann::json(s.whyForceless()) : nlohmann::json(nullptr)},
            {"last_failure", s.why.empty() ? nlohmann::json(nullptr) : nlohmann::json(s.why)},
            {"ticks_coming_on", s.comingOn},
            {"max_force_N", s.mostForce},
            {"max_whole_force_N", s.mostWholeForce > 0 ? nlohmann::json(s.mostWholeForce) : nlohmann::json(nullptr)},
            {"max_depth_m", s.mostDepth},
            {"compliance_min_m_per_N", s.leastCompliance},
            {"compliance_max_m_per_N", s.mostCompliance},
            {"fault", name(s.fault)},
            {"device_fault", name(s.deviceFault)},
            {"tick", durations(s.tick)},
            {"period", durations(s.period)},
            {"solve", durations(s.solve)}};
}

void printText(const SessionSummary& s, const std::string& solver, const std::string& hand)
{
    const auto seconds = [](double t) { return formatQuantity(t, "s"); };
    std::cout << counted(s.ticks, "tick") << ", " << s.contactTicks << " in contact; "
              << counted(s.patches, "patch", "es") << " on " << solver << "; in the hand: " << hand << "\n";
    if (s.contactTicks > 0)
        std::cout << "  force at most " << formatQuantity(s.mostForce, "N") << ", depth at most "
                  << formatQuantity(s.mostDepth, "m") << ", compliance " << formatQuantity(s.leastCompliance, "m/N")
                  << " to " << formatQuantity(s.mostCompliance, "m/N") << "\n";
    if (s.comingOn > 0) std::cout << "  " << onComingOn(s) << "\n";
    if (s.forceless > 0)
        std::cout << "  without force for " << counted(s.forceless, "tick")
                  << " that pressed, the last because: " << s.whyForceless() << "\n";
    else if (s.contactTicks > 0 && s.patches == 0 && s.failedPatches > 0)
        std::cout << "  what was felt is the homogeneous law of each place, as no window was solved; the last because: "
                  << s.why << "\n";
    std::cout << "  a tick computes " << seconds(s.tick.quantile(0.5)) << " (p99 " << seconds(s.tick.quantile(0.99))
              << ", p99.9 " << seconds(s.tick.quantile(0.999)) << ", most " << seconds(s.tick.most()) << "), a patch "
              << seconds(s.solve.quantile(0.5)) << " (most " << seconds(s.solve.most()) << ")\n";
    if (s.period.count() > 0)
        std::cout << "  a tick comes every " << seconds(s.period.quantile(0.5)) << " (p99 "
                  << seconds(s.period.quantile(0.99)) << ", p99.9 " << seconds(s.period.quantile(0.999)) << ", most "
                  << seconds(s.period.most()) << ")\n";
}

std::vector<std::string> warningsOf(const SessionSummary& s)
{
    std::vector<std::string> said;
    const auto               say = [&](std::string sentence) { said.push_back(std::move(sentence)); };
    if (s.contactTicks == 0)
        say("the hand never touched: it must start outside of the object, on the side that it presses, and reach it in "
            "the "
            "time that it has");
    const bool solvedNone = s.patches == 0 && s.failedPatches > 0;
    if (s.contactTicks > 0 && s.mostForce == 0 && s.fault == GovernorFault::none)
        say("the hand touched, but no force came on: " +
            (solvedNone        ? "none of " + counted(s.failedPatches, "patch", "es") + " could be solved: " + s.why
             : s.forceless > 0 ? s.whyForceless()
                               : "it stayed on the surface and never pressed"));
    if (s.fault != GovernorFault::none) say(onGovernor(s));
    if (s.deviceFault != DeviceFault::none) say(onDevice(s));
    if (s.beyondTheory > 0)
        say("the deflection exceeded half the thickness, or twice it with large deflections, in " +
            counted(s.beyondTheory, "tick") + ": the theory of the sheet does not hold there");
    if (s.beyondTable > 0)
        say("the contact left the table's reach in " + counted(s.beyondTable, "tick") +
            ": raise table_size or deformation_rate for fast hands");
    if (s.oldTable > 0)
        say("the plate did not answer for a quarter of a second, which took the force for " +
            counted(s.oldTable, "tick") +
            (s.failedPatches > 0 ? ", because it could not be solved there: " + s.why
                                 : ": lower cells, or table_size"));
    if (10 * s.staleTicks > s.contactTicks) // one late patch is no slow machine
        say(counted(s.staleTicks, "tick") + " had a patch older than three of its periods: lower cells, "
                                            "deformation_rate or table_size");
    if (s.failedPatches > 0 && !solvedNone)
        say(counted(s.failedPatches, "patch", "es") + " could not be solved: " + s.why);
    return said;
}

std::string whyStopped(const SessionSummary& s)
{
    if (s.fault != GovernorFault::none) return onGovernor(s);
    return isFinal(s.deviceFault) ? onDevice(s) : "";
}

} // namespace palp
