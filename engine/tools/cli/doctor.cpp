#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "engine/core/progress.h"
#include "engine/core/quantity.h"
#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/doctor_checks.h"
#include "engine/tools/cli/haptic_list.h"
#include "engine/tools/cli/servo_jitter.h"

namespace palp {
namespace {

struct DoctorOptions {
    bool json = false, quick = false;
};

nlohmann::ordered_json jsonOf(const TickLateness& late)
{
    return {{"counts", late.counts},
            {"p50_s", late.all.quantile(0.5)},
            {"p99_s", late.all.quantile(0.99)},
            {"p99.9_s", late.all.quantile(0.999)},
            {"max_s", late.all.most()}};
}

nlohmann::ordered_json jsonOf(const std::optional<ServoJitter>& jitter)
{
    if (!jitter) return nullptr;
    return {{"seconds", jitter->seconds},
            {"late_up_to_s", TickLateness::kBins},
            {"idle", jsonOf(jitter->idle)},
            {"busy", jsonOf(jitter->busy)}};
}

void printText(const ServoJitter& jitter)
{
    const auto share = [](const TickLateness& late, std::size_t bin) {
        std::array<char, 16> text{};
        std::snprintf(text.data(), text.size(), "%8.2f %%",
                      100.0 * double(late.counts[bin]) / double(late.all.count()));
        return std::string(text.data());
    };
    const auto bar = [](const TickLateness& late, std::size_t bin) {
        return std::string(std::size_t(std::ceil(30.0 * double(late.counts[bin]) / double(late.all.count()))), '#');
    };
    std::cout << "\na servo's tick of 1 ms is late by   idle         every core busy\n";
    for (std::size_t bin = 0; bin < jitter.idle.counts.size(); ++bin) {
        const bool        isLast = bin == TickLateness::kBins.size();
        const std::string bound  = formatQuantity(TickLateness::kBins[isLast ? bin - 1 : bin], "s");
        const auto        micro  = int(std::ranges::count(bound, '\xc2')); // has two bytes, and one column
        std::cout << "  " << std::left << std::setw(33 + (isLast ? 0 : micro)) << (isLast ? "more" : "up to " + bound)
                  << share(jitter.idle, bin) << "   " << share(jitter.busy, bin) << "  " << bar(jitter.busy, bin)
                  << "\n";
    }
}

void printJson(const Make& made, const std::vector<Finding>& findings, const DeviceList& haptics,
               const std::optional<ServoJitter>& jitter)
{
    nlohmann::ordered_json report{{"palpate", made.palpate},
                                  {"compiler", made.compiler},
                                  {"libraries", made.libraries},
                                  {"system", made.system},
                                  {"findings", nlohmann::ordered_json::array()},
                                  {"servo", jsonOf(jitter)},
                                  {"haptic", jsonOf(haptics.devices)}};
    for (const Finding& finding : findings)
        report["findings"].push_back(
            {{"part", finding.part},
             {"verdict", name(finding.verdict)},
             {"found", finding.found},
             {"help", finding.help.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(finding.help)}});
    std::cout << jsonText(report);
}

void printText(const Make& made, const std::vector<Finding>& findings)
{
    std::cout << "palpate    " << made.palpate << "\ncompiler   " << made.compiler << "\nlibraries  " << made.libraries
              << "\nsystem     " << made.system << "\n\n";
    for (const Finding& finding : findings) {
        std::cout << std::left << std::setw(8) << name(finding.verdict) << " " << std::setw(15) << finding.part << " "
                  << finding.found << "\n";
        if (!finding.help.empty()) std::cout << std::string(25, ' ') << "-> " << finding.help << "\n";
    }
}

void examineAndPrint(const DoctorOptions& options)
{
    constexpr double           kHalf    = 2.5; // [s]
    const DeviceList           haptics  = listHaptics();
    std::vector<Finding>       findings = examine(haptics);
    std::optional<ServoJitter> jitter;
    if (!options.quick) {
        Progress progress("watching the servo's clock");
        jitter = measureJitter(kHalf, [&](double share) { progress.at(std::size_t(1000 * share), 1000); });
        findings.insert(findings.begin() + 1, findingOn(*jitter)); // below the rights for it
    }
    if (options.json) return printJson(make(), findings, haptics, jitter);
    printText(make(), findings);
    if (jitter) printText(*jitter);
}

} // namespace

void addDoctorCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("doctor", "lists what this machine lacks for haptics, with remedies");
    const auto options = std::make_shared<DoctorOptions>();
    command->add_flag("--json", options->json, "machine-readable");
    command->add_flag("--quick", options->quick, "does not watch the servo's clock for 5 s, half of it under load");
    command->footer(
        "The output names no person, no file and no serial number, so that it can be pasted into a report.\n"
        "Verdicts: \"ok\"; \"warning\": works, but not at its best; \"missing\": what needs it does not work.\n"
        "The exit code is 0, whatever was found. For 2.5 s a thread like the servo waits for its ticks, and for as\n"
        "long again while every core is busy; the histogram shows how late they come.\n"
        "Examples:\n"
        "  palpate doctor\n"
        "  palpate doctor --quick --json");
    command->callback([options] { examineAndPrint(*options); });
}

} // namespace palp
