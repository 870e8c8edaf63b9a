#include <iomanip>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "engine/tools/cli/commands.h"
#include "engine/tools/cli/doctor_checks.h"
#include "engine/tools/cli/haptic_list.h"

namespace palp {
namespace {

void printJson(const Make& made, const std::vector<Finding>& findings, const DeviceList& haptics)
{
    nlohmann::ordered_json report{{"palpate", made.palpate},
                                  {"compiler", made.compiler},
                                  {"libraries", made.libraries},
                                  {"system", made.system},
                                  {"findings", nlohmann::ordered_json::array()},
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

void examineAndPrint(bool asJson)
{
    const DeviceList           haptics  = listHaptics();
    const std::vector<Finding> findings = examine(haptics);
    if (asJson)
        printJson(make(), findings, haptics);
    else
        printText(make(), findings);
}

} // namespace

void addDoctorCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("doctor", "lists what this machine lacks for haptics, with remedies");
    const auto asJson  = std::make_shared<bool>(false);
    command->add_flag("--json", *asJson, "machine-readable");
    command->footer(
        "The output names no person, no file and no serial number, so that it can be pasted into a report.\n"
        "Verdicts: \"ok\"; \"warning\": works, but not at its best; \"missing\": what needs it does not work.\n"
        "The exit code is 0, whatever was found.\n"
        "Examples:\n"
        "  palpate doctor\n"
        "  palpate doctor --json");
    command->callback([asJson] { examineAndPrint(*asJson); });
}

} // namespace palp
