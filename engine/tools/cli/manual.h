#pragma once
#include <string>

namespace CLI {
class App;
}

namespace palp {

// What a package holds beside the program. Both are made from the command line itself, so that they cannot differ from
// its help.

/// Returns the page of the manual, palpate(1), in the language of man.
[[nodiscard]] std::string manualPage(const CLI::App& app);

/// Returns a script that completes commands and options in bash; elsewhere bash completes files.
[[nodiscard]] std::string bashCompletion(const CLI::App& app);

} // namespace palp
