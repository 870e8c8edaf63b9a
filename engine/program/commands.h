#pragma once
#include <CLI/CLI.hpp>

namespace palp {

/// Each adds one sub-command; its callback prints to standard output and throws Error on bad input.
void addInfoCommand(CLI::App& app);
void addConvertCommand(CLI::App& app);
void addTouchCommand(CLI::App& app);
void addSolveCommand(CLI::App& app);
void addDevicesCommand(CLI::App& app);

} // namespace palp
