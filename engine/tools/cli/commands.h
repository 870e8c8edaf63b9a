#pragma once
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

namespace palp {

/// Each adds one sub-command; its callback prints to standard output and throws Error on bad input.
void addInfoCommand(CLI::App& app);
void addConvertCommand(CLI::App& app);
void addPaintCommand(CLI::App& app);
void addTouchCommand(CLI::App& app);
void addSolveCommand(CLI::App& app);
void addDevicesCommand(CLI::App& app);
void addDoctorCommand(CLI::App& app);
void addRunCommand(CLI::App& app); ///< run and replay
void addHuntCommand(CLI::App& app);
void addStudyCommand(CLI::App& app);
void addRenderCommand(CLI::App& app);
void addViewCommand(CLI::App& app);
void addPerceiveCommand(CLI::App& app);
void addPaperCommand(CLI::App& app);
void addCalibrateCommand(CLI::App& app);
void addBenchCommand(CLI::App& app);

/// A check that was asked for says no: exit code 1. What was found has been printed.
struct CheckFailed : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// \throws Error naming the first option of the command that was given an empty value
void refuseEmptyValues(const CLI::App& command);

/// So that no slip writes a picture over a scene, a hand or a table.
/// \param option  opens the complaint
/// \throws Error unless the file's name ends in .svg, or is empty: no picture
void demandSvg(const std::string& option, const std::string& file);

/// The command line that a command's options are, quoted for a shell.
[[nodiscard]] std::string commandOf(const CLI::App& command);

/// JSON as all programs print it. A file name may hold bytes that are not UTF-8: JSON cannot, they become U+FFFD.
template <class Json>
[[nodiscard]] std::string jsonText(const Json& json)
{
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace palp
