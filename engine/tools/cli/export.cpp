#include <filesystem>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "engine/core/contract.h"
#include "engine/core/counted.h"
#include "engine/core/file.h"
#include "engine/session/session_table.h"
#include "engine/tools/cli/commands.h"

// palpate export: a recorded session as a table.

namespace palp {
namespace {

struct ExportOptions {
    std::string folder, csv;
    bool        json = false;
};

void exportTable(const ExportOptions& o)
{
    if (std::filesystem::path(o.csv).extension() != ".csv") // so that no slip writes over a recording
        throw Error("--csv: expected a file that ends in .csv, found \"" + o.csv + "\"");
    const RecordedSession session = readDescription(o.folder);
    SessionTable          table;
    writeFileWhole(o.csv, [&](std::ostream& file) { table = writeTable(session, file); });
    if (o.json)
        std::cout << jsonText(nlohmann::json{
            {"file", o.csv},
            {"ticks", table.ticks},
            {"finished", session.finished},
            {"incomplete", session.whyIncomplete.empty() ? nlohmann::json() : nlohmann::json(session.whyIncomplete)},
            {"warnings", table.doubts}});
    else
        std::cout << counted(table.ticks, "tick") << " in " << o.csv << "\n";
    if (!session.whyIncomplete.empty()) warn({o.folder + " is not complete: " + session.whyIncomplete});
    warn(table.doubts);
}

} // namespace

void addExportCommand(CLI::App& app)
{
    CLI::App*  command = app.add_subcommand("export", "writes a recorded session as a table");
    const auto o       = std::make_shared<ExportOptions>();
    command->add_option("DIR", o->folder, "folder of a recorded session")->required();
    command->add_option("--csv", o->csv, "the table, a line per tick, SI units (.csv)")->required();
    command->add_flag("--json", o->json, "machine-readable");
    command->footer("Its markers are text already, a line each in DIR/markers.jsonl.\n"
                    "Examples:\n  palpate export session --csv session.csv");
    command->callback([o] { exportTable(*o); });
}

} // namespace palp
