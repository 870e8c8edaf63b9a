#pragma once
#include <initializer_list>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include "engine/core/contract.h"
#include "engine/core/enum_names.h"
#include "engine/core/shown_text.h"

namespace palp {

/// Each of these functions adds one sub-command; its callback prints to standard output and throws Error on bad input.
void addInfoCommand(CLI::App& app);
void addConvertCommand(CLI::App& app);
void addPaintCommand(CLI::App& app);
void addTouchCommand(CLI::App& app);
void addMaterialsCommand(CLI::App& app);
void addFitCommand(CLI::App& app);
void addSolveCommand(CLI::App& app);
void addDevicesCommand(CLI::App& app);
void addDoctorCommand(CLI::App& app);
void addRunCommand(CLI::App& app); ///< adds run and replay
void addExportCommand(CLI::App& app);
void addHuntCommand(CLI::App& app);
void addStudyCommand(CLI::App& app);
void addRenderCommand(CLI::App& app);
void addViewCommand(CLI::App& app);
void addPerceiveCommand(CLI::App& app);
void addPaperCommand(CLI::App& app);
void addCalibrateCommand(CLI::App& app);
void addBenchCommand(CLI::App& app);

/// The failure of a check that was asked for: exit code 1. The findings have been printed.
struct CheckFailed : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Writes warnings to standard error.
void warn(const std::vector<std::string>& sentences);

/// Writes warnings to standard error and adds them to those that JSON will have.
void warn(const std::vector<std::string>& sentences, std::vector<std::string>& said);

/// Writes sentences to standard error that warn of nothing.
void say(const std::vector<std::string>& sentences);

/// Refuses other files, so that no slip writes a picture over a scene, a hand or a table.
/// \param option  opens the complaint
/// \throws Error unless the file's name ends in .svg and it can be written, or is empty: no picture
void demandSvg(const std::string& option, const std::string& file);

/// Refuses the name that stands for standard output, where a folder would be made of that name, and a folder in which
/// nothing can be written.
/// \param option  opens the complaint
void demandFolder(const std::string& option, const std::string& folder);

/// Refuses options that have an effect only beside another one, which is not given.
/// \param owner  the other one, as "--frames"
/// \throws Error naming both
void demandOwner(const CLI::App& command, const std::string& owner, std::initializer_list<const char*> options);

/// Refuses what has no effect beside an option, if that is given.
/// \param allowed  the names of what has one
/// \throws Error naming both
void allowOnlyWith(const CLI::App& command, const std::string& option, const std::vector<std::string>& allowed);

/// Reads the force that presses [N].
/// \throws Error naming --force
[[nodiscard]] double forceOf(const std::string& text);

/// Reads a size such as "1600x1200" [px], each side within the bounds.
/// \throws Error naming --size
[[nodiscard]] std::pair<int, int> pixelsOf(const std::string& text, int least, int most);

/// Returns the value of an option with a fixed set of names.
/// \throws Error naming the option and the names
template <NamedEnum Enum>
[[nodiscard]] Enum named(const std::string& option, const std::string& word)
{
    if (const auto value = valueNamed<Enum>(word)) return *value;
    throw Error(option + ": unknown name " + inQuotes(word) + "; known: " + wordsOf<Enum>());
}

/// Returns the command line with a command's options, quoted for a shell.
[[nodiscard]] std::string commandOf(const CLI::App& command);

/// Returns a text for JSON; null: an empty one.
[[nodiscard]] nlohmann::ordered_json orNull(const std::string& text);

/// Returns JSON as all commands print it. JSON holds only UTF-8: other bytes, as in file names, become U+FFFD.
template <class Json>
[[nodiscard]] std::string jsonText(const Json& json)
{
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace palp
